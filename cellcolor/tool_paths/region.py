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
from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.surface import LabelledSurface
from cellcolor.mesh.dividing import small_areas, small_triangles, unit_everywhere
from cellcolor.mesh.triangle_mesh import grouped
from cellcolor.tool_paths.triangles import Triangles, split_at


class Segments(NamedTuple):
    """A painted surface.

    Attributes:
        surface: the surface.
        segment_of: (n,) the segment of each vertex, -1 where it has none.
        colors: of each segment.
        normals: (n, 3) outward at the vertices, of any length, which counts between them.
    """

    surface: LabelledSurface
    segment_of: Index
    colors: Sequence[int]
    normals: Array


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


def regions_of(segments: Segments, walls: Collection[tuple[int, int]] = ()) -> tuple[Region, ...]:
    """The connected parts of all segments, by segment, the largest of each first.

    Args:
        walls: mesh edges along which they are cut open, like cracks of whatever segment is there.
    """
    surface, segment_of, colors, normals = segments
    mesh, vertex_count = surface.mesh, len(surface.vertices)
    color_of = np.array([*colors, -1], dtype=np.int64)[segment_of]
    cracks = [(crack.i, crack.j) for crack in surface.cracks if color_of[crack.i] in crack.colors]
    closed = mesh.marked([*cracks, *walls])
    fine, _ = small_triangles(mesh)
    small = fine.corners
    kept = np.repeat(segment_of[mesh.corners].ravel() >= 0, 2)
    inner, other = fine.pairs
    sides, other = fine.edges[inner], other // 3
    # A side between two corners' parts ends in the middle of a mesh edge and in a centroid.
    across = (sides[:, 0] >= vertex_count) & (sides[:, 1] >= vertex_count)
    crossed = np.minimum(sides[:, 0], sides[:, 1])[across] - vertex_count
    ends = segment_of[small[:, 0]]
    joined = kept[other[:, 0]] & kept[other[:, 1]]
    joined &= ends[other[:, 0]] == ends[other[:, 1]]
    joined[across] &= ~closed[crossed]
    faces = np.arange(len(small)) // 6
    whole = Triangles(fine.points, small, unit_everywhere(mesh, normals), faces)
    areas = small_areas(mesh)
    found = []
    for members, part in parts_of(whole, kept, sides[joined], other[joined]):
        segment = int(ends[members[0]])
        region = Region(segment, int(colors[segment]), part, members)
        found.append((segment, -float(areas[members].sum()), int(members[0]), region))
    return tuple(region for *_, region in sorted(found, key=lambda entry: entry[:3]))


def parts_of(
    mesh: Triangles, kept: Mask, sides: Index, other: Index
) -> list[tuple[Index, Triangles]]:
    """The connected parts of some triangles, each with the numbers of its triangles.

    Args:
        mesh: all triangles.
        kept: (m,) which of them are meant.
        sides: (p, 2) the ends of the sides that triangles are joined over; a part is cut open
            along all others.
        other: (p, 2) the two triangles of each, both kept.
    """
    vertex_of = _cut_vertices(mesh.corners, sides, other)
    part_of = grouped(len(mesh.corners), other)
    own = np.flatnonzero(kept)
    own = own[np.argsort(part_of[own], kind="stable")]
    found = []
    for members in np.split(own, np.flatnonzero(np.diff(part_of[own])) + 1) if len(own) else []:
        used, corners = np.unique(vertex_of[members], return_inverse=True)
        at = np.empty(len(used), dtype=np.int64)
        at[corners.ravel()] = mesh.corners[members].ravel()
        corners = corners.reshape(-1, 3)
        part = Triangles(mesh.points[at], corners, mesh.normals[at], mesh.faces[members])
        found.append((members, part))
    return found


def kept_parts(mesh: Triangles, kept: Mask) -> list[tuple[Index, Triangles]]:
    """The connected parts of the kept triangles (m,), each with the numbers of its triangles."""
    inner, other = mesh.pairs
    other = other // 3
    joined = kept[other].all(axis=1)
    return parts_of(mesh, kept, mesh.edges[inner[joined]], other[joined])


def _cut_vertices(small: Index, sides: Index, other: Index) -> Index:
    """Vertices (m, 3) of the mesh cut open: corners are one where a joined side has both."""
    links = []
    for end in range(2):
        same = [
            3 * triangle + (small[triangle] == sides[:, end : end + 1]).argmax(axis=1)
            for triangle in other.T
        ]
        links.append(np.stack(same, axis=1))
    return grouped(3 * len(small), np.concatenate(links)).reshape(-1, 3)


