"""Solutions without names, brought into sheets that do the work of branches.

A sheet has at most one solution of each vertex, and what is linked along mesh edges is in one
sheet. So a sheet means the same at neighboring vertices, as a named branch does, and all that comes
after takes it for one. Colors, the components of linked solutions, are the same either way: a sheet
is filled with components that are not next to each other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cellcolor.arrays import Array, Index, Mask
from cellcolor.errors import InputError
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.reach.continuity import stays_in_limits
from cellcolor.frontend.reach.smooth import Measure, joint_step, shorter_way
from cellcolor.frontend.reach.tracking import Solutions, Tracker, clearly_nearest

__all__ = ["MOST_SHEETS", "Sheets", "edges_at_once", "linked_pairs", "sheets_of"]

T = TypeVar("T", bound=np.generic)

MOST_SHEETS = 60
"""A set of branches has to fit into one integer where slivers are cleaned."""

MEMORY = 64_000_000
"""Bytes that comparing all solutions of both ends of mesh edges may take at a time, at most."""


def edges_at_once(slots: int, joints: int) -> int:
    """How many edges :func:`linked_pairs` compares within ``MEMORY``, if there are so many slots.

    The numbers of a pair are an upper bound, held against tracemalloc in the tests.
    """
    pair = 8 * (4 * joints + 8)
    return max(1, MEMORY // max(1, slots * slots * pair))


@dataclass(frozen=True)
class Sheets:
    """Which solution of a vertex each sheet has.

    Attributes:
        slot: (n, sheets) the index of the solution among those of the vertex, -1 for none.
        linked: (k, sheets) along which mesh edges the sheet is continuous.
    """

    slot: Index
    linked: Mask

    @property
    def names(self) -> tuple[str, ...]:
        """Of the sheets; the first one has the largest component."""
        return tuple(f"sheet-{k}" for k in range(1, self.slot.shape[1] + 1))

    def arranged(self, values: NDArray[T], missing: float) -> NDArray[T]:
        """Values (n, slots, ...) of solutions, by sheets (n, sheets, ...)."""
        rows = np.arange(len(self.slot))[:, None]
        arranged = values[rows, self.slot]
        arranged[self.slot < 0] = missing
        return arranged


def linked_pairs(
    surface: Surface,
    edges: Index,
    nodes: Mask,
    solutions: Solutions,
    tracker: Tracker,
    measure: Measure,
    limits: tuple[Array, Array] | None,
) -> Index:
    """The pairs of solutions that a continuous motion along a mesh edge joins.

    Args:
        edges: (k, 2) vertex indices.
        nodes: (n, s) which solutions are valid.
        solutions: (n, s) of all vertices.
        limits: lower and upper (joints,) of the joints in rad, which the motions have to keep.

    Returns:
        (l, 3) rows of ``edges``, and the indices of the solutions at both ends.
    """
    i, j = edges.T
    step = joint_step(solutions.joints[i][:, :, None], solutions.joints[j][:, None])
    same = (
        np.sign(solutions.determinants[i])[:, :, None]
        == np.sign(solutions.determinants[j])[:, None]
    )
    both = nodes[i][:, :, None] & nodes[j][:, None] & same
    whole = np.zeros(len(edges))
    lengths, turns = surface.lengths(edges), surface.turns(edges)
    change = measure.changes(lengths, turns, whole, whole + 1)[:, None, None]
    size = np.abs(solutions.determinants)
    nearest = np.fmin(size[i][:, :, None], size[j][:, None])
    at_once = both & clearly_nearest(
        step, solutions.apart[i][:, :, None], solutions.apart[j][:, None]
    )
    at_once &= measure.settled(step, change, nearest)
    found = np.argwhere(at_once)
    start = solutions.joints[i[found[:, 0]], found[:, 1]]
    moved = shorter_way(start, solutions.joints[j[found[:, 0]], found[:, 2]])
    keeps = _keeps(limits, start, np.minimum(moved, 0.0), np.maximum(moved, 0.0))
    # What is left over at both ends is followed, from either.
    left = nodes[i] & ~at_once.any(axis=2), nodes[j] & ~at_once.any(axis=1)
    wanted = (both & left[0][:, :, None] & left[1][:, None]).any(axis=2)
    back = (both & left[0][:, :, None] & left[1][:, None]).any(axis=1)
    onwards = _walked(surface, edges, wanted, solutions, tracker, limits)
    backwards = _walked(surface, edges[:, ::-1], back, solutions, tracker, limits)
    there = {(int(row), int(b), int(a)) for row, a, b in backwards}
    both_ways = [link for link in onwards.tolist() if tuple(link) in there]
    return np.concatenate([found[keeps], np.array(both_ways, dtype=np.int64).reshape(-1, 3)])


def _walked(
    surface: Surface,
    edges: Index,
    wanted: Mask,
    solutions: Solutions,
    tracker: Tracker,
    limits: tuple[Array, Array] | None,
) -> Index:
    """Rows of edges and solutions at both ends (l, 3), followed from some at the first (k, s)."""
    row, slot = np.nonzero(wanted)
    first, second = edges[row].T
    start = solutions.take(first, slot)
    ends, motions = tracker.walk(surface, edges[row], start, np.ones(len(row)))
    smooth = motions.smooth & _keeps(limits, start.joints, motions.lowest, motions.highest)
    row, slot, ends, second = row[smooth], slot[smooth], ends[smooth], second[smooth]
    off = joint_step(solutions.joints[second], ends[:, None])
    off = np.where(np.isnan(off), np.inf, off)
    arrived = np.argmin(off, axis=1)
    return np.column_stack([row, slot, arrived])


def _keeps(limits: tuple[Array, Array] | None, start: Array, low: Array, high: Array) -> Mask:
    if limits is None:
        return np.ones(len(start), dtype=bool)
    return stays_in_limits(*limits, start, low, high)


def sheets_of(
    surface: Surface, edges: Index, pairs: Index, nodes: Mask, solutions: Solutions
) -> Sheets:
    """Sheets of all solutions, the valid ones by their links.

    Args:
        edges: (k, 2) all mesh edges.
        pairs: (l, 3), see :func:`linked_pairs`.
        nodes: (n, s) which solutions are valid.

    Raises:
        InputError: linked solutions are two of one vertex; names the vertex and both.
    """
    count, slots = nodes.shape
    here, there = (edges[pairs[:, 0], end] * slots + pairs[:, 1 + end] for end in (0, 1))
    graph = coo_array((np.ones(len(pairs)), (here, there)), shape=(nodes.size,) * 2)
    component = connected_components(graph, directed=False)[1]
    present = np.flatnonzero(nodes)
    _check_injective(surface, present, component[present], slots, solutions.joints)
    neighbors = coo_array(
        (np.ones(2 * len(edges)), np.concatenate([edges, edges[:, ::-1]]).T), shape=(count, count)
    ).tocsr()
    slot = np.full((count, 0), -1, dtype=np.int64)
    taken = np.zeros((count, 0), dtype=bool)
    for members in _by_size(present, component[present]):
        vertices = members // slots
        free = np.flatnonzero(~taken[vertices].any(axis=0))
        if not len(free):
            slot = np.column_stack([slot, np.full(count, -1)])
            taken = np.column_stack([taken, np.zeros(count, dtype=bool)])
            free = np.array([slot.shape[1] - 1])
        slot[vertices, free[0]] = members % slots
        # Sheets are not to have two components next to each other: their borders would be lost.
        taken[vertices, free[0]] = taken[neighbors[vertices].indices, free[0]] = True
    slot = _with_the_rest(slot, ~nodes & ~np.isnan(solutions.determinants))
    if slot.shape[1] > MOST_SHEETS:
        message = f"its solutions fall into {slot.shape[1]} sheets, at most {MOST_SHEETS} fit"
        raise InputError(None, "robot.kinematics", message)
    linked = np.zeros((len(edges), slot.shape[1]), dtype=bool)
    row, sheet = np.nonzero(slot[edges[pairs[:, 0], 0]] == pairs[:, 1][:, None])
    linked[pairs[row, 0], sheet] = True
    return Sheets(slot, linked)


def _by_size(present: Index, component: Index) -> list[Index]:
    """The members of each component, largest first, of equal ones that with the first member."""
    order = np.argsort(component, kind="stable")
    _, first, count = np.unique(component[order], return_index=True, return_counts=True)
    members = np.split(present[order], first[1:]) if len(first) else []
    return [members[k] for k in np.lexsort((present[order][first], -count))]


def _with_the_rest(slot: Index, rest: Mask) -> Index:
    """The sheets (n, sheets) with solutions that are not valid in places that are free."""
    count = int(((slot >= 0).sum(axis=1) + rest.sum(axis=1)).max(initial=1))
    missing = max(count - slot.shape[1], 0)
    filled = np.column_stack([slot, np.full((len(slot), missing), -1)])
    vertex, solution = np.nonzero(rest)
    number = np.arange(len(vertex)) - np.searchsorted(vertex, vertex)
    free = np.argsort(filled >= 0, axis=1, kind="stable")  # free places first
    filled[vertex, free[vertex, number]] = solution
    return filled


def _check_injective(
    surface: Surface, present: Index, component: Index, slots: int, joints: Array
) -> None:
    keys = np.column_stack([present // slots, component])
    _, first, inverse, count = np.unique(
        keys, axis=0, return_index=True, return_inverse=True, return_counts=True
    )
    twice = np.flatnonzero(count > 1)
    if not len(twice):
        return
    key = twice[np.argmin(first[twice])]
    vertex = int(present[first[key]]) // slots
    found = joints[vertex, present[inverse.ravel() == key] % slots].round(4).tolist()
    place = ", ".join(f"{coordinate:.4f}" for coordinate in surface.vertices[vertex])
    raise InputError(
        None,
        f"vertices[{vertex}]",
        f"at ({place}) m one color has {len(found)} configurations, "
        + " and ".join(map(str, found))
        + " rad: on this part the arm gets from one to the other without a singularity (it is "
        "cuspidal), and colors would not cover each point once; a smaller part, another placement "
        "or narrower joint limits can keep them apart",
    )
