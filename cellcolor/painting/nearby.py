"""What is near each vertex of a mesh: its neighbors, and theirs."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from cellcolor.arrays import Array, Index, numbered
from cellcolor.data.surface import LabelledSurface

_RINGS = 19
"""Vertices within two mesh edges of one in a regular mesh, itself among them."""


class Nearby:
    """The vertices within two mesh edges of each vertex of a surface.

    Attributes:
        surface: the labelled surface.
        edges: (k, 2) its mesh edges.
        areas: (n,) m² that each vertex owns.
    """

    def __init__(self, surface: LabelledSurface) -> None:
        self.surface = surface
        self.areas, self.edges = surface.vertex_areas, surface.mesh.edges
        count = len(surface.vertices)
        self._keys = _two_steps(self.edges, count)
        self._first = np.searchsorted(self._keys, np.arange(count + 1) * count)
        self._known: dict[int, list[tuple[int, float, float]]] = {}

    @cached_property
    def mean_edge(self) -> float:
        """Mean length of the mesh edges, m."""
        return float(self.surface.mesh.lengths.mean())

    @cached_property
    def around(self) -> list[list[int]]:
        """The neighbors of each vertex."""
        found: list[list[int]] = [[] for _ in self.areas]
        for a, b in self.edges.tolist():
            found[a].append(b)
            found[b].append(a)
        return found

    @cached_property
    def link(self) -> list[list[tuple[int, int]]]:
        """The mesh edges opposite to each vertex in its triangles."""
        found: list[list[tuple[int, int]]] = [[] for _ in self.areas]
        for (a, b), c in self.surface.left_of.items():
            found[c].append((a, b))
        return found

    def near(self, vertex: int) -> list[tuple[int, float, float]]:
        """The others within two mesh edges: vertex, distance in m, weight in m.

        The weights of all pairs of vertices that a curve separates add up to about its length.
        For vertices that are spread evenly, with the two rings a disc of radius R, the products of
        the areas of two vertices, divided by their distance, add up to R² for each meter of the
        curve. So each product is divided by R², the disc as large as ``_RINGS`` vertices.
        """
        if vertex not in self._known:
            count = len(self.areas)
            others: Index = self._keys[self._first[vertex] : self._first[vertex + 1]] % count
            place = self.surface.vertices[vertex]
            far = np.linalg.norm(self.surface.vertices[others] - place, axis=1)
            squared = _RINGS * (self.areas[others] + self.areas[vertex]) / 2 / np.pi
            product = self.areas[others] * self.areas[vertex]
            # Where triangles are flat to a line there is no area, and perhaps no distance.
            weight: Array = np.divide(product, far * squared, where=product * far > 0, out=0 * far)
            rows = zip(others.tolist(), far.tolist(), weight.tolist(), strict=True)
            self._known[vertex] = list(rows)
        return self._known[vertex]


def _two_steps(edges: Index, count: int) -> Index:
    """All pairs (a, b) within two mesh edges as ascending numbers a * count + b."""
    start, end = np.concatenate([edges, edges[:, ::-1]]).T
    order = np.argsort(start, kind="stable")
    start, end = start[order], end[order]
    degree = np.bincount(start, minlength=count)
    first = np.cumsum(degree) - degree
    # Behind each directed edge (a, b) all edges (b, c).
    before, place = numbered(degree[end])
    behind = end[first[end][before] + place]
    from_a = start[before]
    distinct = from_a != behind
    keys = np.concatenate([start * count + end, from_a[distinct] * count + behind[distinct]])
    keys.sort()
    return keys[np.diff(keys, prepend=-1) > 0]
