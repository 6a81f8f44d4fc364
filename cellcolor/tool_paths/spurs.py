"""What a pattern has left uncovered, reached by bends of the path and by spurs.

A **bend** leads the path a little aside, toward such a place, and on. Where a bend is not enough,
would uncover another place or has no room near an end of the walk, a **spur** leads there and back.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain

import numpy as np
from scipy.sparse import csr_matrix

from cellcolor.arrays import Array
from cellcolor.deadline import Deadline
from cellcolor.mesh.triangle_mesh import grouped
from cellcolor.tool_paths.distances import off_border, ways_from
from cellcolor.tool_paths.interface import Laid
from cellcolor.tool_paths.triangles import Triangles

_FAR = 0.75  # spacings: what is farther from the path has to be reached
_STOP = 0.5  # spacings: a spur ends so far before what it reaches
_SMALL = 0.1  # spacings squared: smaller places are left as they are, unless they are far away
_VERY_FAR = 1.25  # spacings
_ROUNDS = 12
_BENDING = 4  # of these rounds, in which bends are tried
_HALF = 1.5  # spacings: so much of the walk a bend replaces to each side
_NEAR = 0.6  # spacings: so near a bend comes to what it reaches
_LONGEST = 12.0  # spacings: a way round to where a bend begins is no longer, weighted


@dataclass(frozen=True)
class _Bend:
    """A piece of a walk and the row of vertices to take its place.

    ``first`` and ``last`` are places in the walk, both replaced; the row has the same vertices at
    its ends.
    """

    first: int
    last: int
    row: list[int]


def with_spurs(laid: Laid, spacing: float, deadline: Deadline) -> Laid:
    """The same path with bends and spurs to all that is too far from it.

    Where the pattern found no room for a path there is one along the part, and spurs from it.
    """
    mesh = laid.mesh
    weights = off_border(mesh, spacing / 2)
    graph = mesh.graph(weights)
    walk = laid.walk if len(laid.walk) > 1 else _along(mesh, weights, spacing)
    for number in range(_ROUNDS):
        deadline.check()
        distances = mesh.distances_from(np.unique(walk))
        targets = _targets(mesh, distances, spacing)
        if not targets:
            break
        nearest = ways_from(graph, np.unique(walk))
        ways = [nearest.back_from(target) for target, _ in targets]
        bends, waiting = dict[int, _Bend](), set[int]()
        if number < _BENDING:
            bends, waiting = _bends(mesh, graph, walk, ways, spacing, deadline)
            bends = _harmless(mesh, walk, distances, bends, spacing)
        spurs = dict[int, list[int]]()
        for place, (way, (_, far)) in enumerate(zip(ways, targets, strict=True)):
            if place not in bends and place not in waiting:
                spur = way[_short_of(mesh, way, min(_STOP * spacing, far / 2)) :]
                spurs.setdefault(spur[-1], []).extend([*spur[-2::-1], *spur[1:]])
        walk = _with(walk, bends.values(), spurs)
    return Laid(mesh, walk)


def _short_of(mesh: Triangles, way: list[int], length: float) -> int:
    """The place on a way that is so far from its beginning, but not its last one."""
    return min(int(np.searchsorted(_lengths_along(mesh, way)[1:], length)), len(way) - 2)


def _lengths_along(mesh: Triangles, way: list[int]) -> Array:
    """How far each vertex of a way is from its beginning, m."""
    steps = np.linalg.norm(np.diff(mesh.points[way], axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _bends(
    mesh: Triangles,
    graph: csr_matrix,
    walk: list[int],
    ways: list[list[int]],
    spacing: float,
    deadline: Deadline,
) -> tuple[dict[int, _Bend], set[int]]:
    """Bends of a walk toward where ways begin that end on it.

    Near the ends of the walk there is no room for a bend.

    Returns:
        Bends that replace a piece each, by the numbers of the ways, and the numbers of ways whose
        pieces overlap theirs.
    """
    along = _lengths_along(mesh, walk)
    bases = np.array([along[walk.index(way[-1])] for way in ways])
    firsts = np.searchsorted(along, bases - _HALF * spacing)
    lasts = np.searchsorted(along, bases + _HALF * spacing)
    found, waiting, free = dict[int, _Bend](), set[int](), 1
    for number in np.argsort(firsts, kind="stable").tolist():
        deadline.check()
        first, last, way = int(firsts[number]), int(lasts[number]), ways[number]
        if first < 1 or last == len(walk):
            continue
        if first < free:
            waiting.add(number)
            continue
        tip = way[_short_of(mesh, way, _NEAR * spacing)]
        round_tip = ways_from(graph, np.array([tip]), _LONGEST * spacing)
        there, on = round_tip.back_from(walk[first]), round_tip.back_from(walk[last])
        if there[-1] == on[-1] == tip:
            found[number] = _Bend(first, last, [*there, *on[-2::-1]])
            free = last + 1
    return found, waiting


def _harmless(
    mesh: Triangles, walk: list[int], distances: Array, bends: dict[int, _Bend], spacing: float
) -> dict[int, _Bend]:
    """The bends without those that would uncover a place that is covered now."""
    if not bends:
        return bends
    after = mesh.distances_from(np.unique(_with(walk, bends.values(), {})))
    after[distances > _FAR * spacing] = 0.0  # not covered now either
    pieces = [walk[bend.first : bend.last + 1] for bend in bends.values()]
    number = np.repeat(list(bends), [len(piece) for piece in pieces])
    left = mesh.points[list(chain(*pieces))]
    blamed = {
        int(number[np.linalg.norm(left - mesh.points[vertex], axis=1).argmin()])
        for vertex, _ in _targets(mesh, after, spacing)
    }
    return {number: bend for number, bend in bends.items() if number not in blamed}


def _with(walk: list[int], bends: Iterable[_Bend], spurs: dict[int, list[int]]) -> list[int]:
    """A walk with bends, and with spurs from vertices, each where the walk first comes there."""
    pieces, at = list[list[int]](), 0
    for bend in sorted(bends, key=lambda bend: bend.first):
        pieces += [walk[at : bend.first], bend.row]
        at = bend.last + 1
    longer: list[int] = []
    for vertex in chain(*pieces, walk[at:]):
        longer.append(vertex)
        longer += spurs.pop(vertex, [])
    return longer


def _targets(mesh: Triangles, distances: Array, spacing: float) -> list[tuple[int, float]]:
    """The farthest vertex of every place that has to be reached, and how far it is."""
    far = distances > _FAR * spacing
    if not far.any():
        return []
    place = grouped(len(far), mesh.edges[far[mesh.edges].all(axis=1)])
    found = []
    vertices = np.flatnonzero(far)
    for number in np.unique(place[vertices]):
        members = vertices[place[vertices] == number]
        farthest = int(members[distances[members].argmax()])
        area = float(mesh.vertex_areas[members].sum())
        if area > _SMALL * spacing**2 or distances[farthest] > _VERY_FAR * spacing:
            found.append((farthest, float(distances[farthest])))
    return found


def _along(mesh: Triangles, weights: Array, spacing: float) -> list[int]:
    """A way from one end of a part to the other, its ends half a spacing short."""
    graph = mesh.graph(weights)
    one = int(ways_from(graph, np.array([0])).lengths.argmax())
    ways = ways_from(graph, np.array([one]))
    way = ways.back_from(int(ways.lengths.argmax()))
    lengths = _lengths_along(mesh, way)
    off = min(spacing / 2, lengths[-1] / 4)
    inner = [v for v, at in zip(way, lengths, strict=True) if off <= at <= lengths[-1] - off]
    return inner if len(inner) > 1 else way[: max(2, len(way) // 2 + 1)]
