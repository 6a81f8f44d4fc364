"""From a scene to a labelled surface, stage by stage."""

from __future__ import annotations

import importlib.metadata
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.data.candidate_table import CandidateTable
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.value import Drawn, same_members
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError, naming
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.links import continuous_along, valid_along
from cellcolor.frontend.parts.surface import MOST_VERTICES
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.frontend.reach.colors import Coloring, LimitColors, color_nodes, limit_colors
from cellcolor.frontend.reach.slivers import SliverReport, clean
from cellcolor.frontend.reach.validity_tests import Verdicts
from cellcolor.frontend.report import BuildReport, report_on
from cellcolor.frontend.scene import Scene
from cellcolor.version import __version__

Progress = Callable[[str], None]
"""Told the name of each stage as it begins."""


class StageClock:
    """What one build has spent its time on.

    Attributes:
        seconds: wall time of each timed stage, in the order in which they first ended; of a stage
            that came several times, the sum.
    """

    def __init__(self, deadline: Deadline, progress: Progress | None) -> None:
        self.deadline, self._progress = deadline, progress
        self.seconds: dict[str, float] = {}

    def begin(self, stage: str) -> None:
        """A stage begins."""
        self.deadline.check()
        if self._progress is not None:
            self._progress(stage)

    @contextmanager
    def timed(self, stage: str) -> Iterator[None]:
        """A stage from its beginning to its end; raises like :meth:`begin`."""
        self.begin(stage)
        started = time.perf_counter()
        yield
        spent = time.perf_counter() - started
        self.seconds[stage] = self.seconds.get(stage, 0.0) + spent


TURN_NOT_DEFINED = "turn not defined"
"""The reason at a vertex where the setup's rule for the tool's turn says nothing."""
OFF = "tolerance"
"""The reason of a candidate that is valid where the part should stand and not wherever it may."""


@dataclass(frozen=True, eq=False, repr=False)
class BuildResult(Drawn):
    """A labelled surface and everything found on the way to it.

    Attributes:
        surface: the input of the decomposition.
        prepared: the scene in place, with the surface that was labelled.
        verdicts: on all branches at all vertices, (n, branches).
        continuous: (edges, branches) along which mesh edges a branch moves without a jump.
        all_colors: of all valid candidates.
        coloring: what the sliver policy leaves of them.
        slivers_report: what it changed; None without one.
        limits: the colors of the surface, each of which keeps the joint limits by itself.
        seconds: wall time of each stage.
        left_alone: (n,) the vertices that are not to be covered on purpose, see :meth:`without`;
            None for none.
    """

    surface: LabelledSurface
    prepared: PreparedScene
    verdicts: Verdicts
    continuous: Mask
    all_colors: Coloring
    coloring: Coloring
    slivers_report: SliverReport | None
    limits: LimitColors
    seconds: Mapping[str, float]
    left_alone: Mask | None = None

    @cached_property
    def report(self) -> BuildReport:
        """A summary in numbers for people."""
        return report_on(self)

    @property
    def scene(self) -> Scene:
        """What was built."""
        return self.prepared.scene

    @property
    def robot(self) -> Robot:
        """The arm and tool of its setup."""
        return self.prepared.robot

    @property
    def branches(self) -> tuple[str, ...]:
        """Names of the inverse-kinematic branches, eight of a UR-type arm, or of sheets.

        See :mod:`cellcolor.frontend.reach.sheets`.
        """
        return self.prepared.arm.kinematics.branches

    @property
    def configurations(self) -> Array:
        """(n, branches, joints) in rad, NaN where a branch has no solution."""
        return self.verdicts.configurations

    @property
    def reasons(self) -> NDArray[np.uint8]:
        """(n, branches) codes: the first test that a candidate fails."""
        return self.verdicts.reasons

    @property
    def reason_names(self) -> tuple[str, ...]:
        """What the codes mean: valid, no solution, and the tests in their order."""
        return self.verdicts.reason_names

    @property
    def color_branch(self) -> tuple[int, ...]:
        """The branch of each color of the surface."""
        return tuple(self.coloring.branch[color] for color in self.limits.color)

    @property
    def node_color(self) -> NDArray[np.int64]:
        """(n, branches) the color of each valid candidate, -1 for the others.

        Candidates that a sliver policy removed also have -1. Where a branch has several colors,
        with other full circles, it is the first of them.
        """
        modulo = self.coloring.node_color
        node_color = np.full(modulo.shape, -1, dtype=np.int64)
        for color, branch in reversed(list(enumerate(self.color_branch))):
            here = self.limits.members[color] & (modulo[:, branch] == self.limits.color[color])
            node_color[here, branch] = color
        return node_color

    @property
    def candidates(self) -> CandidateTable:
        """What the side file holds."""
        return CandidateTable(
            self.branches,
            self.reason_names,
            self.reasons,
            self.configurations,
            self.node_color,
            self.surface.sha256,
        )

    @property
    def slivers(self) -> Mask:
        """(n,) the vertices that the sliver policy gave up."""
        given_up = np.zeros(len(self.surface.vertices), dtype=bool)
        given_up[list(self.surface.given_up)] = True
        return given_up if self.left_alone is None else given_up & ~self.left_alone

    @property
    def raw_surface(self) -> LabelledSurface | None:
        """The surface with its slivers, where the sliver policy has given some up; else None."""
        if not self.slivers.any():
            return None
        limits = _limited(self.prepared, self.verdicts, self.all_colors)
        labels = _labels(limits, len(self.surface.vertices))
        raw = replace(self.surface, **labels, given_up=())
        return raw if self.left_alone is None else raw.without_vertices(self.left_alone)

    @property
    def modulo_surface(self) -> LabelledSurface | None:
        """The surface with colors modulo full circles, where a color winds around; else None.

        Whatever covers the surface covers this one: its minimum is a bound wherever the colors that
        wind are cut.
        """
        if not self.limits.winding:
            return None
        own = tuple(tuple(sorted(row[row >= 0].tolist())) for row in self.coloring.node_color)
        cracks = self.coloring.cracks
        return replace(self.surface, colors=self.coloring.names, vertex_colors=own, cracks=cracks)

    def without(self, mask: Mask) -> BuildResult:
        """The same scene with some vertices (n,) that are not to be covered, on purpose."""
        if self.left_alone is not None:
            mask = mask | self.left_alone
        node_color = np.where(mask[:, None], -1, self.coloring.node_color)
        cracks = tuple(each for each in self.coloring.cracks if not (mask[each.i] or mask[each.j]))
        coloring = replace(self.coloring, node_color=node_color, cracks=cracks)
        surface = self.surface.without_vertices(mask)
        return replace(self, surface=surface, coloring=coloring, left_alone=mask)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, BuildResult):
            return NotImplemented
        return (self.surface, self.report) == (other.surface, other.report) and same_members(
            self.candidates, other.candidates
        )

    __hash__ = None  # type: ignore[assignment]  # arrays that can be changed

    def __str__(self) -> str:
        return f"{self.surface}\n{self.report}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.surface}>"


