"""The result of a build for people: where the object is, reachability by reason, colors, cracks,
time.

A survey of how the object lies to the robot shows what a wrong unit, a wrong placement or a mesh
wound the wrong way would change.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import igl
import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, unit
from cellcolor.data.wording import count
from cellcolor.frontend.parts.cover import spread
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.colors import LimitColors
from cellcolor.frontend.reach.slivers import SliverReport
from cellcolor.frontend.reach.validity_tests import STANDARD_TESTS
from cellcolor.mesh.triangle_mesh import TriangleMesh

if TYPE_CHECKING:
    from cellcolor.frontend.build import BuildResult

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
        reachable: vertices with at least one valid configuration.
        area_m2: of the whole surface.
        reachable_area_m2: of the reachable vertices.
        candidates: how many of the vertex-branch candidates ended with each reason.
        unreachable: how many unreachable vertices have each reason; counted for the branch that
            passed the most tests.
        cracks: number of mesh edges with a crack.
        notes: likely mistakes in robot and mesh, one sentence each.
        stand_ins: what collides in the place of the meshes of links, in words.
        slivers: what the sliver policy did, None without one.
        injectivity: of an arm whose solutions have no names, what was found; None for others.
        rounding: over what the normals of a mesh are rounded; None for a shape that has its own.
        limits: which colors are divided by joint limits; None if none is.
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
    seconds: Mapping[str, float]
    notes: tuple[str, ...]
    stand_ins: tuple[str, ...] = ()
    slivers: SliverReport | None = None
    injectivity: str | None = None
    rounding: str | None = None
    limits: str | None = None

    @property
    def warnings(self) -> tuple[str, ...]:
        """Likely mistakes, one sentence each."""
        return self.survey.warnings + self.notes

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
        if self.limits is not None:
            lines += [f"limits  {self.limits}"]
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


_INJECTIVE = (
    "solutions have no names and are distinguished by continuity; a color with two configurations "
    "on one vertex: none found on this part"
)


def report_on(built: BuildResult) -> BuildReport:
    """What a build found."""
    prepared, verdicts, limits = built.prepared, built.verdicts, built.limits
    surface, names = prepared.surface, verdicts.reason_names
    areas, reached = surface.mesh.vertex_areas, verdicts.valid.any(axis=1)
    coloring, colors = built.coloring, []
    for color, (name, branch) in enumerate(zip(coloring.names, coloring.branch, strict=True)):
        own = coloring.node_color[:, branch] == color
        area = float(areas[own].sum())
        colors.append(ColorReport(name, built.branches[branch], int(own.sum()), area))
    # Codes are in the order of the tests.
    farthest = verdicts.reasons.max(axis=1)[~reached]
    remarks = prepared.arm.kinematics.remarks(surface.vertices, -surface.normals)
    hulls = tuple(each.warning for each in prepared.robot.stand_ins if each.warning)
    task = prepared.setup.task
    key = "contact_radius_m" if task.edge_radius_m is None else "edge_radius_m"
    rounding = f"rounded over {1e3 * task.rounding_m:g} mm (task.{key})"
    return BuildReport(
        survey=survey_of(prepared),
        vertices=len(areas),
        reachable=int(reached.sum()),
        area_m2=float(areas.sum()),
        reachable_area_m2=float(areas[reached].sum()),
        candidates=_count_reasons(verdicts.reasons.ravel(), names),
        unreachable=_count_reasons(farthest, names, 1),
        colors=tuple(colors),
        cracks=len(coloring.cracks),
        seconds=built.seconds,
        notes=prepared.notes + remarks + hulls,
        stand_ins=tuple(map(str, prepared.robot.stand_ins)),
        slivers=built.slivers_report,
        injectivity=None if prepared.arm.named else _INJECTIVE,
        rounding=rounding if surface.faceted else None,
        limits=_limits_in_words(limits) if limits.positions else None,
    )


def _limits_in_words(limits: LimitColors) -> str:
    divided = {limits.color[color] for color in limits.positions}
    text = f"{count(len(divided), 'color')} divided, so that each keeps the joint limits"
    if limits.winding:
        text += f"; {len(limits.winding)} of them cut, as they wind around"
    return text


def _count_reasons(
    reasons: NDArray[np.uint8], names: tuple[str, ...], first: int = 0
) -> dict[str, int]:
    """How often each reason occurs, from the code ``first`` on, by its name."""
    counts = np.bincount(reasons, minlength=len(names)).tolist()
    return dict(zip(names[first:], counts[first:], strict=True))


_POINTS = 500  # of the surface that are looked at
_SHORT = 1e-3  # of a line of sight; what is first on it so near its end is its own point
_DOWN = 0.5  # the cosine between a normal that faces down and gravity


@dataclass(frozen=True)
class Survey:
    """Where the object is.

    Attributes:
        size_m: of its bounding box along the axes of the world.
        distance_m: from the origin of the robot's base to the nearest point of it.
        from_behind: of an open mesh, the share (0 to 1) of what can be seen of it that shows its
            back only; 0 for a closed one and for what cannot be seen.
        facing_down: of an open part, the share of its area whose outside faces down; 0 for others.
    """

    size_m: tuple[float, ...]
    distance_m: float
    from_behind: float
    facing_down: float = 0.0

    def __str__(self) -> str:
        size = " x ".join(_meters(side) for side in self.size_m)
        return f"{size} m, nearest point {_meters(self.distance_m)} m from the robot's base"

    @property
    def seen_from_behind(self) -> bool:
        """Whether the faces are probably wound the wrong way."""
        return self.from_behind > 0.5

    @property
    def warnings(self) -> tuple[str, ...]:
        """Likely mistakes, one sentence each."""
        if self.seen_from_behind:
            why = f"the robot sees {100 * self.from_behind:.0f} % of the object only from behind"
        elif self.facing_down > 0.5:
            why = f"{100 * self.facing_down:.0f} % of the object's outside faces down"
        else:
            return ()
        return (
            f"{why}: if its faces are wound clockwise as seen from outside, the tool comes from "
            "the wrong side (flip = true under [object] turns a mesh over)",
        )


def survey_of(prepared: PreparedScene) -> Survey:
    """Measure the surface of a scene where it stands."""
    vertices, mesh = prepared.surface.vertices, prepared.surface.mesh
    base = prepared.robot.base_frame(None)[:3, 3]
    squared = igl.point_mesh_squared_distance(base[None], vertices, prepared.surface.faces)[0]
    viewpoints = prepared.arm.kinematics.viewpoints
    gravity = np.array(prepared.setup.task.gravity_m_per_s2)
    solid, down = TriangleMesh(prepared.own_body.vertices, prepared.own_body.faces), 0.0
    if solid.border.any() and gravity.any():
        down = mesh.areas[mesh.triangle_normals @ unit(gravity) > _DOWN].sum() / mesh.areas.sum()
    return Survey(
        tuple((vertices.max(axis=0) - vertices.min(axis=0)).tolist()),
        float(np.sqrt(squared[0])),
        from_behind(mesh, viewpoints) if mesh.border.any() else 0.0,
        float(down),
    )


def from_behind(mesh: TriangleMesh, viewpoints: Array) -> float:
    """The share of the visible points that are seen only from behind.

    Args:
        viewpoints: (v, 3) from where it is seen, in the world, m.
    """
    points, face = spread(mesh, _POINTS)
    tree = igl.AABB()
    tree.init(mesh.points, mesh.corners)
    seen, front = np.zeros((2, len(points)), dtype=bool)
    for eye in viewpoints:
        sights = points - eye
        first = tree.intersect_ray_first(mesh.points, mesh.corners, points - sights, sights)[1]
        visible = first > 1 - _SHORT
        seen |= visible
        front |= visible & (np.einsum("ij,ij->i", mesh.area_vectors[face], sights) < 0)
    return float((seen & ~front).sum() / max(seen.sum(), 1))


def _meters(length: float) -> str:
    """Three digits, whether it is 0.7 mm or 70 m."""
    return f"{length:.0f}" if length >= 100 else f"{length:.3g}"
