"""The area of each segment as a triangle mesh of its own, cut wherever the tool may not cross.

Triangle f = (v0, v1, v2) of the painted surface is cut into six **small triangles** at its
centroid and the middles of its sides: for corner k the numbers 6f + 2k, which is (v_k, middle of
v_k v_(k+1), centroid), and 6f + 2k + 1, which is (v_k, centroid, middle of v_(k-1) v_k). A small
triangle belongs to the segment of its corner. Two of them with a common side are joined unless
another segment begins there, or the mesh edge whose middle that side ends in has a crack in the
segment's color or is a wall. Where they are not joined the region's mesh is cut, so that cracks,
walls and borders of segments are all just borders of the mesh.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.surface import LabelledSurface
from cellcolor.tool_paths.triangles import Triangles, mesh_edges

__all__ = ["Region", "regions_of", "small_triangle_areas"]


@dataclass(frozen=True, eq=False)
class Region:
    """One connected part of a segment.

    Attributes:
        segment: the segment.
        color: its color.
        mesh: the part's triangles, cut open along everything that must not be crossed.
        small: (m,) the number of the small triangle that each of its triangles lies in.
    """

    segment: int
    color: int
    mesh: Triangles
    small: Index

    @cached_property
    def border_loops(self) -> tuple[Index, ...]:
        """Vertices of each border, in order, the region on the left; none if it is closed."""
        sides = self.mesh.corners[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        known = {(a, b) for a, b in sides.tolist()}
        after = {a: b for a, b in known if (b, a) not in known}
        loops = []
        while after:
            start, vertex = after.popitem()
            loop = [start]
            while vertex != start:
                loop.append(vertex)
                vertex = after.pop(vertex)
            loops.append(np.array(loop, dtype=np.int64))
        return tuple(loops)


def small_triangle_areas(surface: LabelledSurface) -> Array:
    """Square metres (6 m,) of every small triangle: a sixth of its triangle each."""
    corners = surface.vertices[surface.faces]
    doubled = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.repeat(np.linalg.norm(doubled, axis=1) / 12.0, 6)


def regions_of(
    surface: LabelledSurface,
    segment_of: Index,
    colors: Sequence[int],
    normals: Array,
    walls: Collection[tuple[int, int]] = (),
    left_out: Index | Sequence[int] = (),
) -> tuple[Region, ...]:
    """The connected parts of all segments, by segment, the largest of each first.

    Args:
        surface: the painted surface.
        segment_of: (n,) the segment of each vertex, -1 where it has none.
        colors: of each segment.
        normals: (n, 3) outward unit normals at the vertices.
        walls: mesh edges that are not to be crossed, like cracks of whatever segment is there.
        left_out: numbers of small triangles that belong to no region.
    """
    faces = surface.faces
    vertex_count, face_count = len(surface.vertices), len(faces)
    edges, edge_of_side = mesh_edges(faces)
    color_of = np.array([*colors, -1], dtype=np.int64)[segment_of]
    closed = _closed_edges(surface, edges, color_of, walls)
    middles = vertex_count + edge_of_side
    centroids = vertex_count + len(edges) + np.arange(face_count)
    before = np.roll(middles, 1, axis=1)
    centers = np.repeat(centroids[:, None], 3, axis=1)
    small = np.stack(
        [np.stack([faces, middles, centers], 2), np.stack([faces, centers, before], 2)], axis=2
    ).reshape(-1, 3)
    kept = np.repeat(segment_of[faces].ravel() >= 0, 2)
    kept[np.asarray(left_out, dtype=np.int64)] = False
    sides, other = _sides_between(small)
    # A side between two corners' parts ends in the middle of a mesh edge and in a centroid.
    across = (sides[:, 0] >= vertex_count) & (sides[:, 1] >= vertex_count)
    crossed = np.minimum(sides[:, 0], sides[:, 1])[across] - vertex_count
    ends = segment_of[small[:, 0]]
    joined = kept[other[:, 0]] & kept[other[:, 1]]
    joined &= ends[other[:, 0]] == ends[other[:, 1]]
    joined[across] &= ~closed[crossed]
    sides, other = sides[joined], other[joined]
    points, directions = _points_and_normals(surface, edges, normals)
    vertex_of = _cut_vertices(small, sides, other)
    part_of = _components(len(small), other[:, 0], other[:, 1])
    areas = small_triangle_areas(surface)
    found = []
    own = np.flatnonzero(kept)
    own = own[np.argsort(part_of[own], kind="stable")]
    parts = np.split(own, np.flatnonzero(np.diff(part_of[own])) + 1) if len(own) else []
    for members in parts:
        used, corners = np.unique(vertex_of[members], return_inverse=True)
        at = np.empty(len(used), dtype=np.int64)
        at[corners.ravel()] = small[members].ravel()
        segment = int(ends[members[0]])
        mesh = Triangles(points[at], directions[at], corners.reshape(-1, 3), members // 6)
        region = Region(segment, int(colors[segment]), mesh, members)
        found.append((segment, -float(areas[members].sum()), int(members[0]), region))
    return tuple(region for *_, region in sorted(found, key=lambda entry: entry[:3]))


def _closed_edges(
    surface: LabelledSurface, edges: Index, color_of: Index, walls: Collection[tuple[int, int]]
) -> Mask:
    """Which mesh edges must not be crossed between the two ends' parts."""
    numbers = {(a, b): number for number, (a, b) in enumerate(edges.tolist())}
    closed = np.zeros(len(edges), dtype=bool)
    for crack in surface.cracks:
        if color_of[crack.i] in crack.colors:
            closed[numbers[crack.i, crack.j]] = True
    for a, b in walls:
        closed[numbers[min(a, b), max(a, b)]] = True
    return closed


def _sides_between(small: Index) -> tuple[Index, Index]:
    """The sides with a triangle on either hand: their ends (k, 2), and the two triangles (k, 2)."""
    sides = np.sort(small[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    order = np.lexsort((sides[:, 1], sides[:, 0]))
    sides = sides[order]
    same = np.flatnonzero((sides[1:] == sides[:-1]).all(axis=1))
    triangles = order // 3
    return sides[same], np.stack([triangles[same], triangles[same + 1]], axis=1)


def _cut_vertices(small: Index, sides: Index, other: Index) -> Index:
    """Vertices (m, 3) of the mesh cut open: corners are one where a joined side has both."""
    first: list[Index] = []
    second: list[Index] = []
    for end in range(2):
        for triangle, found in ((0, first), (1, second)):
            own = small[other[:, triangle]]
            corner = (own == sides[:, end : end + 1]).argmax(axis=1)
            found.append(3 * other[:, triangle] + corner)
    return _components(3 * len(small), np.concatenate(first), np.concatenate(second)).reshape(-1, 3)


def _components(count: int, first: Index, second: Index) -> Index:
    graph = coo_matrix((np.ones(len(first), dtype=np.int8), (first, second)), (count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _points_and_normals(
    surface: LabelledSurface, edges: Index, normals: Array
) -> tuple[Array, Array]:
    """Places and unit normals of vertices, middles and centroids, in this order."""
    points, directions = [
        np.vstack([rows, rows[edges].mean(axis=1), rows[surface.faces].mean(axis=1)])
        for rows in (surface.vertices, normals)
    ]
    lengths = np.linalg.norm(directions, axis=1, keepdims=True)
    return points, directions / np.where(lengths > 0, lengths, 1.0)