def build_surface(
    scene: Scene | str | PathLike[str], deadline: Deadline = NEVER, progress: Progress | None = None
) -> BuildResult:
    """Compute which colors reach each point of a scene's object.

    Raises:
        InputError: the scene, its setup, a URDF or a mesh cannot be used; names file and field.
    """
    clock = StageClock(deadline, progress)
    with clock.timed("preparation"):
        prepared = prepare(scene, deadline)
    return build_prepared(prepared, clock)


def build_prepared(prepared: PreparedScene, clock: StageClock) -> BuildResult:
    """Compute which colors reach each point of a scene that is in place.

    A scene may say how far its part may be off
    (:class:`~cellcolor.frontend.parts.placement.Tolerance`). Then a candidate is valid only if its
    branch is valid at every displacement of a sample, and a branch leads along a mesh edge only if
    it does at each. Whoever follows the colors of what is left has a motion in the same branches
    wherever the sample puts the part.

    Raises:
        InputError: there are too many vertices for the turns of the tool; a displaced part stands
            in a link that cannot move; a tolerance asks for an arm whose solutions have names.
    """
    with naming(prepared.scene.file):
        verdicts, continuous, linked = _judged(prepared, clock)
        if prepared.scene.tolerance is not None:
            if not prepared.arm.named:
                message = (
                    "the solutions of this arm have no names, and are told apart on the part where "
                    "it stands: a scene with a tolerance needs an arm whose solutions have names"
                )
                raise InputError(None, "robot.kinematics", message)
            held = verdicts.valid
            for there in prepared.displaced():
                found, leads, leads_validly = _judged(there, clock)
                held = held & found.valid
                continuous, linked = continuous & leads, linked & leads_validly
            verdicts = _with_reason(verdicts, verdicts.valid & ~held, OFF)
        return colored(prepared, verdicts, continuous, linked, clock)


