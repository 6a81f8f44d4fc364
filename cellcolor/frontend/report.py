"""The result of a build for people: reachability by reason, colors, cracks, time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cellcolor.data.wording import count
from cellcolor.frontend.contact.stand_in_report import StandInReport
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.reach.continuity import Coloring
from cellcolor.frontend.reach.slivers import SliverReport
from cellcolor.frontend.reach.validity import Candidates
from cellcolor.frontend.reach.validity_tests import STANDARD_TESTS
from cellcolor.frontend.survey import Survey

_REMEDIES = {
    "no solution": "move the part nearer to the robot, or turn it towards the tool",
    **{test.name: test.remedy for test in STANDARD_TESTS},
}
"""What to try where no vertex is reachable, by the commonest reason."""


@dataclass(frozen=True)
class ColorReport:
    """One color: its branch, how many vertices it reaches, and their area in m^2."""

    name: str
    branch: str
    vertices: int
    area_m2: float


@dataclass(frozen=True)
class BuildReport:
    """What a build found.

    Attributes:
        survey: where the object is.
        vertices: of the surface.
        reachable: vertices with at least one valid configuration.
        area_m2: of the whole surface.
        reachable_area_m2: of the reachable vertices.
        candidates: how many of the vertex-branch candidates ended with each reason.
        unreachable: how many unreachable vertices have each reason; counted for the branch that
            passed the most tests.
        colors: see :class:`ColorReport`.
        cracks: number of mesh edges with a crack.
        notes: likely mistakes in robot and mesh, one sentence each.
        stand_ins: what collides in the place of the meshes of links, and how far off it is.
        slivers: what the sliver policy did, None without one.
        injectivity: of an arm whose solutions have no names, what was found; None for others.
        rounding: over what the normals of a mesh are rounded; None for a shape that has its own.
        seconds: wall time of each stage.
    """

    survey: Survey
    vertices: int
    reachable: int
    area_m2: float
    reachable_area_m2: float
    candidates: dict[str, int]
    unreachable: dict[str, int]
    colors: tuple[ColorReport, ...]
    cracks: int
    seconds: dict[str, float]
    notes: tuple[str, ...]
    stand_ins: tuple[StandInReport, ...] = ()
    slivers: SliverReport | None = None
    injectivity: str | None = None
    rounding: str | None = None

    @property
    def warnings(self) -> tuple[str, ...]:
        """Likely mistakes, one sentence each."""
        hulls = (stand_in.warning for stand_in in self.stand_ins)
        return self.survey.warnings + self.notes + tuple(text for text in hulls if text)

    @property
    def nothing_covered(self) -> str | None:
        """Why no vertex has a color, and what to try, in one line; None where one has."""
        if any(color.vertices for color in self.colors):
            return None
        why = "no point of the object can be covered"
        if self.reachable:
            return f"{why}: the sliver policy gave up all cells; lower slivers.uncover_below_share"
        if self.survey.seen_from_behind:
            return f"{why}: the robot sees it from behind; reverse its faces in the mesh file"
        reason, number = max(self.unreachable.items(), key=lambda item: item[1])
        vertices = count(number, "vertex", "vertices")
        why = f"{why}: the most common reason is {reason!r}, at {vertices} of {self.vertices}"
        remedy = _REMEDIES.get(reason)
        return f"{why}; {remedy}" if remedy else why

    def __str__(self) -> str:
        share = 100 * self.reachable_area_m2 / self.area_m2
        lines = [f"object  {self.survey}", *(f"warning  {text}" for text in self.warnings)]
        if self.rounding is not None:
            lines += [f"normals  {self.rounding}"]
        lines += [f"collides  {stand_in}" for stand_in in self.stand_ins]
        lines += [
            f"reachable  {self.reachable} of {self.vertices} vertices, {share:.1f} % of the area"
        ]
        lines += _table(
            "unreachable vertices, by the branch that passed the most tests", self.unreachable
        )
        lines += _table("candidates (vertex and branch)", self.candidates)
        lines += ["colors"]
        width = max((len(color.name) for color in self.colors), default=0)
        lines += [
            f"  {color.name:<{width}}  {color.vertices:>7} vertices"
            f"  {100 * color.area_m2 / self.area_m2:5.1f} %"
            for color in self.colors
        ]
        lines += [f"cracks  {self.cracks}"]
        if self.injectivity is not None:
            lines += [f"injectivity  {self.injectivity}"]
        if self.slivers is not None:
            lines += [self._slivers(self.slivers)]
        if self.nothing_covered is not None:
            lines += [self.nothing_covered]
        spent = ", ".join(f"{stage} {seconds:.2f}" for stage, seconds in self.seconds.items())
        return "\n".join([*lines, f"seconds  {sum(self.seconds.values()):.2f}: {spent}"])

    def _slivers(self, slivers: SliverReport) -> str:
        share = 100 * slivers.given_up_area_m2 / self.area_m2
        return (
            f"slivers  {count(slivers.simplified_cells, 'cell')} simplified; "
            f"{count(slivers.given_up_cells, 'cell')} given up: "
            f"{count(slivers.given_up_vertices, 'vertex', 'vertices')}, "
            f"{share:.1f} % of the area uncovered"
        )


def _table(title: str, counts: dict[str, int]) -> list[str]:
    return [title] + [f"  {reason:<18} {number:>7}" for reason, number in counts.items()]


def make_report(
    where: Survey,
    surface: Surface,
    candidates: Candidates,
    coloring: Coloring,
    branch_names: tuple[str, ...],
    cracks: int,
    seconds: dict[str, float],
    notes: tuple[str, ...],
    stand_ins: tuple[StandInReport, ...],
    slivers: SliverReport | None = None,
    injectivity: str | None = None,
    rounding: str | None = None,
) -> BuildReport:
    """Count what a build found."""
    areas = surface.vertex_areas()
    reached = candidates.valid.any(axis=1)
    # Codes are in the order of the tests.
    farthest = candidates.reasons.max(axis=1)[~reached]
    vertex, branch = np.nonzero(coloring.node_color >= 0)
    color = coloring.node_color[vertex, branch]
    sizes = np.bincount(color, minlength=len(coloring.names)).tolist()
    domains = np.bincount(color, areas[vertex], minlength=len(coloring.names)).tolist()
    colors = [
        ColorReport(name, branch_names[number], size, area)
        for name, number, size, area in zip(
            coloring.names, coloring.branch, sizes, domains, strict=True
        )
    ]
    return BuildReport(
        survey=where,
        vertices=len(areas),
        reachable=int(reached.sum()),
        area_m2=float(areas.sum()),
        reachable_area_m2=float(areas[reached].sum()),
        candidates=_counts(candidates.reasons.ravel(), candidates.reason_names, 0),
        unreachable=_counts(farthest, candidates.reason_names, 1),
        colors=tuple(colors),
        cracks=cracks,
        seconds=seconds,
        notes=notes,
        stand_ins=stand_ins,
        slivers=slivers,
        injectivity=injectivity,
        rounding=rounding,
    )


def _counts(reasons: NDArray[np.uint8], names: tuple[str, ...], first: int) -> dict[str, int]:
    """How often each reason occurs, from the code ``first`` on, by its name."""
    counts = np.bincount(reasons, minlength=len(names)).tolist()
    return dict(zip(names[first:], counts[first:], strict=True))
