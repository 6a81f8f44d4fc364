"""The pattern ``spiral``: the lines of ``contour``, each led over into the next one inside."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.sparse import csr_matrix

from cellcolor.arrays import Array, Index
from cellcolor.deadline import Deadline
from cellcolor.tool_paths.contour import lay_contours
from cellcolor.tool_paths.distances import off_border, ways_from
from cellcolor.tool_paths.interface import Laid
from cellcolor.tool_paths.joined_loops import (
    Door,
    Loop,
    Part,
    by_loop,
    doors_between,
    is_free,
    join_loops,
    walked,
)
from cellcolor.tool_paths.triangles import Triangles

_OVER = 5.0  # spacings along a loop on which the path leads over into the next, at most
_SHARE = 0.25  # of the shorter loop, at most, for the same
_NEXT = 6.0  # spacings to the next loop, weighted, at most
_LONGEST = 30.0  # times its intended length, weighted, a way over is at most
_STRAY = 20.0  # times longer counts what is a whole spacing off such a way
_BEGINNINGS = 24  # places of the innermost loop from which a spiral is tried


def lay_spiral(mesh: Triangles, spacing: float, deadline: Deadline) -> Laid:
    """Loops as in ``contour``, the longest chain of them joined into a spiral."""
    return lay_contours(mesh, spacing, deadline, wind)


def wind(mesh: Triangles, rows: list[Index], gap: float, deadline: Deadline) -> list[int]:
    """One path along all loops: a spiral along a longest chain inward, and doors to all others.

    The first loop and the last one are walked all round. Of each loop between a stretch is left
    out, and these stretches lie side by side: there the path leads at a slant from each loop to the
    next, so that these ways are as far apart as the loops. If no such stretches are found that no
    door needs, all loops are joined by doors.

    Args:
        mesh: on which the loops are rows of edges; connected.
        rows: the loops.
        gap: wanted distance between the two bridges of a door, m.
    """
    loops, doors = doors_between(mesh, rows, gap)
    if min(loop.length for loop in loops) <= 0:  # vertices may coincide
        return join_loops(mesh, rows, gap, deadline)
    chain = _inward(loops, doors)
    links = {frozenset(pair) for pair in pairwise(chain)}
    at = by_loop([door for door in doors if frozenset(door.loops) not in links])
    graph = mesh.graph(off_border(mesh, gap / 2))
    last = loops[chain[-1]]
    for share in np.arange(_BEGINNINGS) / _BEGINNINGS:
        deadline.check()
        innermost = last.moved(0, share * last.length)
        left = _left(mesh, graph, [loops[number] for number in chain], innermost, gap)
        parts = left and _spiral(
            mesh, loops, list(zip(chain, left, strict=True)), at, gap, deadline
        )
        if parts:
            return walked(loops, at, parts)
    return join_loops(mesh, rows, gap, deadline)


def _inward(loops: list[Loop], doors: list[Door]) -> list[int]:
    """A way along the tree of loops from the longest one to one with the most doors between."""
    before = {int(np.argmax([loop.length for loop in loops])): -1}
    order = list(before)
    at = by_loop(doors)
    for number in order:
        for door in at.get(number, []):
            other = sum(door.loops) - number
            if other not in before:
                before[other] = number
                order.append(other)
    way = [order[-1]]
    while before[way[-1]] >= 0:
        way.append(before[way[-1]])
    return way[::-1]


def _spiral(
    mesh: Triangles,
    loops: list[Loop],
    chain: list[tuple[int, tuple[int, bool]]],
    at: dict[int, list[Door]],
    gap: float,
    deadline: Deadline,
) -> list[Part | list[int]] | None:
    """The parts of a spiral along a chain of loops; None if a door is in the way.

    Args:
        chain: the loops by number, each with what :func:`_left` says of it.
    """
    rounds: list[tuple[int, int, int, bool, None]] = []
    ways: list[tuple[Loop, int, float, int]] = []
    enter = chain[0][1][0]
    for position, (number, (leave, forward)) in enumerate(chain):
        loop, inside = loops[number], position + 1 < len(chain)
        if not inside:
            leave = enter
        left_out = (leave, enter) if forward else (enter, leave)
        if not is_free(loop, number, left_out, at.get(number, [])):
            return None
        rounds.append((number, enter, leave, forward, None))
        if inside:
            following, (beside, onward) = chain[position + 1]
            inner = loops[following]
            along = min(_OVER * gap, _SHARE * min(loop.length, inner.length))
            enter = inner.moved(beside, along if onward else -along)
            ways.append((loop, leave, along if forward else -along, inner.row[enter]))
    parts: list[Part | list[int]] = [rounds[0]]
    for around, way_over in zip(rounds[1:], ways, strict=True):
        deadline.check()
        way = _over(mesh, *way_over, gap)
        if way is None:
            return None
        parts += [way, around]
    return parts


def _left(
    mesh: Triangles, graph: csr_matrix, loops: list[Loop], innermost: int, gap: float
) -> list[tuple[int, bool]] | None:
    """Where loops, each inside the one before, are left, side by side, and if walked forward.

    From the last one outward: every place of a short loop is near the long loop around it, while a
    place of the long loop may be far from the short one.
    """
    places = [innermost]
    for inner, outer in pairwise(reversed(loops)):
        ways = ways_from(graph, np.array([inner.row[places[-1]]]), _NEXT * gap)
        places.append(int(ways.lengths[outer.row].argmin()))
        if not np.isfinite(ways.lengths[outer.row[places[-1]]]):
            return None
    places.reverse()
    forward = [True]
    for one, other in pairwise(zip(loops, places, strict=True)):
        agree = np.dot(_direction(mesh, *one, gap), _direction(mesh, *other, gap)) > 0
        forward.append(forward[-1] == agree)
    return list(zip(places, forward, strict=True))


def _over(
    mesh: Triangles, loop: Loop, leave: int, along: float, onto: int, gap: float
) -> list[int] | None:
    """The vertices between a place of a loop and a vertex of the next, nearest to a slanting line.

    On that line the distance from the loop grows evenly with the way along it.

    Args:
        along: how far along the loop the line leads, m; backward if that is negative.
    """
    near = ways_from(mesh.graph(), np.array(loop.row), max(2 * abs(along), 3 * gap))
    reached = np.isfinite(near.lengths)
    if not reached[onto] or near.lengths[onto] <= 0:  # vertices may coincide
        return None
    place = np.zeros(len(mesh.points), dtype=np.int64)
    place[loop.row] = np.arange(len(loop.row))
    passed = loop.along[place[near.source[reached]]] - loop.along[leave]
    passed = (np.sign(along) * passed) % loop.length / abs(along)
    off = np.ones(len(mesh.points))
    off[reached] = np.abs(near.lengths[reached] / near.lengths[onto] - passed)
    weights = mesh.lengths * (1.0 + _STRAY * np.minimum(off, 1.0)[mesh.edges].mean(axis=1))
    ways = ways_from(
        mesh.graph(weights), np.array([loop.row[leave]]), _LONGEST * max(abs(along), gap)
    )
    way = ways.back_from(onto)
    return way[-2:0:-1] if way[-1] == loop.row[leave] else None


def _direction(mesh: Triangles, loop: Loop, place: int, gap: float) -> Array:
    """Where a loop leads at a place, forward."""
    far = min(gap, loop.length / 8)
    behind, ahead = (loop.row[loop.moved(place, way)] for way in (-far, far))
    return np.asarray(mesh.points[ahead] - mesh.points[behind])
