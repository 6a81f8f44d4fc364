"""From valid configurations to colors and cracks (``docs/frontend.md``, "Continuity").

A node is a valid configuration: a vertex and a branch. Two nodes on the ends of a mesh edge are
linked when a continuous motion leads from one to the other: same branch, and no joint moves
farther than the length allows, which is checked between the ends and, where that leaves a doubt,
between points on the way. Colors are the connected components of linked nodes; a mesh edge whose
ends have a color in common but are not linked in it is a crack of that color.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cellcolor.data.surface import Crack
from cellcolor.errors import InputError
from cellcolor.frontend.between import along_edges
from cellcolor.frontend.collision import Mask
from cellcolor.frontend.robot import Array
from cellcolor.frontend.scene import Continuity
from cellcolor.frontend.surfaces import Surface
from cellcolor.frontend.validity import Candidates

__all__ = [
    "Coloring",
    "color",
    "find_cracks",
    "joint_step",
    "link",
    "node_links",
    "stays_in_limits",
]

_ROUNDING = 1e-9  # rad; an angle on its limit is inside
_PROBES_AT_ONCE = 20_000  # a matter of memory: some kilobytes each

Index = NDArray[np.int64]
Probe = Callable[[Array, Array, NDArray[np.intp]], tuple[Array, Mask]]
"""Points (k, 3), unit tool directions (k, 3) and branches (k,) to configurations (k, 6) in rad,
NaN where there is none, and whether they are well conditioned (k,)."""


@dataclass(frozen=True)
class Coloring:
    """Colors of all nodes.

    Attributes:
        names: of the colors: the branch, with a number where it has several components.
        branch: of each color.
        node_color: (n, branches) the color of each valid configuration, -1 for others.
    """

    names: tuple[str, ...]
    branch: tuple[int, ...]
    node_color: Index


def joint_step(first: Array, second: Array) -> Array:
    """The largest movement of a joint between configurations (..., 6), modulo 2 pi, in rad."""
    difference = np.abs(np.remainder(second - first + np.pi, 2 * np.pi) - np.pi)
    return np.asarray(difference.max(axis=-1))


def stays_in_limits(lower: Array, upper: Array, first: Array, second: Array) -> Mask:
    """Whether the shorter way between configurations (..., 6) fits into the joint limits (6,).

    Both ends may be turned by full circles, together: with limits of -3 and 3 rad there is no
    short way from 2.9 to -2.9, with limits of -3 and 4 rad there is one, from 2.9 to 3.38.
    """
    circle = 2 * np.pi
    step = np.remainder(second - first + np.pi, circle) - np.pi
    lowest, highest = np.minimum(first, first + step), np.maximum(first, first + step)
    turns = np.ceil((lower - lowest) / circle - _ROUNDING)
    return np.asarray((highest + circle * turns <= upper + _ROUNDING).all(axis=-1))


def link(
    surface: Surface,
    edges: Index,
    candidates: Candidates,
    policy: Continuity,
    near_singular: float,
    probe: Probe,
) -> Mask:
    """Whether the two configurations of a branch on an edge's ends are continuous, (k, 8).

    False where one of the ends has no valid configuration of that branch. Where no joint moves
    farther than half the bound for the edge's length, and neither end is near a singularity, that
    settles it. All other edges are probed: every point on the way needs a well-conditioned
    configuration of the branch, and each step between them has to keep to the bound for its own
    length. So fast motions beside a singularity count, and jumps through one do not, whatever
    the size of the mesh's triangles.

    Args:
        edges: (k, 2) vertex indices.
        near_singular: task determinant from which on down an edge is probed, m^3.
        probe: see :data:`Probe`; called with points in between.
    """
    i, j = edges.T
    both = candidates.valid[i] & candidates.valid[j]
    length = surface.lengths(edges)
    bound = _bound(policy, length)[:, None]
    with np.errstate(invalid="ignore"):
        step = joint_step(candidates.configurations[i], candidates.configurations[j])
        nearest = np.fmin(candidates.determinants[i], candidates.determinants[j])
        clear = (step <= bound / 2) & (nearest >= near_singular)
    linked: Mask = both & clear
    rows, branches = np.nonzero(both & ~clear)
    pieces = np.maximum(np.ceil(length[rows] / policy.probe_spacing_m).astype(int), 2)
    for count in np.unique(pieces):
        alike = np.flatnonzero(pieces == count)
        size = max(1, _PROBES_AT_ONCE // int(count))
        for some in (alike[k : k + size] for k in range(0, len(alike), size)):
            linked[rows[some], branches[some]] = _probed(
                surface, edges[rows[some]], branches[some], int(count), candidates, policy, probe
            )
    return linked


def _bound(policy: Continuity, length: Array) -> Array:
    """How far a joint may move along lengths in m, in rad."""
    return policy.base_step_rad + policy.step_per_length_rad_per_m * length


def _probed(
    surface: Surface,
    edges: Index,
    branches: NDArray[np.intp],
    pieces: int,
    candidates: Candidates,
    policy: Continuity,
    probe: Probe,
) -> Mask:
    """Follow a branch along each edge: straight, the normal turning with it."""
    i, j = edges.T
    way = np.tile(np.linspace(0.0, 1.0, pieces + 1)[1:-1], len(edges))
    points, directions = along_edges(surface, np.repeat(edges, pieces - 1, axis=0), way)
    between, conditioned = probe(points, directions, np.repeat(branches, pieces - 1))
    between = between.reshape(len(edges), pieces - 1, -1)
    conditioned = conditioned.reshape(len(edges), pieces - 1)
    start, end = (candidates.configurations[ends, branches] for ends in (i, j))
    path = np.concatenate([start[:, None], between, end[:, None]], axis=1)
    length = surface.lengths(edges)
    bound = _bound(policy, length / pieces)
    # A missing configuration is NaN, and a comparison with NaN is false.
    smooth = np.all(joint_step(path[:, :-1], path[:, 1:]) <= bound[:, None], axis=1)
    followed: Mask = smooth & np.all(conditioned, axis=1)
    return followed


def color(
    nodes: Mask, configurations: Array, links: Index, branch_names: tuple[str, ...]
) -> Coloring:
    """Connected components of linked nodes.

    Numbering is deterministic: colors follow their branches; within a branch the components
    with more vertices come first, and of equal ones that with the smallest vertex.

    Args:
        nodes: (n, branches) which of them there are.
        configurations: (n, branches, 6) in rad, for errors.
        links: (l, 2) nodes that a continuous motion joins, numbered vertex * branches + branch.

    Raises:
        InputError: a color has two configurations on one vertex; names vertex and
            configurations.
    """
    branches = nodes.shape[1]
    graph = coo_array((np.ones(len(links)), (links[:, 0], links[:, 1])), shape=(nodes.size,) * 2)
    component = connected_components(graph, directed=False)[1]
    present = np.flatnonzero(nodes)
    _, first, inverse, count = np.unique(
        component[present], return_index=True, return_inverse=True, return_counts=True
    )
    branch_of = present[first] % branches
    order = np.lexsort((first, -count, branch_of))
    node_color = np.full(nodes.size, -1, dtype=np.int64)
    node_color[present] = np.argsort(order)[inverse]
    of_branch = branch_of[order]
    names = []
    for branch, size in enumerate(np.bincount(of_branch, minlength=branches)):
        name = branch_names[branch]
        names += [name] if size == 1 else [f"{name} {k}" for k in range(1, size + 1)]
    table = node_color.reshape(nodes.shape)
    _check_injective(table, configurations, names)
    return Coloring(tuple(names), tuple(of_branch.tolist()), table)


def _check_injective(node_color: Index, configurations: Array, names: list[str]) -> None:
    ordered = np.sort(node_color, axis=1)
    twice = (ordered[:, 1:] == ordered[:, :-1]) & (ordered[:, 1:] >= 0)
    if not twice.any():
        return
    vertex = int(np.argmax(twice.any(axis=1)))
    shared = ordered[vertex, 1:][twice[vertex]][0]
    joints = configurations[vertex][node_color[vertex] == shared].round(4).tolist()
    raise InputError(
        None,
        f"vertices[{vertex}]",
        f"color {names[shared]!r} covers it with {len(joints)} configurations: "
        + " and ".join(map(str, joints)),
    )


def node_links(edges: Index, linked: Mask) -> Index:
    """The pairs of nodes (l, 2) that :func:`link` found continuous."""
    rows, branch = np.nonzero(linked)
    links: Index = edges[rows] * linked.shape[1] + branch[:, None]
    return links


def find_cracks(edges: Index, linked: Mask, coloring: Coloring) -> tuple[Crack, ...]:
    """The mesh edges whose ends share a color that is not continuous along the edge itself."""
    start, end = coloring.node_color[edges[:, 0]], coloring.node_color[edges[:, 1]]
    torn = (start == end) & (start >= 0) & ~linked
    return tuple(
        Crack(int(edges[row, 0]), int(edges[row, 1]), tuple(sorted(start[row, torn[row]].tolist())))
        for row in np.flatnonzero(torn.any(axis=1))
    )
