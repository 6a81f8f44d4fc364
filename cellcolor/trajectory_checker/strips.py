"""Where neighboring segments overlap on purpose: in strips beside what only one of them visits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask
from cellcolor.trajectory_checker.fine_mesh import FineMesh


@dataclass(frozen=True)
class Strips:
    """What each segment visits alone, and how far from there it may visit what others do.

    Attributes:
        alone: the places of each segment, as a tree.
        width: m.
    """

    alone: dict[int, cKDTree]
    width: float

    @classmethod
    def of(cls, fine: FineMesh, visits: csr_array, width: float) -> Strips:
        """Those of visits (n, segments) of the vertices of the fine mesh."""
        once = np.flatnonzero(np.diff(visits.indptr) == 1)
        segment = visits.indices[visits.indptr[once]]
        return cls(
            {
                number: cKDTree(fine.vertices[once[segment == number]])
                for number in np.unique(segment).tolist()
            },
            width,
        )

    def near(self, points: Array, segment: Index) -> Mask:
        """Which points (k, 3) are in the strip of their segment (k,), or in what it has alone."""
        found = np.zeros(len(points), dtype=bool)
        for number, tree in self.alone.items():
            own = np.flatnonzero(segment == number)
            found[own] = tree.query(points[own], distance_upper_bound=self.width)[0] < np.inf
        return found

    def counted(self, fine: FineMesh, visits: csr_array) -> Index:
        """How often (n,) each vertex is visited, in strips by the segment that does so most."""
        total = visits.sum(axis=1)
        vertex, segment = visits.tocoo().coords
        outside = np.zeros(len(total), dtype=bool)
        outside[vertex[~self.near(fine.vertices[vertex], segment)]] = True
        return np.asarray(np.where(outside, total, visits.max(axis=1).toarray().ravel()))
