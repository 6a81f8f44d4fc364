"""Regions that reach beyond the border of their segment, so that no seam is left between two."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.surface import LabelledSurface
from cellcolor.tool_paths.region import Segments, kept_parts
from cellcolor.tool_paths.triangles import Triangles, split_at

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