_SNAPPED = 0.01  # of the finest side: a vertex so near to the new border counts as on it


@dataclass(frozen=True, eq=False)
class Overlap:
    """How far the paths of a segment may go beyond its border.

    Attributes:
        beyond: (n,) along the surface, from the parts of the segment's own vertices, m.
        onto: (n,) the vertices of other segments on whose parts they may go.
    """

    beyond: Array
    onto: Mask

    @classmethod
    def of(cls, segments: Segments, segment: int, width: float) -> Overlap:
        """What makes a segment and its neighbors overlap by a width (m) where colors allow it.

        It goes half of that beyond its border; all of it where the neighbor's color is not
        available on this side, and so the neighbor cannot come here.
        """
        surface, segment_of, colors, _ = segments
        own = segment_of == segment
        has_color = np.array([colors[segment] in of for of in surface.vertex_colors], dtype=bool)
        beyond = np.full(len(own), width)
        edges = surface.mesh.edges
        ways = np.concatenate([edges, edges[:, ::-1]])
        ways = ways[own[ways[:, 0]] & ~own[ways[:, 1]] & (segment_of[ways[:, 1]] >= 0)]
        for here, there in ways.tolist():
            if colors[segment_of[there]] in surface.vertex_colors[here]:
                beyond[here] = width / 2
        return cls(beyond, has_color & (segment_of >= 0) & ~own)

    def widened(self, surface: LabelledSurface, own: Mask) -> Mask:
        """The segment's own vertices (n,) and those of ``onto`` that may be near enough."""
        mesh, lengths = surface.mesh, surface.mesh.lengths
        n = len(own)
        graph = csr_array((np.maximum(lengths, 1e-12), tuple(mesh.edges.T)), shape=(n, n))
        # A vertex owns at most the half of its edges that is nearer to it.
        limit = self.beyond.max() + float(lengths.max(initial=0.0))
        apart = dijkstra(
            graph, directed=False, indices=np.flatnonzero(own), min_only=True, limit=limit
        )
        return np.asarray(own | (self.onto & np.isfinite(apart)))


def clipped(
    mesh: Triangles, surface: LabelledSurface, own: Mask, beyond: Array, finest: float
) -> list[Triangles]:
    """The parts of a widened region that are not too far from the segment itself.

    Distances are along the region, so they do not lead over cracks, walls or other segments.

    Args:
        mesh: a connected part of the segment's own area and what is around it.
        own: (n,) the surface's vertices in the segment.
        beyond: (n,) how far the region may go beyond the part of each, m.
        finest: sides of triangles beyond the segment's border, m.
    """
    owner = _owner(mesh, surface)
    if own[owner].all():
        return [mesh]
    if not own[owner].any():
        return []
    while True:
        split = np.zeros(len(mesh.edges), dtype=bool)
        split[mesh.edge_of_side[~own[owner]].ravel()] = True
        split &= mesh.lengths > finest
        if not split.any():
            break
        mesh, _ = split_at(mesh, split, 0.5)
        owner = _owner(mesh, surface)
    inside = own[owner]
    left = np.full(len(mesh.points), -1.0)  # of the way that may be gone, m
    np.maximum.at(left, mesh.corners[inside].ravel(), np.repeat(beyond[owner[inside]], 3))
    sources = np.flatnonzero(left >= 0)
    left = -mesh.distances_from(sources, -left[sources])
    left[np.abs(left) < _SNAPPED * finest] = 0.0
    one, two = left[mesh.edges].T
    split = one * two < 0
    shares = np.where(split, one / np.where(split, one - two, 1.0), 0.5)
    count = len(left)
    mesh, _ = split_at(mesh, split, shares)
    left = np.concatenate([left, np.zeros(len(mesh.points) - count)])
    kept = np.asarray((left[mesh.corners] >= 0).all(axis=1))
    return [part for _, part in kept_parts(mesh, kept)]


def owned(mesh: Triangles, surface: LabelledSurface, own: Mask) -> Mask:
    """Which triangles (m,) of a region lie in the parts of some vertices (n,) of the surface."""
    return np.asarray(own[_owner(mesh, surface)], dtype=bool)


def _owner(mesh: Triangles, surface: LabelledSurface) -> Index:
    """The vertex of the surface in whose part each triangle (m,) lies.

    That is the corner of the surface's triangle whose share is the largest there.
    """
    shares = surface.mesh.shares(mesh.faces, mesh.points[mesh.corners].mean(axis=1))
    return np.asarray(surface.faces[mesh.faces, shares.argmax(axis=1)])
