"""From a scene file to a labelled surface."""

from __future__ import annotations

import importlib.metadata
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import cellcolor
from cellcolor.arrays import Array, Mask
from cellcolor.data.comparing import same_members
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.arm.conditioning import Conditioning
from cellcolor.frontend.arm.kinematics import (
    forward,
    manipulability,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.ur import BRANCHES
from cellcolor.frontend.contact.collision import longest_steps
from cellcolor.frontend.reach.between import at_domain_border, remains_valid
from cellcolor.frontend.reach.continuity import (
    Coloring,
    color,
    find_cracks,
    link,
    node_links,
)
from cellcolor.frontend.reach.slivers import SliverReport, clean
from cellcolor.frontend.reach.smooth import Measure
from cellcolor.frontend.reach.validity import Candidates, Reason
from cellcolor.frontend.report import BuildReport, make_report
from cellcolor.frontend.scene import Scene, Setup
from cellcolor.frontend.stage import Stage, prepare
from cellcolor.frontend.survey import survey

__all__ = ["BuildResult", "build_surface"]

_AT_ONCE = 50_000  # mesh edges, or links on them; a matter of memory: some kilobytes each

Progress = Callable[[str], None]
"""Told the name of each stage as it begins."""


@dataclass(frozen=True, eq=False, repr=False)
class BuildResult:
    """A labelled surface and all that was found on the way to it.

    Attributes:
        surface: what the decomposition takes.
        branches: names of the eight inverse-kinematic branches.
        configurations: (n, 8, 6) in rad, NaN where a branch has no solution.
        reasons: (n, 8) uint8 codes of :class:`~cellcolor.frontend.reach.validity.Reason`, the first
            test that a candidate fails.
        node_color: (n, 8) the color of each valid candidate, -1 for the others and for those
            that a sliver policy took away.
        report: the same in numbers for people.
    """

    surface: LabelledSurface
    branches: tuple[str, ...]
    configurations: Array
    reasons: NDArray[np.uint8]
    node_color: NDArray[np.int64]
    report: BuildReport

    def __eq__(self, other: object) -> bool:
        return same_members(self, other) if isinstance(other, BuildResult) else NotImplemented

    __hash__ = None  # type: ignore[assignment]  # arrays that can be changed

    def __str__(self) -> str:
        return f"{self.surface}\n{self.report}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.surface}>"


def build_surface(
    scene_path: Path, deadline: Deadline = NEVER, progress: Progress | None = None
) -> BuildResult:
    """Compute which colors reach each point of a scene's object.

    Args:
        scene_path: the scene's file.
        deadline: when to give up.
        progress: told what is being done.

    Raises:
        InputError: the scene, its setup, a URDF or a mesh cannot be used; names file and field.
        OutOfTime: the deadline came first.
    """
    scene_path = Path(scene_path)
    started = time.perf_counter()

    def begin(name: str) -> None:
        deadline.check()
        if progress is not None:
            progress(name)

    begin("preparation")
    stage = prepare(scene_path, deadline)
    try:
        return _build(stage, begin, {"preparation": time.perf_counter() - started})
    except InputError as error:
        if error.file:
            raise
        raise error.in_file(str(scene_path)) from error


def _build(stage: Stage, begin: Progress, seconds: dict[str, float]) -> BuildResult:
    scene, setup, robot, surface, judge = (
        stage.scene,
        stage.setup,
        stage.robot,
        stage.surface,
        stage.judge,
    )
    started = time.perf_counter()

    def lap(name: str) -> None:
        nonlocal started
        now = time.perf_counter()
        seconds[name] = now - started
        started = now

    begin("inverse kinematics")
    solutions = stage.inverse(surface.vertices, -surface.normals)
    lap("inverse kinematics")
    edges = surface.edges()
    begin("validity at the vertices")
    verdicts = judge(solutions.reshape(-1, solutions.shape[2]))
    seconds |= judge.seconds  # a copy: the judge goes on being asked
    candidates = Candidates(
        verdicts.configurations.reshape(solutions.shape),
        verdicts.reasons.reshape(solutions.shape[:2]),
        verdicts.determinants.reshape(solutions.shape[:2]),
    )
    valid, configurations = candidates.valid, candidates.configurations

    def probe(points: Array, directions: Array, branch: NDArray[np.intp]) -> tuple[Array, Array]:
        stage.deadline.check()
        between = stage.follow(points, directions, branch)
        return between, _conditioned(robot, setup, stage.conditioning, between)

    def test(points: Array, directions: Array, branch: NDArray[np.intp]) -> tuple[Mask, Array]:
        found = judge(stage.follow(points, directions, branch))
        return np.asarray(found.reasons == Reason.VALID), found.ends

    begin("continuity")
    started = time.perf_counter()
    linked = np.zeros((len(edges), valid.shape[1]), dtype=bool)
    limits = (robot.lower, robot.upper) if setup.constraints.collision else None
    measure = Measure(
        setup.continuity,
        stage.conditioning.near_singular_determinant,
        # A turn about the tip moves the wrist, the crossing of axes 5 and 6, by this lever.
        stage.geometry.reach,
    )
    for part in _parts(len(edges), stage.deadline):
        linked[part] = link(surface, edges[part], candidates, measure, limits, probe)
    lap("continuity")
    spacing = setup.continuity.validity_spacing_m
    if spacing is not None:
        begin("validity between vertices")
        if setup.constraints.collision:
            for part in _parts(len(edges), stage.deadline):
                linked[part] &= stage.tip.free_along(surface, edges[part])[:, None]
        near_border = at_domain_border(edges, valid)
        counts = np.maximum(np.ceil(surface.lengths(edges) / spacing).astype(int), 2)
        ends = verdicts.ends.reshape(-1, *valid.shape, 3)
        longest = longest_steps(judge.end_radii)
        all_rows, all_branches = np.nonzero(linked)
        for part in _parts(len(all_rows), stage.deadline):
            rows, branches = all_rows[part], all_branches[part]
            pieces = np.where(near_border[rows, branches], counts[rows], 1)
            linked[rows, branches] = remains_valid(
                surface, edges[rows], branches, pieces, ends, longest, test
            )
        lap("validity between vertices")
    begin("colors and cracks")
    coloring = color(valid, configurations, node_links(edges, linked), BRANCHES)
    stage.deadline.check()
    slivers = None
    if setup.slivers is not None:
        areas = surface.vertex_areas()
        kept, slivers = clean(edges, linked, coloring, areas, setup.slivers, stage.deadline)
        linked &= kept[edges].all(axis=1)
        coloring = color(kept, configurations, node_links(edges, linked), BRANCHES)
    cracks = find_cracks(edges, linked, coloring)
    lap("colors and cracks")

    begin("report")
    labelled = LabelledSurface(
        name=scene.name,
        colors=coloring.names,
        vertices=surface.vertices,
        faces=surface.faces,
        vertex_colors=_vertex_colors(coloring),
        cracks=cracks,
        meta=_meta(scene, setup, seconds, slivers),
        given_up=_given_up(valid, coloring),
    )
    stage.deadline.check()
    where = survey(surface, stage.geometry)
    notes = robot.warnings + (() if stage.coarse is None else (stage.coarse,))
    report = make_report(
        where, surface, candidates, coloring, BRANCHES, len(cracks), seconds, notes, slivers
    )
    stage.deadline.check()
    return BuildResult(
        surface=labelled,
        branches=BRANCHES,
        configurations=candidates.configurations,
        reasons=candidates.reasons,
        node_color=coloring.node_color,
        report=report,
    )


def _parts(count: int, deadline: Deadline) -> Iterator[slice]:
    """Slices of a long list, as long as there is time."""
    for first in range(0, count, _AT_ONCE):
        deadline.check()
        yield slice(first, first + _AT_ONCE)


def _conditioned(robot: Robot, setup: Setup, limits: Conditioning, configurations: Array) -> Array:
    """Task determinants (k,) in m^3 of configurations (k, 6).

    NaN where there is no configuration, or one that fails a threshold on conditioning.
    """
    found = np.flatnonzero(~np.isnan(configurations[:, 0]))
    poses = forward(robot, configurations[found])
    linear, angular = tip_jacobian(poses)
    determinant = task_determinant(linear, angular, poses.tool_axis)
    if setup.constraints.conditioning:
        good = (manipulability(linear) >= limits.min_manipulability) & (
            determinant >= limits.min_task_determinant
        )
        determinant[~good] = np.nan
    determinants = np.full(len(configurations), np.nan)
    determinants[found] = determinant
    return determinants


def _vertex_colors(coloring: Coloring) -> tuple[tuple[int, ...], ...]:
    return tuple(
        tuple(sorted(int(number) for number in row if number >= 0)) for row in coloring.node_color
    )


def _given_up(valid: Mask, coloring: Coloring) -> tuple[int, ...]:
    """The vertices that are reachable and were left without any color."""
    lost = valid.any(axis=1) & (coloring.node_color < 0).all(axis=1)
    return tuple(np.flatnonzero(lost).tolist())


def _meta(
    scene: Scene, setup: Setup, seconds: dict[str, float], slivers: SliverReport | None
) -> dict[str, Any]:
    packages = {"pin": "pin", "trimesh": "trimesh", "fcl": "python-fcl", "numpy": "numpy"}
    versions = {name: importlib.metadata.version(package) for name, package in packages.items()}
    done = {} if slivers is None else {"slivers": asdict(slivers)}
    return {
        "scene": scene.model_dump(mode="json"),
        "setup": setup.model_dump(mode="json"),
        "versions": {"cellcolor": cellcolor.__version__} | versions,
        "seconds": {stage: round(value, 4) for stage, value in seconds.items()},
    } | done
