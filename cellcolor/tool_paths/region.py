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

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.surface import LabelledSurface
from cellcolor.mesh.dividing import small_areas, small_triangles, unit_everywhere
from cellcolor.mesh.triangle_mesh import grouped
from cellcolor.tool_paths.triangles import Triangles


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
