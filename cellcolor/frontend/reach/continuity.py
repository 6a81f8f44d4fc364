"""From valid configurations to colors and cracks (``docs/frontend.md``, "Continuity").

A node is a valid configuration: a vertex and a branch. Two nodes on the ends of a mesh edge are
linked when a continuous motion of their branch leads from one to the other
(:mod:`cellcolor.frontend.reach.smooth`) and fits into the joint limits. Colors are the connected
components of linked nodes; a mesh edge whose ends have a color in common but are not linked in it
is a crack of that color.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.configurations.components import components_of
from cellcolor.configurations.matching import stays_within
from cellcolor.data.surface import Crack
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.reach.smooth import Measure, Probe, follow_edges
from cellcolor.frontend.reach.validity_tests import Verdicts


@dataclass(frozen=True, eq=False)
class Coloring:
    """Colors of all nodes.

    Attributes:
        names: of the colors: the branch, with a number where it has several components.
        branch: of each color.
        node_color: (n, branches) the color of each valid configuration, -1 for others.
        linked: (edges, branches) along which mesh edges each branch leads.
        cracks: the mesh edges whose ends share a color that is not continuous along the edge.
    """

    names: tuple[str, ...]
    branch: tuple[int, ...]
    node_color: Index
    linked: Mask
    cracks: tuple[Crack, ...]


def link(
    surface: Surface,
    edges: Index,
    verdicts: Verdicts,
    measure: Measure,
    limits: tuple[Array, Array] | None,
    probe: Probe,
) -> Mask:
    """Whether the two configurations of a branch on an edge's ends are continuous, (k, branches).

    False where one of the ends has no valid configuration of that branch. Otherwise the branch
    is followed along the edge, see :mod:`cellcolor.frontend.reach.smooth`.

    Args:
        edges: (k, 2) vertex indices.
        limits: lower and upper (joints,) of the joints in rad, or in m, which the motion has to
            keep.
        probe: see :data:`~cellcolor.frontend.reach.smooth.Probe`; called with points in between.
    """
    i, j = edges.T
    linked: Mask = verdicts.valid[i] & verdicts.valid[j]
    rows, branches = np.nonzero(linked)
    start, end = (verdicts.configurations[side[rows], branches] for side in (i, j))
    at_start, at_end = (verdicts.determinants[side[rows], branches] for side in (i, j))
    ends, determinants = (start, end), (at_start, at_end)
    motions = follow_edges(surface, edges[rows], branches, ends, determinants, measure, probe)
    smooth = motions.smooth
    if limits is not None:
        moved = motions.lowest, motions.highest
        smooth = smooth & stays_within(limits, start, *moved, measure.periods)
    linked[rows, branches] = smooth
    return linked


def color_nodes(nodes: Mask, edges: Index, linked: Mask, branch_names: tuple[str, ...]) -> Coloring:
    """Connected components of linked nodes.

    Numbering is deterministic: colors follow their branches; within a branch the components
    with more vertices come first, and of equal ones that with the smallest vertex.

    Args:
        nodes: (n, branches) which of them there are.
        edges: (k, 2) all mesh edges.
        linked: (k, branches), see :func:`link`; False where an end is no node.
    """
    component = regions(nodes, edges, linked)
    of_branch = np.zeros(component.max(initial=-1) + 1, dtype=np.int64)
    of_branch[component[nodes]] = np.nonzero(nodes)[1]
    order = np.argsort(of_branch, kind="stable")
    node_color = np.full(nodes.shape, -1, dtype=np.int64)
    node_color[nodes] = np.argsort(order)[component[nodes]]
    names = []
    sizes = np.bincount(of_branch, minlength=len(branch_names)).tolist()
    for name, size in zip(branch_names, sizes, strict=True):
        names += [name] if size == 1 else [f"{name} {k}" for k in range(1, size + 1)]
    branch = tuple(of_branch[order].tolist())
    return Coloring(tuple(names), branch, node_color, linked, _cracks(edges, linked, node_color))


def regions(nodes: Mask, edges: Index, linked: Mask) -> Index:
    """The number of each node's component, (n, branches), largest first; -1 for no node."""
    row, branch = np.nonzero(linked)
    return components_of(nodes, edges, np.column_stack([row, branch, branch]))


def _cracks(edges: Index, linked: Mask, node_color: Index) -> tuple[Crack, ...]:
    start, end = node_color[edges[:, 0]], node_color[edges[:, 1]]
    torn = (start == end) & (start >= 0) & ~linked
    return tuple(
        Crack(int(edges[row, 0]), int(edges[row, 1]), tuple(sorted(start[row, torn[row]].tolist())))
        for row in np.flatnonzero(torn.any(axis=1))
    )
