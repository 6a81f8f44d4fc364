"""Candidates for set-ups: one part in several places and before several arms, on one mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np

from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import InputError
from cellcolor.frontend.build import StageClock, build_prepared
from cellcolor.frontend.parts.placement import Placement
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.frontend.scene import Scene
from cellcolor.questions.choosing_set_ups import choose
from cellcolor.questions.placements import Pose
from cellcolor.questions.placing import pose_of, stands_in
from cellcolor.questions.set_ups import Choice, SetUp, SetUpPlan, positions_in_words
from cellcolor.solvers import checked
from cellcolor.solvers.interface import Options


@dataclass
class Candidates:
    """Set-ups that could be used, as far as they are built.

    Attributes:
        scenes: of each, with the part in its place.
        surfaces: of each, in the part's own frame; all on one mesh.
        refused: why others cannot be used, a sentence each.
        left: how many the deadline left unbuilt.
    """

    scenes: list[Scene] = field(default_factory=list)
    surfaces: list[LabelledSurface] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)
    left: int = 0


def at_stops(scene: Scene, stops: Mapping[str, Sequence[float]]) -> list[Scene]:
    """The scene with external axes standing still, once for each combination of their stops.

    Args:
        stops: of each joint where it may stand, rad, or m of a prismatic one.
    """
    robot = scene.setup.robot
    found = []
    for positions in product(*stops.values()):
        fixed = {**robot.fixed_joints, **dict(zip(stops, positions, strict=True))}
        setup = scene.setup.varied(robot={"fixed_joints": fixed}, file=scene.setup.file)
        found.append(scene.varied(setup=setup, file=scene.file))
    return found


def candidates_of(
    scenes: Sequence[Scene],
    poses: Sequence[Pose],
    deadline: Deadline,
    progress: Callable[[str], None] | None = None,
    *,
    by_hand: bool = False,
    stops: bool = False,
) -> Candidates:
    """Build each scene with the part where it is, and with the part in each of the other places.

    Args:
        scenes: with the same part.
        poses: other places.
        deadline: when to return those built so far.
        by_hand: whether somebody has named each place. Then one in which the part stands in
            something is a mistake, unless it is meant for another of several scenes.
        stops: whether the scenes are one, with external axes at several stops. Where the part
            stands in the arm then, the stop is left out.

    Raises:
        InputError: a scene cannot be used wherever its part stands, or has another part; or a place
            that was named by hand is one in which the part stands in something.
        OutOfTime: the deadline came before the first was built.
    """
    report = progress or (lambda _: None)
    found = Candidates()
    places = [
        (scene, pose)
        for scene in scenes
        for pose in dict.fromkeys((pose_of(scene.placement), *poses))
    ]
    prepared: PreparedScene | None = None
    for number, (given, pose) in enumerate(places):
        report(f"set-up {number + 1}")
        own_place = pose == pose_of(given.placement)
        if own_place:  # the first one of this scene
            prepared = None
        placement = Placement(position_m=pose[:3], rpy_rad=pose[3:])
        there = given.varied(placement=placement, file=given.file)
        try:
            prepared = prepared or prepare(there, deadline)
            surface = _built(prepared.at(there), deadline)
        except OutOfTime:
            if not found.scenes:
                raise
            found.left = len(places) - number
            return found
        except InputError as error:
            named = (given is not scenes[0]) if own_place else (by_hand and len(scenes) == 1)
            misplaced = (error.field or "").startswith("placement")
            if prepared is None and not misplaced:
                raise
            if named and misplaced and not stops:
                file = None if given.file is None else str(given.file)
                message = f"{_in_words(pose)} is no set-up: {error.message}"
                raise InputError(file, "placement", message) from error
            stop = f" with {positions_in_words(fixed)}" if (fixed := _fixed(given)) else ""
            found.refused.append(f"{given.name} at {_in_words(pose)}{stop}: {error.message}")
            continue
        if found.surfaces:
            _check_same_part(found.surfaces[0], prepared)
        found.scenes.append(prepared.scene.varied(placement=placement, file=given.file))
        found.surfaces.append(surface)
    if not found.scenes:
        raise InputError(None, None, f"no set-up can be used; {found.refused[0]}")
    return found


def _fixed(scene: Scene) -> dict[str, float]:
    return scene.setup.robot.fixed_joints


def _built(there: PreparedScene, deadline: Deadline) -> LabelledSurface:
    """The part where it stands, labelled, its vertices in its own frame."""
    within = stands_in(there)
    if within is not None:
        raise InputError(None, "placement", f"the part stands in {within}")
    surface = build_prepared(there, StageClock(deadline, None)).surface
    if not any(surface.vertex_colors):
        raise InputError(None, None, "nothing is reached")
    decomposition_of(surface, deadline=deadline)  # refuses cells that are not planar
    return replace(surface, vertices=there.own_surface.vertices)


def _check_same_part(part: LabelledSurface, prepared: PreparedScene) -> None:
    own = prepared.own_surface
    same = np.array_equal(part.vertices, own.vertices) and np.array_equal(part.faces, own.faces)
    if not same:
        message = (
            f"has {len(own.vertices)} vertices that are not the {len(part.vertices)} of the first "
            "scene's object: set-ups are of one part, on one mesh"
        )
        raise InputError(prepared.scene.file, "object", message)


def plan_of(
    candidates: Candidates,
    cover: float,
    change_over: float | None,
    options: Options,
    progress: Callable[[str], None] | None = None,
) -> SetUpPlan:
    """The set-ups to use; see :func:`~cellcolor.questions.choosing_set_ups.choose`."""
    choice = choose(candidates.surfaces, cover, change_over, options, progress)
    report = progress or (lambda _: None)
    report("one set-up alone")
    areas = choice.surface.vertex_areas
    reached = np.array([surface.colored for surface in candidates.surfaces])
    covered, whole = reached @ areas, float(areas[reached.any(axis=0)].sum())
    best = int(np.argmax(covered))
    instance = decomposition_of(candidates.surfaces[best]).instance
    alone = checked.solve(instance, options)
    return SetUpPlan(
        **vars(choice),
        name=candidates.scenes[0].name,
        set_ups=_set_ups(candidates, choice, whole),
        alone=_set_up(candidates, best, alone.segments or 0, float(covered[best]) / whole),
        candidates=len(candidates.scenes),
        refused=tuple(candidates.refused),
        left=candidates.left,
    )


def _set_ups(candidates: Candidates, choice: Choice, whole: float) -> tuple[SetUp, ...]:
    """Each set-up with its segments, and the area of the cells that are painted in them.

    A cell that is divided counts in equal parts for its sub-cells: where a cut runs is free.
    """
    names = choice.surface.colors
    cell_areas = np.bincount(
        np.array(decomposition_of(choice.surface).vertex_cell) + 1, choice.surface.vertex_areas
    )[1:]
    segments: dict[int, set[int]] = {number: set() for number in choice.numbers}
    covered = dict.fromkeys(choice.numbers, 0.0)
    for cell in choice.solution.cells or ():
        for sub in cell.subcells:
            number = int(names[sub.color].partition(":")[0]) - 1
            segments[number].add(sub.segment)
            covered[number] += float(cell_areas[cell.id]) / len(cell.subcells)
    return tuple(
        _set_up(candidates, number, len(segments[number]), covered[number] / whole)
        for number in choice.numbers
    )


def _set_up(candidates: Candidates, number: int, segments: int, share: float) -> SetUp:
    scene = candidates.scenes[number]
    pose = pose_of(scene.placement)
    return SetUp(number + 1, scene.name, pose, segments, share, _fixed(scene))


def _in_words(pose: Pose) -> str:
    return f"({', '.join(f'{value:.4g}' for value in pose)})"
