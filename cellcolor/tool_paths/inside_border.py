"""A line on a mesh as a tool path, a hair inside the border where it runs along it.

On the border itself rounding decides on which side of a crack a point lies.
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.tool_paths import ToolPath
from cellcolor.tool_paths.region import Region
from cellcolor.tool_paths.rounding import Line
from cellcolor.tool_paths.triangles import Triangles

_TURNED = 1e-6  # rad; a border that turns by less counts as straight: it has no inward direction
_STRAIGHT = 1e-8  # m; a point this near to the straight way past it is left out
_INWARD = 2e-5  # m; how far points on the border are moved off it
_INWARD_SHARE = 0.1  # of the way into the triangle, at most


def inside_border(region: Region, line: Line) -> tuple[ToolPath, Index]:
    """The path in the world, moved off the border by a hair.

    Each step stays in its triangle. Between two steps along the border the path goes round their
    common vertex, over the edges that meet there. Where it only turns round a corner of the border,
    such as the end of a crack, it keeps off that corner as well.

    Returns:
        The path, and the numbers of the points that must be sampled, since a chord past them would
        cut the border: one beside each of its vertices.
    """
    mesh, walk, triangles = line.mesh, line.vertices.tolist(), line.triangles.tolist()
    on_border = [*_on_border(line).tolist(), False]
    off_corner = _off_corners(mesh)
    points, normals = [line.points[0]], [line.normals[0]]
    owns, kept, asked = list[int](), list[int](), list[int]()

    def beside(vertex: int, toward: Array, triangle: int, ask: bool) -> None:
        way = toward - mesh.points[vertex]
        share = min(_INWARD / max(float(np.linalg.norm(way)), _INWARD), _INWARD_SHARE)
        kept.append(len(points))
        if ask:
            asked.append(len(points))
        points.append(mesh.points[vertex] + share * way)
        normals.append(mesh.normals[vertex])
        owns.append(triangle)

    inside = False
    for step, triangle in enumerate(triangles):
        start, end = walk[step : step + 2]
        if on_border[step]:
            centroid = mesh.points[mesh.corners[triangle]].mean(axis=0)
            if not inside:
                beside(start, centroid, triangle, True)
            inside = on_border[step + 1]
            spokes = _round(mesh, end, start, triangle, triangles[step + 1]) if inside else None
            inside = spokes is not None
            if spokes:
                middle = _middle(mesh, end, spokes, triangles[step + 1])
                for number, (other, before) in enumerate(spokes):
                    beside(end, mesh.points[other], before, number == middle)
            else:
                beside(end, centroid, triangle, True)
            if inside:
                continue
        corner = off_corner[end] if end >= 0 else np.zeros(3)
        if corner.any():
            kept.append(len(points))
            asked.append(len(points))
        points.append(line.points[step + 1] + corner)
        normals.append(line.normals[step + 1])
        owns.append(triangle)
    faces = mesh.faces[owns]
    needed = _bends(np.array(points), faces)
    needed[kept] = True
    path = ToolPath(
        region.segment,
        region.color,
        np.array(points)[needed],
        np.array(normals)[needed],
        faces[needed[:-1]],
    )
    return path, np.cumsum(needed)[asked] - 1


def _on_border(line: Line) -> Mask:
    """Which steps of a line (k - 1,) lead along the border."""
    mesh, walk = line.mesh, line.vertices
    along = np.flatnonzero((walk[:-1] >= 0) & (walk[1:] >= 0))
    number = mesh.find(np.stack([walk[along], walk[along + 1]], axis=1))
    found = np.zeros(len(line.triangles), dtype=bool)
    found[along] = mesh.triangles_at[number] == 1
    return found


def _round(
    mesh: Triangles, vertex: int, behind: int, first: int, last: int
) -> list[tuple[int, int]] | None:
    """The way round a vertex of the border, from one triangle at it to another.

    The way comes along the border from ``behind``. It is returned as the other ends of the edges
    that it crosses, each with the triangle before it; None where the triangles at the vertex are
    not connected, because parts touch in a point.
    """
    spokes, triangle = list[tuple[int, int]](), first
    while triangle != last:
        corners = mesh.corners[triangle].tolist()
        (other,) = set(corners) - {vertex, behind}
        side = next(k for k in range(3) if behind not in (corners[k], corners[k - 2]))
        onto = int(mesh.across[triangle, side]) // 3
        if onto < 0:
            return None
        spokes.append((other, triangle))
        behind, triangle = other, onto
    return spokes


def _middle(mesh: Triangles, vertex: int, spokes: list[tuple[int, int]], last: int) -> int:
    """The number of the spoke that is nearest to half of the angle round a vertex."""
    corners = mesh.corners[[*(before for _, before in spokes), last]]
    angles = _angles(mesh.points[corners])[corners == vertex]
    passed = np.cumsum(angles)
    return int(np.abs(passed[:-1] - passed[-1] / 2).argmin())


def _bends(points: Array, owns: Index) -> Mask:
    """Which points (k,) are needed: those where the triangle (k - 1,) or the direction changes."""
    needed = np.ones(len(points), dtype=bool)
    before, after = points[1:-1] - points[:-2], points[2:] - points[1:-1]
    whole = np.linalg.norm(before + after, axis=1)
    off = np.linalg.norm(np.cross(before, after), axis=1)
    onward = (before * after).sum(axis=1) > 0
    needed[1:-1] = (owns[1:] != owns[:-1]) | (off > _STRAIGHT * whole) | ~onward
    return needed


def _off_corners(mesh: Triangles) -> Array:
    """How far (n, 3) to keep off corners at each point, m.

    Corners are points of the border with more than half a circle inside. A point can be moved off
    only if all triangles around it lie in one triangle of the surface.
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
    shortest, last = np.full(len(mesh.points), np.inf), np.full(len(mesh.points), -1)
    first = np.full(len(mesh.points), len(mesh.faces) + int(mesh.faces.max(initial=0)))
    faces = np.repeat(mesh.faces, 3)
    np.minimum.at(shortest, mesh.edges.ravel(), np.repeat(mesh.lengths, 2))
    np.minimum.at(first, corners, faces)
    np.maximum.at(last, corners, faces)
    sizes = np.linalg.norm(inward, axis=1)
    turned = mesh.border & (angles > np.pi + _TURNED) & (first == last) & (sizes > 0)
    far = np.where(turned, np.minimum(_INWARD, _INWARD_SHARE * shortest), 0.0)
    return far[:, None] * inward / np.where(sizes > 0, sizes, 1.0)[:, None]


def _angles(triangles: Array) -> Array:
    """Angles (m, 3) at the corners of triangles (m, 3, 3), rad."""
    one = np.roll(triangles, -1, axis=1) - triangles
    other = np.roll(triangles, 1, axis=1) - triangles
    across = np.linalg.norm(np.cross(one, other), axis=2)
    return np.asarray(np.arctan2(across, (one * other).sum(axis=2)))
