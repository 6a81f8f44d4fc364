"""From a scene to a labelled surface."""

from __future__ import annotations

import importlib.metadata
from dataclasses import asdict, dataclass, replace
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.data.candidate_table import CandidateTable
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.data.value import Drawn, same_members
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import naming
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.stand_in_report import report_on
from cellcolor.frontend.links import Links
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.frontend.reach.continuity import Coloring, find_cracks
from cellcolor.frontend.reach.limit_colors import LimitColors, limit_colors
from cellcolor.frontend.report import BuildReport, color_reports, count_reasons, survey_of
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Task
from cellcolor.frontend.stage_clock import Progress, StageClock
from cellcolor.frontend.stages import Stages, judged
from cellcolor.version import __version__

Cracks = tuple[Crack, ...]

_INJECTIVE = (
    "solutions have no names and are distinguished by continuity; a color with two configurations "
    "on one vertex: none found on this part"
)


@dataclass(frozen=True, eq=False, repr=False)
class BuildResult(Drawn):
    """A labelled surface and everything found on the way to it.

    Attributes:
        surface: the input of the decomposition.
        report: a summary in numbers for people.
        stages: the result of each stage of the build.
        prepared: the scene in place, with the surface that was labelled.
        limits: the colors of the surface, each of which keeps the joint limits by itself.
        left_alone: (n,) the vertices that are not to be covered on purpose, see :meth:`without`;
            None for none.
    """

    surface: LabelledSurface
    report: BuildReport
    stages: Stages
    prepared: PreparedScene
    limits: LimitColors
    left_alone: Mask | None = None

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
        return self.stages.branches

    @property
    def configurations(self) -> Array:
        """(n, branches, joints) in rad, NaN where a branch has no solution."""
        return self.stages.candidates.configurations

    @property
    def reasons(self) -> NDArray[np.uint8]:
        """(n, branches) codes: the first test that a candidate fails."""
        return self.stages.candidates.reasons

    @property
    def reason_names(self) -> tuple[str, ...]:
        """What the codes mean: valid, no solution, and the tests in their order."""
        return self.stages.candidates.reason_names

    @property
    def failures(self) -> dict[str, Mask]:
        """(n, branches) of each test: the candidates that fail it, other tests or not.

        Every test is made on every solution. A candidate is valid without some tests if it has a
        solution and fails none of the others: masks of tests can be combined.
        """
        candidates = self.stages.candidates
        solved = ~np.isnan(candidates.configurations[..., 0])
        masks = {}
        failed = self.prepared.judge.all_failures(candidates.configurations[solved])
        for name, hit in failed.items():
            masks[name] = np.zeros(solved.shape, dtype=bool)
            masks[name][solved] = hit
        return masks

    @property
    def color_branch(self) -> tuple[int, ...]:
        """The branch of each color of the surface."""
        branch = self.stages.cleaned.coloring.branch
        return tuple(branch[color] for color in self.limits.color)

    @property
    def node_color(self) -> NDArray[np.int64]:
        """(n, branches) the color of each valid candidate, -1 for the others.

        Candidates that a sliver policy removed also have -1. Where a branch has several colors,
        with other full circles, it is the first of them.
        """
        modulo = self.stages.cleaned.coloring.node_color
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
        stages, links, coloring = self.stages, self.stages.links, self.stages.coloring
        cracks = find_cracks(links.edges, links.linked, coloring)
        limits = _limit_colors(self.prepared, stages, coloring, cracks, links)
        raw = replace(
            self.surface,
            colors=limits.names,
            vertex_colors=_vertex_colors(limits, len(self.surface.vertices)),
            cracks=limits.cracks,
            given_up=(),
        )
        return raw if self.left_alone is None else raw.without_vertices(self.left_alone)

    @property
    def modulo_surface(self) -> LabelledSurface | None:
        """The surface with colors modulo full circles, where a color winds around; else None.

        Whatever covers the surface covers this one: its minimum is a bound wherever the colors that
        wind are cut.
        """
        if not self.limits.winding:
            return None
        coloring, cracks = self.stages.cleaned.coloring, self.stages.cleaned.cracks
        colors = [np.flatnonzero(row >= 0) for row in coloring.node_color]
        rows = zip(coloring.node_color, colors, strict=True)
        vertex_colors = tuple(tuple(sorted(row[own].tolist())) for row, own in rows)
        return replace(
            self.surface, colors=coloring.names, vertex_colors=vertex_colors, cracks=cracks
        )

    def without(self, mask: Mask) -> BuildResult:
        """The same scene with some vertices (n,) that are not to be covered, on purpose."""
        if self.left_alone is not None:
            mask = mask | self.left_alone
        cleaned = self.stages.cleaned
        node_color = np.where(mask[:, None], -1, cleaned.coloring.node_color)
        surface = self.surface.without_vertices(mask)
        coloring = replace(cleaned.coloring, node_color=node_color)
        cracks = [each for each in cleaned.cracks if not (mask[each.i] or mask[each.j])]
        cleaned = replace(cleaned, coloring=coloring, cracks=tuple(cracks))
        stages = replace(self.stages, cleaned=cleaned)
        return replace(self, surface=surface, stages=stages, left_alone=mask)

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

    Args:
        scene: the scene, or the name of its file.

    Raises:
        InputError: the scene, its setup, a URDF or a mesh cannot be used; names file and field.
    """
    clock = StageClock(deadline, progress)
    with clock.timed("preparation"):
        prepared = prepare(scene, deadline)
    return build_prepared(prepared, clock)


def build_prepared(prepared: PreparedScene, clock: StageClock) -> BuildResult:
    """Compute which colors reach each point of a scene that is in place.

    Raises:
        InputError: the scene asks for too much; names file and field.
        OutOfTime: the clock's deadline came first.
    """
    with naming(prepared.scene.file):
        return result_of(prepared, judged(prepared, clock), clock)


def result_of(prepared: PreparedScene, stages: Stages, clock: StageClock) -> BuildResult:
    """A labelled surface and its report, from what the stages of a build have made.

    Args:
        prepared: the scene, with the surface that the stages were asked about.
        clock: the time they have taken.
    """
    clock.begin("report")
    surface, limits = labelled(prepared, stages, clock.seconds)
    clock.deadline.check()
    report = _report(prepared, stages, limits, clock.seconds)
    clock.deadline.check()
    return BuildResult(surface, report, stages, prepared, limits)


def labelled(
    prepared: PreparedScene, stages: Stages, seconds: dict[str, float]
) -> tuple[LabelledSurface, LimitColors]:
    """The labelled surface of a scene, with the seconds that each stage took, and its colors."""
    cleaned = stages.cleaned
    limits = _limit_colors(prepared, stages, cleaned.coloring, cleaned.cracks, cleaned.links)
    surface = LabelledSurface(
        name=prepared.scene.name,
        colors=limits.names,
        vertices=prepared.surface.vertices,
        faces=prepared.surface.faces,
        vertex_colors=_vertex_colors(limits, len(prepared.surface.vertices)),
        cracks=limits.cracks,
        meta=_meta(prepared.scene, stages, seconds),
        given_up=_given_up(stages.candidates.valid, cleaned.coloring),
    )
    return surface, limits


def _limit_colors(
    prepared: PreparedScene, stages: Stages, coloring: Coloring, cracks: Cracks, links: Links
) -> LimitColors:
    robot = prepared.robot
    if not prepared.setup.constraints.collision:  # joint limits are not asked about either
        nowhere = np.full(robot.joints, np.inf)
        robot = replace(robot, lower=-nowhere, upper=nowhere)
    configurations = stages.candidates.configurations
    return limit_colors(robot, coloring, cracks, configurations, links.edges, links.linked)


def _report(
    prepared: PreparedScene, stages: Stages, limits: LimitColors, seconds: dict[str, float]
) -> BuildReport:
    surface, candidates, cleaned = prepared.surface, stages.candidates, stages.cleaned
    areas, names = surface.vertex_areas(), candidates.reason_names
    reached = candidates.valid.any(axis=1)
    # Codes are in the order of the tests.
    farthest = candidates.reasons.max(axis=1)[~reached]
    remarks = prepared.kinematics.remarks(surface.vertices, -surface.normals)
    return BuildReport(
        survey=survey_of(prepared),
        vertices=len(areas),
        reachable=int(reached.sum()),
        area_m2=float(areas.sum()),
        reachable_area_m2=float(areas[reached].sum()),
        candidates=count_reasons(candidates.reasons.ravel(), names),
        unreachable=count_reasons(farthest, names, 1),
        colors=color_reports(surface, cleaned.coloring, stages.branches),
        cracks=len(cleaned.cracks),
        seconds=seconds,
        notes=prepared.notes + remarks,
        stand_ins=tuple(map(report_on, prepared.robot.stand_ins)),
        slivers=cleaned.report,
        injectivity=None if prepared.arm.named else _INJECTIVE,
        rounding=_rounding_in_words(prepared.setup.task) if surface.faceted else None,
        limits=_limits_in_words(limits) if limits.positions else None,
    )


def _limits_in_words(limits: LimitColors) -> str:
    divided = {limits.color[color] for color in limits.positions}
    text = f"{count(len(divided), 'color')} divided, so that each keeps the joint limits"
    if limits.winding:
        text += f"; {len(limits.winding)} of them cut, as they wind around"
    return text


def _rounding_in_words(task: Task) -> str:
    """Over what normals are rounded."""
    radius = task.rounding_m
    key = "contact_radius_m" if task.edge_radius_m is None else "edge_radius_m"
    return f"rounded over {1e3 * radius:g} mm (task.{key})"


def _vertex_colors(limits: LimitColors, vertices: int) -> tuple[tuple[int, ...], ...]:
    members = np.array(limits.members, dtype=bool).reshape(-1, vertices).T
    return tuple(tuple(np.flatnonzero(own).tolist()) for own in members)


def _given_up(valid: Mask, coloring: Coloring) -> tuple[int, ...]:
    """The vertices that are reachable and were left without any color."""
    lost = valid.any(axis=1) & (coloring.node_color < 0).all(axis=1)
    return tuple(np.flatnonzero(lost).tolist())


def _meta(scene: Scene, stages: Stages, seconds: dict[str, float]) -> dict[str, Any]:
    packages = ("pin", "coal", "trimesh", "numpy")
    versions = {package: importlib.metadata.version(package) for package in packages}
    slivers = stages.cleaned.report
    return {
        "scene": scene.model_dump(mode="json"),
        # How the arm moves later has no part in what a surface is.
        "setup": scene.setup.model_dump(mode="json", exclude={"motion", "prefer"}),
        "versions": {"cellcolor": __version__} | versions,
        "seconds": {stage: round(value, 4) for stage, value in seconds.items()},
    } | ({} if slivers is None else {"slivers": asdict(slivers)})