def judged_at_vertices(prepared: PreparedScene, clock: StageClock) -> Verdicts:
    """The verdicts (n, branches) on all candidates, whatever lies between the vertices.

    Raises:
        InputError: there are too many vertices for the turns of the tool.
    """
    turn, surface = prepared.setup.task.turn, prepared.surface
    if turn is not None:
        with naming(prepared.setup.file):
            count, turns = len(surface.vertices), len(turn.degrees)
            if count * turns > MOST_VERTICES:
                message = f"{turns} turns on {count:,} vertices are more than {MOST_VERTICES:,}"
                raise InputError(None, "task.turn", f"{message} together")
    with clock.timed("inverse kinematics"):
        solutions = prepared.arm.inverse(surface.vertices, -surface.normals, clock.deadline)
    with clock.timed("validity at the vertices"):
        verdicts = prepared.judge(solutions, clock.deadline)
    if turn is None:
        return verdicts
    undefined = prepared.arm.without_turn(surface.vertices, -surface.normals)
    return _with_reason(verdicts, undefined, TURN_NOT_DEFINED)


def _judged(prepared: PreparedScene, clock: StageClock) -> tuple[Verdicts, Mask, Mask]:
    """The verdicts on all candidates with the part where it stands; which links (edges, branches)
    are continuous, and which of them are valid between the vertices as well."""
    verdicts = judged_at_vertices(prepared, clock)
    with clock.timed("continuity"):
        edges = prepared.surface.mesh.edges
        continuous = continuous_along(prepared, edges, verdicts, clock.deadline)
    with clock.timed("validity between vertices"):
        linked = valid_along(prepared, verdicts, continuous, clock.deadline)
    return verdicts, continuous, linked


def _with_reason(verdicts: Verdicts, where: Mask, name: str) -> Verdicts:
    """The verdicts with another reason at some candidates, or at some vertices."""
    names, reasons = (*verdicts.reason_names, name), verdicts.reasons.copy()
    reasons[where] = len(names) - 1
    return replace(verdicts, reasons=reasons, reason_names=names)


def colored(
    prepared: PreparedScene, verdicts: Verdicts, continuous: Mask, linked: Mask, clock: StageClock
) -> BuildResult:
    """A labelled surface, from what the tests have found.

    Args:
        continuous: (edges, branches) along which mesh edges a branch moves without a jump.
        linked: those that are valid between the vertices as well.
    """
    surface, branches = prepared.surface, prepared.arm.kinematics.branches
    with clock.timed("colors and cracks"):
        edges, policy, report = surface.mesh.edges, prepared.setup.slivers, None
        coloring = all_colors = color_nodes(verdicts.valid, edges, linked, branches)
        clock.deadline.check()
        if policy is not None:
            areas = surface.mesh.vertex_areas
            kept, report = clean(edges, all_colors, areas, policy, clock.deadline)
            coloring = color_nodes(kept, edges, linked & kept[edges].all(axis=1), branches)
    clock.begin("surface")
    limits = _limited(prepared, verdicts, coloring)
    clock.deadline.check()
    lost = verdicts.valid.any(axis=1) & (coloring.node_color < 0).all(axis=1)
    labelled = LabelledSurface(
        name=prepared.scene.name,
        vertices=surface.vertices,
        faces=surface.faces,
        **_labels(limits, len(surface.vertices)),
        meta=_meta(prepared.scene, report, clock.seconds),
        given_up=tuple(np.flatnonzero(lost).tolist()),
    )
    clock.deadline.check()
    return BuildResult(
        surface=labelled,
        prepared=prepared,
        verdicts=verdicts,
        continuous=continuous,
        all_colors=all_colors,
        coloring=coloring,
        slivers_report=report,
        limits=limits,
        seconds=clock.seconds,
    )


def _limited(prepared: PreparedScene, verdicts: Verdicts, coloring: Coloring) -> LimitColors:
    robot = prepared.robot
    if not prepared.setup.constraints.collision:  # joint limits are not asked about either
        nowhere = np.full(robot.joints, np.inf)
        robot = replace(robot, lower=-nowhere, upper=nowhere)
    return limit_colors(robot, coloring, verdicts.configurations, prepared.surface.mesh.edges)


def _labels(limits: LimitColors, vertices: int) -> dict[str, Any]:
    """What a labelled surface of that many vertices says of its colors."""
    members = np.array(limits.members, dtype=bool).reshape(-1, vertices).T
    own = tuple(tuple(np.flatnonzero(row).tolist()) for row in members)
    return {"colors": limits.names, "vertex_colors": own, "cracks": limits.cracks}


def _meta(
    scene: Scene, slivers: SliverReport | None, seconds: Mapping[str, float]
) -> dict[str, Any]:
    packages = ("pin", "coal", "trimesh", "numpy")
    versions = {package: importlib.metadata.version(package) for package in packages}
    return {
        "scene": scene.model_dump(mode="json"),
        # How the arm moves later has no part in what a surface is.
        "setup": scene.setup.model_dump(mode="json", exclude={"motion", "prefer"}),
        "versions": {"cellcolor": __version__} | versions,
        "seconds": {stage: round(value, 4) for stage, value in seconds.items()},
    } | ({} if slivers is None else {"slivers": asdict(slivers)})
