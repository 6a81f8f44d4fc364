"""Colors: the components of configurations that belong together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.errors import InputError
from cellcolor.mesh.triangle_mesh import grouped
from cellcolor.union_find import UnionFind

MANY = 5
"""Vertices that an error names."""


@dataclass(frozen=True, slots=True)
class Components:
    """The colors of configurations.

    Attributes:
        color: (n, s) the color of each configuration, largest first; -1 where there is none.
        count: how many colors there are.
        cut: (c,) the rows of matches that were cut, so that no color has a vertex twice.
    """

    color: Index
    count: int
    cut: Index


def components_of(
    there: Mask, edges: Index, pairs: Index, strength: Array, *, cut: bool
) -> Components:
    """The components of matched configurations; no color has two configurations of one vertex.

    Args:
        there: (n, s) which configurations there are.
        edges: (k, 2) the mesh edges.
        pairs: (l, 3) matches, see :class:`~cellcolor.configurations.matching.Matches`.
        strength: (l,) of each match.
        cut: whether a component that has two configurations of a vertex is cut where matches are
            weakest; otherwise it is refused.

    Raises:
        InputError: a component has two configurations of one vertex, and it is not to be cut.
    """
    slots = there.shape[1]
    row, a, b = pairs.T
    ends = np.column_stack([edges[row, 0] * slots + a, edges[row, 1] * slots + b])
    kept = np.ones(len(pairs), dtype=bool)
    component = grouped(there.size, ends)
    twice = _twice(component, there)
    if len(twice) and not cut:
        raise InputError(
            None,
            f"configurations[{twice[0][0]}]",
            _refusal(twice),
        )
    if len(twice):
        bad = np.isin(component[ends[:, 0]], [number for _, number in twice])
        kept[bad] = _forest(ends[bad], strength[bad], slots)
        component = grouped(there.size, ends[kept])
    present = np.flatnonzero(there)
    number, first, inverse, size = np.unique(
        component[present], return_index=True, return_inverse=True, return_counts=True
    )
    rank = np.empty(len(number), dtype=np.int64)
    rank[np.lexsort((first, -size))] = np.arange(len(number))
    color = np.full(there.size, -1, dtype=np.int64)
    color[present] = rank[inverse]
    return Components(color.reshape(there.shape), len(number), np.flatnonzero(~kept))


def _twice(component: Index, there: Mask) -> list[tuple[int, int]]:
    """Vertices that a component has more than once, with the component."""
    present = np.flatnonzero(there)
    keys = np.column_stack([present // there.shape[1], component[present]])
    found, count = np.unique(keys, axis=0, return_counts=True)
    return [(int(vertex), int(number)) for vertex, number in found[count > 1]]


def _refusal(twice: list[tuple[int, int]]) -> str:
    vertices = sorted({vertex for vertex, _ in twice})
    named = ", ".join(map(str, vertices[:MANY])) + (", …" if len(vertices) > MANY else "")
    return (
        f"one color has two configurations of a vertex (vertices {named}): matches lead from one "
        "to the other around a way of mesh edges; mesh finer, or say what is linked and lower "
        "max_step, so that you are asked, or have the weakest cut (conflicts='cut')"
    )


def _forest(ends: Index, strength: Array, slots: int) -> Mask:
    """Which links are kept if the strongest come first, and none may join a vertex to itself."""
    nodes: UnionFind[int] = UnionFind()
    vertices: dict[int, set[int]] = {}
    kept = np.zeros(len(ends), dtype=bool)
    for place in np.argsort(-strength, kind="stable"):
        one, other = (nodes[int(node)] for node in ends[place])
        if one == other:
            kept[place] = True
            continue
        own = vertices.pop(one, None) or {one // slots}
        its = vertices.pop(other, None) or {other // slots}
        if not own.isdisjoint(its):
            vertices[one], vertices[other] = own, its
            continue
        if len(own) < len(its):
            own, its = its, own
        own |= its
        nodes.union(one, other)
        vertices[nodes[one]] = own
        kept[place] = True
    return kept
