"""A path with its corners rounded, still on the surface.

A walk along the edges of a mesh turns sharply at doors and spurs, and trembles with the mesh. Here
it is smoothed by a bell curve along its length, and the smoothed line is traced over the mesh from
triangle to triangle. Near borders and sharp edges, where there is no room or where the smoothed
line would leave the surface, the walk stays as it is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from cellcolor.arrays import Array, Index, Mask, to_nearest
from cellcolor.data.tool_paths import ToolPath
from cellcolor.deadline import Deadline
from cellcolor.tool_paths.registry import Laid
from cellcolor.tool_paths.triangles import Triangles

_BELL = 0.3  # spacings; deviation of the bell curve. It cuts a corner of 90 degrees by half of that
_STEP = 0.2  # spacings; between the points of a smoothed line
_REACH = 3.0  # deviations; so far to both sides a bell curve counts
_FROM_BORDER = 0.25  # spacings; nearer to a border the walk stays as it is
_FLAT = np.cos(np.radians(40.0))  # so far normals may turn within half the reach of the bell curve
_OFF = 0.25  # spacings; a traced point may be so far from where it was to lie
_ROUNDS = 4
_MOST_CROSSED = 100  # triangles, between two points
_OUTSIDE = 1e-9  # of a triangle; points this far outside of it count as inside
_STRAIGHT = 1e-8  # m; a point this near to the straight way past it is left out
_NEAR_BORDER = 0.001  # m; as far as samples are apart
_SAME = 1e-9  # m; points nearer to each other are one. Shorter sums of normals have no direction

Row = list[float]


@dataclass(frozen=True, eq=False)
class Line:
    """A path on a mesh as points; each step lies in one triangle.

    Attributes:
        mesh: on which it lies.
        points: (k, 3), m.
        normals: (k, 3) outward unit normals.
        triangles: (k - 1,) the triangle of the mesh that each step lies in.
        vertices: (k,) the vertex of the mesh that each point is, -1 where it is none.
    """

    mesh: Triangles
    points: Array
    normals: Array
    triangles: Index
    vertices: Index

    def path(self, segment: int, color: int) -> tuple[ToolPath, Index]:
        """The path in the world, without points on a straight way past them in one triangle.

        Returns:
            The path, and the numbers of its points near a border, beside which a chord would cut
            a corner.
        """
        faces = self.mesh.faces[self.triangles]
        needed = np.ones(len(self.points), dtype=bool)
        before, after = np.diff(self.points, axis=0)[:-1], np.diff(self.points, axis=0)[1:]
        off = np.linalg.norm(np.cross(before, after), axis=1)
        straight = off <= _STRAIGHT * np.linalg.norm(before + after, axis=1)
        straight &= (before * after).sum(axis=1) > 0
        needed[1:-1] = (faces[1:] != faces[:-1]) | ~straight
        near = np.zeros(len(self.points), dtype=bool)
        if self.mesh.border.any():
            near = (self.vertices >= 0) & (self.mesh.from_border[self.vertices] < _NEAR_BORDER)
        path = ToolPath(
            segment, color, self.points[needed], self.normals[needed], faces[needed[:-1]]
        )
        return path, np.flatnonzero(near[needed])


def line_of(laid: Laid) -> Line:
    """A walk as it is, as a line."""
    mesh, walk = laid.mesh, np.array(laid.walk, dtype=np.int64)
    triangle = np.empty(len(mesh.edges), dtype=np.int64)
    triangle[mesh.edge_of_side] = np.arange(len(mesh.corners))[:, None]
    steps = mesh.find(np.stack([walk[:-1], walk[1:]], axis=1))
    return Line(mesh, mesh.points[walk], mesh.normals[walk], triangle[steps], walk)


def rounded(laid: Laid, spacing: float, deadline: Deadline) -> Line:
    """A walk as a line with rounded corners. Its first and last point stay."""
    line = line_of(laid)
    lengths = np.linalg.norm(np.diff(line.points, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    count = int(along[-1] / (_STEP * spacing)) + 1
    if count < 4:
        return line
    grid = np.linspace(0.0, along[-1], count)
    step, bell = float(grid[1]), _BELL * spacing
    walked = np.stack([np.interp(grid, along, axis) for axis in line.points.T], axis=1)
    smooth = gaussian_filter1d(walked, bell / step, axis=0, mode="nearest", truncate=_REACH)
    held = _held(line, along, spacing)
    tracer = _Tracer(line.mesh)
    for _ in range(_ROUNDS):
        apart = np.minimum(to_nearest(grid, along[held]) / (_REACH * bell), 1.0)
        aims = walked + apart[:, None] * (smooth - walked)
        traced, failed = {}, np.zeros_like(held)
        for first, last in _stretches(held):
            deadline.check()
            low, high = np.searchsorted(grid, [along[first] + step / 2, along[last] - step / 2])
            if low >= high:
                continue
            ends = int(line.vertices[first]), int(line.vertices[last])
            way = tracer.trace(ends, aims[low:high], _OFF * spacing)
            if isinstance(way, int):
                failed |= np.abs(along - grid[low + way]) <= _REACH * bell
            else:
                traced[first] = last, way
        if not failed.any():
            break
        held |= failed
    return _joined(line, traced)


def _held(line: Line, along: Array, spacing: float) -> Mask:
    """Which points of a walk have to stay: its ends, near the border and near sharp edges."""
    held = np.zeros(len(along), dtype=bool)
    held[[0, -1]] = True
    if line.mesh.border.any():
        held |= line.mesh.from_border[line.vertices] < _FROM_BORDER * spacing
    reach = _REACH * _BELL * spacing / 2
    for side in (-reach, reach):
        there = np.clip(np.searchsorted(along, along + side), 0, len(along) - 1)
        held |= (line.normals * line.normals[there]).sum(axis=1) < _FLAT
    return held


def _stretches(held: Mask) -> list[tuple[int, int]]:
    """The first and the last point of each stretch of a walk between points that stay."""
    at = np.flatnonzero(held)
    apart = np.flatnonzero(np.diff(at) > 1)
    return list(zip(at[apart].tolist(), at[apart + 1].tolist(), strict=True))


def _joined(line: Line, traced: dict[int, tuple[int, Line]]) -> Line:
    """The walk, some stretches of it replaced: by their first point, the last one and what."""
    parts, at = [], 0
    for first, (last, way) in sorted(traced.items()):
        parts += [(line, at, first), (way, 0, len(way.triangles))]
        at = last
    parts.append((line, at, len(line.triangles)))
    # Each part ends with the point that the next one begins with.
    points, normals, vertices, triangles = (
        np.concatenate([getattr(part, name)[first:last] for part, first, last in parts])
        for name in ("points", "normals", "vertices", "triangles")
    )
    return Line(
        line.mesh,
        np.concatenate([points, line.points[-1:]]),
        np.concatenate([normals, line.normals[-1:]]),
        triangles,
        np.concatenate([vertices, line.vertices[-1:]]),
    )


class _Tracer:
    """Ways over a mesh, followed one triangle at a time; therefore all in lists."""

    def __init__(self, mesh: Triangles) -> None:
        self._mesh = mesh
        self._corners = mesh.corners.tolist()
        self._at_vertex: dict[int, list[int]] = {}
        for triangle, corners in enumerate(self._corners):
            for corner in corners:
                self._at_vertex.setdefault(corner, []).append(triangle)
        self._beyond = mesh.beyond.tolist()
        # Barycentric coordinates of a point's projection are linear in the point.
        a, b, c = (mesh.points[mesh.corners[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        square = np.maximum((normals**2).sum(axis=1), 1e-300)[:, None]
        rows = [np.cross(normals, side) / square for side in (c - b, a - c, b - a)]
        self._linear = np.stack(
            [
                np.column_stack([row, -(row * on).sum(axis=1)])
                for row, on in zip(rows, (b, c, a), strict=True)
            ],
            axis=1,
        ).tolist()

    def trace(self, ends: tuple[int, int], aims: Array, off: float) -> Line | int:
        """A line from one vertex to another past some aims, each projected on the mesh.

        Args:
            ends: the vertices.
            aims: (k, 3), near the mesh, m.
            off: how far from its aim a point may be, m.

        Returns:
            The line, or the number of the aim that is not reached without leaving the mesh.
        """
        mesh = self._mesh
        targets = [*aims.tolist(), mesh.points[ends[1]].tolist()]
        triangle = self._towards(ends[0], targets[0])
        at = [float(corner == ends[0]) for corner in self._corners[triangle]]
        places, triangles, reached = [(triangle, *at)], list[int](), list[int]()
        for number, target in enumerate(targets):
            came = -1
            for _ in range(_MOST_CROSSED):
                aim = self._coordinates(triangle, target)
                share, side = _exit(at, aim)
                at = [a + share * (b - a) for a, b in zip(at, aim, strict=True)]
                if side < 0 or (self._beyond[triangle][side] == came and share < _OUTSIDE):
                    break  # there, or on the edge that is nearest
                if share > _OUTSIDE:
                    triangles.append(triangle)
                    places.append((triangle, *at))
                onto = self._beyond[triangle][side]
                if onto < 0:
                    return min(number, len(aims) - 1)
                value = dict(zip(self._corners[triangle], at, strict=True))
                at = [value.get(corner, 0.0) for corner in self._corners[onto]]
                came, triangle = triangle, onto
            else:
                return min(number, len(aims) - 1)
            triangles.append(triangle)
            places.append((triangle, *at))
            reached.append(len(triangles))
        own = mesh.corners[[int(place[0]) for place in places]]
        shares = np.array([place[1:] for place in places])[:, :, None]
        points, normals = ((rows[own] * shares).sum(axis=1) for rows in (mesh.points, mesh.normals))
        missed = np.linalg.norm(points[reached] - targets, axis=1)
        if missed[-1] > _SAME or ends[1] not in self._corners[triangle]:
            return len(aims) - 1
        if missed.max() > off:
            return int((missed > off).argmax())
        sizes = np.linalg.norm(normals, axis=1, keepdims=True)
        if sizes.min() < _SAME:  # normals of a fold may cancel out
            return min(int(np.searchsorted(reached, sizes.argmin())), len(aims) - 1)
        normals /= sizes
        vertices = np.full(len(points), -1, dtype=np.int64)
        points[-1], vertices[[0, -1]] = mesh.points[ends[1]], ends
        moved = np.linalg.norm(np.diff(points, axis=0), axis=1) > _SAME
        moved[-1] = True
        kept = np.append(True, moved)
        return Line(mesh, points[kept], normals[kept], np.array(triangles)[moved], vertices[kept])

    def _towards(self, vertex: int, aim: Row) -> int:
        """The triangle at a vertex that an aim lies in, or comes nearest to."""

        def inside(triangle: int) -> float:
            found = self._coordinates(triangle, aim)
            return min(
                value
                for value, corner in zip(found, self._corners[triangle], strict=True)
                if corner != vertex
            )

        return max(self._at_vertex[vertex], key=inside)

    def _coordinates(self, triangle: int, point: Row) -> Row:
        """Barycentric coordinates of a point's projection onto a triangle's plane."""
        x, y, z = point
        return [a * x + b * y + c * z + d for a, b, c, d in self._linear[triangle]]


def _exit(at: Row, aim: Row) -> tuple[float, int]:
    """Where a way from one place of a triangle to another leaves it.

    Returns:
        The share of the way that lies inside, and the side that it leaves over; -1 if it does not.
    """
    best, side = 1.0, -1
    for corner in range(3):
        here, there = at[corner], aim[corner]
        if there < -_OUTSIDE and there < here:
            share = max(here, 0.0) / (max(here, 0.0) - there)
            if share < best:
                best, side = share, (corner + 1) % 3
    return best, side
