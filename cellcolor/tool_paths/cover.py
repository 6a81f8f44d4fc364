"""Every segment of a painted surface covered by tool paths."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPath, ToolPaths
from cellcolor.data.wording import in_meters, looks_like_millimeters
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.tool_paths.interface import Laid, Pattern
from cellcolor.tool_paths.measures import PathMeasures, Uncovered, in_all, measure
from cellcolor.tool_paths.overlap import Overlap, clipped, owned
from cellcolor.tool_paths.refused import Refusals, RefusedPlace, without_refused
from cellcolor.tool_paths.region import Region, regions_of
from cellcolor.tool_paths.registry import DEFAULT_PATTERN, find_pattern
from cellcolor.tool_paths.rounding import Line, rounded
from cellcolor.tool_paths.spurs import with_spurs
from cellcolor.tool_paths.triangles import Triangles

_TRIANGLES = 24  # for each square of the spacing, about
_MOST_TRIANGLES = 4_000_000
_REFUSED = 0.25  # spacings: sides of triangles at the border of what is refused
_LEAST_AREA = 0.25  # spacings squared: smaller parts have no path
_TURNED = 1e-6  # rad; a border that turns by less is straight, and has no direction to keep off to
_OFTEN = 1.2  # visits in the mean; where a pattern makes more, a single line is tried,
_NARROW = 2.0  # if the part is narrower in the mean, in spacings
_MIDDLE = 0.15  # spacings: so near to its middle that line is
_COVERED = 0.98  # share of the part's area that this has to cover, if the pattern does
_STRAIGHT = 1e-8  # m; a point so little beside the way past it is left out
_INWARD = 2e-5  # m; so far off the border points are put that lie on it
_INWARD_SHARE = 0.1  # of the way into the triangle, at most


@dataclass(frozen=True, repr=False, eq=False)
class Covered:
    """Tool paths, and what they are worth.

    Attributes:
        paths: one path for every connected part of a segment that is large enough.
        measures: of each path, in the same order.
        in_all: of all together.
        uncovered: what no path comes near to, and why, the largest first.
        along_border: of each path, its points beside a border that it runs along; where a chord
            cuts a corner there, it may lie beyond the border.
    """

    paths: ToolPaths
    measures: tuple[PathMeasures, ...]
    in_all: PathMeasures
    uncovered: tuple[Uncovered, ...]
    along_border: tuple[Index, ...] = ()

    def __str__(self) -> str:
        visits = f"{self.in_all.mean_visits:.2f} visits"
        return f"{self.paths}, {100 * self.in_all.covered:.2f} % covered, {visits}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self}>"


def cover(
    surface: LabelledSurface,
    segment_of: Index,
    colors: Sequence[int],
    normals: Array,
    *,
    pattern: str = DEFAULT_PATTERN,
    spacing_m: float,
    tool_radius_m: float,
    walls: Collection[tuple[int, int]] = (),
    refusals: Refusals | None = None,
    overlap: Overlap | None = None,
    deadline: Deadline = NEVER,
    progress: Callable[[str], None] | None = None,
) -> Covered:
    """Lay a path on every connected part of every segment (docs/tool-paths.md).

    Args:
        surface: the painted surface.
        segment_of: (n,) the segment of each vertex, -1 where it has none.
        colors: of each segment.
        normals: (n, 3) outward unit normals at the vertices.
        pattern: the name of a registered pattern.
        spacing_m: desired distance between neighboring passes, m.
        tool_radius_m: of the tool's footprint, m.
        walls: mesh edges that no path may cross, like cracks of whatever segment is there.
        refusals: where the tool must not touch the segments.
        overlap: how far paths may go beyond the border of the only segment.
        deadline: when to give up.
        progress: told in a few words what is being done.

    Raises:
        InputError: there is no such pattern, a length is not positive, the tool's radius is larger
            than the part, or the spacing is so small that the meshes would not fit into memory.
        OutOfTime: the deadline came first.
    """
    lay = find_pattern(pattern)
    _check_lengths(surface, spacing_m, tool_radius_m)
    paths, measures, along_border = [], [], []
    parts, uncovered = _parts(
        surface, segment_of, colors, normals, walls, refusals, overlap, spacing_m
    )
    for number, (region, part) in enumerate(parts):
        deadline.check()
        if progress is not None:
            progress(f"covering part {number + 1} of {len(parts)}")
        area = float(part.areas.sum())
        if area < _LEAST_AREA * spacing_m**2:
            place = _point(part.points[part.corners[0]].mean(axis=0))
            cause = "a part smaller than a quarter of the spacing squared"
            uncovered.append(Uncovered(region.segment, area, place, cause))
            continue
        line, own, left = _better(lay, part, region.segment, spacing_m, deadline)
        path, beside = _path(region, line)
        paths.append(path)
        along_border.append(beside)
        measures.append(own)
        uncovered += left
    uncovered.sort(key=lambda place: (-place.area_m2, place.place))
    return Covered(
        ToolPaths(surface.name, pattern, spacing_m, tool_radius_m, tuple(paths), surface.sha256),
        tuple(measures),
        in_all(measures, spacing_m),
        tuple(uncovered),
        tuple(along_border),
    )


def _parts(
    surface: LabelledSurface,
    segment_of: Index,
    colors: Sequence[int],
    normals: Array,
    walls: Collection[tuple[int, int]],
    refusals: Refusals | None,
    overlap: Overlap | None,
    spacing: float,
) -> tuple[list[tuple[Region, Triangles]], list[Uncovered]]:
    """The meshes that paths are laid on, each with its region, and what of segments is refused."""

    def allowed(mesh: Triangles) -> tuple[list[Triangles], list[RefusedPlace]]:
        if refusals is None:
            return [mesh], []
        return without_refused(mesh, refusals, _REFUSED * spacing, _LEAST_AREA * spacing**2)

    parts, uncovered = [], []
    for region in regions_of(surface, segment_of, colors, normals, walls):
        own, refused = allowed(region.mesh)
        parts += [(region, part) for part in own]
        uncovered += [
            Uncovered(region.segment, place.area_m2, _point(place.place), place.why)
            for place in refused
        ]
    if overlap is not None:  # what is refused beyond the border is not the segment's
        inside = segment_of >= 0
        widened = np.where(overlap.widened(surface, inside), segment_of.max(), -1)
        parts = [
            (region, part)
            for region in regions_of(surface, widened, colors, normals, walls)
            for mesh in clipped(region.mesh, surface, inside, overlap.beyond, _REFUSED * spacing)
            for part in allowed(mesh)[0]
            if owned(part, surface, inside).any()
        ]
    return parts, uncovered


def _better(
    lay: Pattern, part: Triangles, segment: int, spacing: float, deadline: Deadline
) -> tuple[Line, PathMeasures, list[Uncovered]]:
    """A line by a pattern, or one along the part with spurs where that goes over it less often.

    In a part that is hardly wider than the spacing, loops go over most places twice.
    """

    def measured(laid: Laid) -> tuple[Line, PathMeasures, list[Uncovered]]:
        line = rounded(with_spurs(laid, spacing, deadline), spacing, deadline)
        return line, *measure(line, segment, spacing)

    first = measured(lay(part, spacing, deadline))
    wide = 2 * first[1].area_m2 > _NARROW * spacing * first[1].border_m
    if wide or first[1].mean_visits <= _OFTEN:
        return first
    other = measured(Laid(part.refined(_MIDDLE * spacing), []))
    less = other[1].mean_visits < first[1].mean_visits
    return other if less and other[1].covered >= min(_COVERED, first[1].covered) else first


def _check_lengths(surface: LabelledSurface, spacing_m: float, tool_radius_m: float) -> None:
    for name, length in (("spacing_m", spacing_m), ("tool_radius_m", tool_radius_m)):
        if not (math.isfinite(length) and length > 0):
            raise InputError(None, name, f"must be positive and finite, is {length}")
    size = np.ptp(surface.vertices, axis=0)
    if tool_radius_m > float(np.linalg.norm(size)):
        message = (
            f"larger than the part ({in_meters(size.tolist(), ' x ')}): "
            f"{looks_like_millimeters(tool_radius_m)}"
        )
        raise InputError(None, "tool_radius_m", message)
    area = float(surface.vertex_areas.sum())
    needed = area / spacing_m**2 * _TRIANGLES
    if needed > _MOST_TRIANGLES:
        text = f"needs about {needed:.2g} triangles, at most {_MOST_TRIANGLES:,} fit"
        raise InputError(None, "spacing_m", text)


def check_spacing(surface: LabelledSurface, segment_of: Index, spacing_m: float) -> None:
    """Refuse a spacing that is larger than every segment; small segments may be among them.

    Args:
        surface: the painted surface.
        segment_of: (n,) the segment of each vertex, -1 where it has none: all segments of it.
        spacing_m: desired distance between neighboring passes, m.

    Raises:
        InputError: it is larger.
    """
    at = segment_of[surface.faces]
    # A segment ends inside the triangles that it shares with others.
    sizes = [
        np.ptp(surface.vertices[surface.faces[(at == segment).any(axis=1)]], axis=(0, 1))
        for segment in np.unique(segment_of[segment_of >= 0]).tolist()
        if (at == segment).any()
    ]
    largest = max(sizes, key=lambda size: float(np.linalg.norm(size)), default=None)
    if largest is not None and spacing_m > float(np.linalg.norm(largest)):
        message = (
            f"larger than the largest segment ({in_meters(largest.tolist(), ' x ')}): "
            f"{looks_like_millimeters(spacing_m)}"
        )
        raise InputError(None, "spacing_m", message)


def _path(region: Region, line: Line) -> tuple[ToolPath, Index]:
    """The path in the world, a hair inside the region where it runs along the border.

    On the border itself rounding decides on which side of a crack a point lies. Each step stays in
    its triangle, so where the triangle beside the border changes, the path touches the border,
    unless both lie in one triangle of the surface and the border is convex there. Where a path
    turns round a corner of the border, such as the end of a crack, it keeps off that as well.

    Returns:
        The path, and the numbers of its points that were put inside.
    """
    mesh, walk = line.mesh, line.vertices
    faces = mesh.faces[line.triangles]
    along = np.flatnonzero((walk[:-1] >= 0) & (walk[1:] >= 0))
    number = mesh.find(np.stack([walk[along], walk[along + 1]], axis=1))
    on_border = np.zeros(len(faces), dtype=bool)
    on_border[along] = mesh.triangles_at[number] == 1
    angles, around = _round_corners(mesh)
    points, normals = [line.points[0]], [line.normals[0]]
    owns: list[Any] = []
    moved: list[int] = []
    for step, beside in enumerate(on_border.tolist()):
        ends, face = walk[step : step + 2], faces[step]
        if beside:
            third = mesh.points[np.setdiff1d(mesh.corners[line.triangles[step]], ends)[0]]
            before = step and on_border[step - 1] and faces[step - 1] == face
            if before and angles[ends[0]] < np.pi:
                for rows in (points, normals, owns):
                    rows.pop()
            for end in ends:
                way = third - mesh.points[end]
                moved.append(len(points))
                share = min(_INWARD / max(float(np.linalg.norm(way)), _INWARD), _INWARD_SHARE)
                points.append(mesh.points[end] + share * way)
                normals.append(mesh.normals[end])
                owns.append(face)
        off = around[ends[1]] if ends[1] >= 0 else 0.0
        points.append(line.points[step + 1] + off)
        normals.append(line.normals[step + 1])
        owns.append(face)
        if np.any(off):
            moved.append(len(points) - 1)
    kept = _bends(np.array(points), np.array(owns))
    kept[moved] = True
    path = ToolPath(
        region.segment,
        region.color,
        np.array(points)[kept],
        np.array(normals)[kept],
        np.array(owns)[kept[:-1]],
    )
    return path, np.cumsum(kept)[moved] - 1


def _bends(points: Array, owns: Array) -> Mask:
    """Which points (k,) are needed: those where the triangle (k - 1,) or the direction changes."""
    needed = np.ones(len(points), dtype=bool)
    before, after = points[1:-1] - points[:-2], points[2:] - points[1:-1]
    whole = np.linalg.norm(before + after, axis=1)
    off = np.linalg.norm(np.cross(before, after), axis=1)
    onward = (before * after).sum(axis=1) > 0
    needed[1:-1] = (owns[1:] != owns[:-1]) | (off > _STRAIGHT * whole) | ~onward
    return needed


def _round_corners(mesh: Triangles) -> tuple[Array, Array]:
    """The angle (n,) inside the mesh at each point, and how far (n, 3) to keep off corners, m.

    Corners are points of the border with more than half a circle inside. On those whose triangles
    all lie in one triangle of the surface a point can be moved.
    """
    corners = mesh.corners.ravel()
    angles, inward = np.zeros(len(mesh.points)), np.zeros((len(mesh.points), 3))
    np.add.at(angles, corners, _angles(mesh.points[mesh.corners]).ravel())
    # Away from both border edges that meet there, which at the end of a crack are the same.
    border = mesh.edges[mesh.triangles_at == 1]
    along = mesh.points[border[:, 1]] - mesh.points[border[:, 0]]
    lengths = np.linalg.norm(along, axis=1, keepdims=True)
    along /= np.where(lengths > 0, lengths, 1.0)  # vertices may coincide
    np.add.at(inward, border[:, 0], -along)
    np.add.at(inward, border[:, 1], along)
    least, most = np.full(len(mesh.points), np.inf), np.full(len(mesh.points), -1)
    first = np.full(len(mesh.points), len(mesh.faces) + int(mesh.faces.max(initial=0)))
    faces = np.repeat(mesh.faces, 3)
    np.minimum.at(least, mesh.edges.ravel(), np.repeat(mesh.lengths, 2))
    np.minimum.at(first, corners, faces)
    np.maximum.at(most, corners, faces)
    sizes = np.linalg.norm(inward, axis=1)
    turned = mesh.border & (angles > np.pi + _TURNED) & (first == most) & (sizes > 0)
    far = np.where(turned, np.minimum(_INWARD, _INWARD_SHARE * least), 0.0)
    return angles, far[:, None] * inward / np.where(sizes > 0, sizes, 1.0)[:, None]


def _angles(triangles: Array) -> Array:
    """Angles (m, 3) at the corners of triangles (m, 3, 3), rad."""
    one = np.roll(triangles, -1, axis=1) - triangles
    other = np.roll(triangles, 1, axis=1) - triangles
    across = np.linalg.norm(np.cross(one, other), axis=2)
    return np.asarray(np.arctan2(across, (one * other).sum(axis=2)))


def _point(row: Array) -> tuple[float, float, float]:
    x, y, z = row.tolist()
    return x, y, z
