"""Colors: the components of configurations that belong together."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.mesh.triangle_mesh import grouped
from cellcolor.union_find import UnionFind


def components_of(there: Mask, edges: Index, pairs: Index) -> Index:
    """The number (n, s) of each configuration's component, largest first, of equal ones that with
    the first member; -1 where there is none.

    Args:
        there: (n, s) which configurations there are.
        edges: (k, 2) the mesh edges.
        pairs: (l, 3) matches, see :meth:`~cellcolor.configurations.matching.Matching.along`.
    """
    component = grouped(there.size, _ends(there, edges, pairs))
    present = np.flatnonzero(there)
    _, first, inverse, size = np.unique(
        component[present], return_index=True, return_inverse=True, return_counts=True
    )
    rank = np.argsort(np.lexsort((first, -size)))
    color = np.full(there.size, -1, dtype=np.int64)
    color[present] = rank[inverse]
    return color.reshape(there.shape)


def twice(color: Index) -> Index:
    """Vertices that a component has more than once, with the component, (k, 2)."""
    vertex, slot = np.nonzero(color >= 0)
    found, count = np.unique(
        np.column_stack([vertex, color[vertex, slot]]), axis=0, return_counts=True
    )
    return np.asarray(found[count > 1])


def cut_apart(there: Mask, edges: Index, pairs: Index, strength: Array) -> Index:
    """The matches that are left if those are cut that join two configurations of a vertex.

    Only components that have a vertex twice lose any; the strongest matches come first.

    Args:
        strength: (l,) of each match; the others as for :func:`components_of`.
    """
    color = components_of(there, edges, pairs)
    bad = np.isin(color[edges[pairs[:, 0], 0], pairs[:, 1]], twice(color)[:, 1])
    kept = np.ones(len(pairs), dtype=bool)
    kept[bad] = _forest(_ends(there, edges, pairs[bad]), strength[bad], there.shape[1])
    return np.asarray(pairs[kept])


def _ends(there: Mask, edges: Index, pairs: Index) -> Index:
    """Both configurations of matches (l, 2), numbered vertex * s + slot."""
    row, a, b = pairs.T
    return np.asarray(edges[row] * there.shape[1] + np.column_stack([a, b]))


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
