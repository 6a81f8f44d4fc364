"""Loops joined into one closed path: in over a bridge, round, and back beside the bridge.

Every loop is walked once. Which loops are joined is a shortest spanning tree; a **door** is where
two of them are joined: a piece of each is left out between two bridges. Where there is no room for
two bridges the door has one, walked there and back, and nothing is left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.deadline import Deadline
from cellcolor.tool_paths.distances import Ways, off_border, ways_from
from cellcolor.tool_paths.triangles import Triangles
from cellcolor.union_find import UnionFind

_MOST_CANDIDATES = 250  # bridges looked at for one door
_MOST_TRIED = 2000  # pairs of them


@dataclass(frozen=True)
class _Bridge:
    """A way from a vertex on one loop to a vertex on another.

    Attributes:
        first, second: the places of its ends in the rows of the two loops.
        way: vertices, both ends included.
    """

    first: int
    second: int
    way: list[int]


@dataclass
class _Door:
    """Two bridges between two loops, or twice the same."""

    loops: tuple[int, int]
    bridges: tuple[_Bridge, _Bridge]

    def places(self, loop: int) -> tuple[int, int]:
        """Where the bridges meet one of its loops."""
        if loop == self.loops[0]:
            return self.bridges[0].first, self.bridges[1].first
        return self.bridges[0].second, self.bridges[1].second


class _Loop:
    """A closed row of vertices, with the distance along it to each."""

    def __init__(self, mesh: Triangles, row: Index) -> None:
        self.row = row.tolist()
        steps = np.linalg.norm(mesh.points[np.roll(row, -1)] - mesh.points[row], axis=1)
        self.along = np.concatenate([[0.0], np.cumsum(steps)])
        self.length = float(self.along[-1])
        self.place = {vertex: place for place, vertex in enumerate(self.row)}

    def arc(self, a: int, b: int) -> tuple[float, int, int]:
        """The shorter way round between two places: its length, where it begins and ends."""
        forward = float(self.along[b] - self.along[a]) % self.length
        if forward <= self.length - forward:
            return forward, a, b
        return self.length - forward, b, a

    def inside(self, place: int, arc: tuple[int, int]) -> bool:
        """Whether a place is on the way from one place forward to another."""
        count = len(self.row)
        return (place - arc[0]) % count <= (arc[1] - arc[0]) % count


_Part = tuple[int, int, int, bool, _Door | None]
"""A loop by its number, the places where its walk begins and ends, whether it is walked forward,
and the door that it was entered by."""


def join_loops(mesh: Triangles, rows: list[Index], gap: float, deadline: Deadline) -> list[int]:
    """One closed path along all loops, as vertices; the first is the last as well.

    Args:
        mesh: on which the loops are rows of edges; connected.
        rows: the loops.
        gap: wanted distance between the two bridges of a door, m.
    """
    loops, doors = _doors_between(mesh, rows, gap)
    deadline.check()
    at = _by_loop(doors)
    # Begin where no door leaves a piece out.
    start = loops[0].arc(*at[0][0].places(0))[2] if at.get(0) else 0
    return _walked(loops, at, [(0, start, start, True, None)])


def _doors_between(
    mesh: Triangles, rows: list[Index], gap: float
) -> tuple[list[_Loop], list[_Door]]:
    """The loops, and the doors that join them along a shortest spanning tree."""
    loops = [_Loop(mesh, row) for row in rows]
    loop_of = np.full(len(mesh.points), -1, dtype=np.int64)
    for number, row in enumerate(rows):
        loop_of[row] = number
    ways = ways_from(mesh.graph(off_border(mesh, gap / 2)), np.concatenate(rows))
    candidates = _doors(mesh, loops, ways, loop_of[ways.source])
    _widen(loops, candidates, gap)
    return loops, [door for door, _ in candidates]


def _by_loop(doors: list[_Door]) -> dict[int, list[_Door]]:
    """The doors at each loop that has any."""
    at: dict[int, list[_Door]] = {}
    for door in doors:
        for loop in door.loops:
            at.setdefault(loop, []).append(door)
    return at


def _doors(
    mesh: Triangles, loops: list[_Loop], ways: Ways, loop_of: Index
) -> list[tuple[_Door, list[_Bridge]]]:
    """A door of one bridge for each branch of a shortest spanning tree, and other bridges."""
    a, b = mesh.edges.T
    apart = loop_of[a] != loop_of[b]
    a, b, lengths = a[apart], b[apart], mesh.lengths[apart]
    costs = ways.lengths[a] + lengths + ways.lengths[b]
    swapped = loop_of[a] > loop_of[b]
    a, b = np.where(swapped, b, a), np.where(swapped, a, b)
    order = np.argsort(costs, kind="stable")
    by_pair: dict[tuple[int, int], list[int]] = {}
    firsts, seconds = loop_of[a].tolist(), loop_of[b].tolist()
    for number in order.tolist():
        by_pair.setdefault((firsts[number], seconds[number]), []).append(number)
    joined: UnionFind[int] = UnionFind()
    found = []
    for (first, second), numbers in sorted(by_pair.items(), key=lambda item: costs[item[1][0]]):
        if joined[first] == joined[second]:
            continue
        joined.union(first, second)
        best = costs[numbers[0]]
        bridges = []
        for number in numbers[:_MOST_CANDIDATES]:
            if costs[number] > 1.25 * best:
                break
            start, end = ways.back_from(int(a[number])), ways.back_from(int(b[number]))
            way = [*start[::-1], *end]
            bridges.append(_Bridge(loops[first].place[way[0]], loops[second].place[way[-1]], way))
        found.append((_Door((first, second), (bridges[0], bridges[0])), bridges))
    return found


def _widen(loops: list[_Loop], doors: list[tuple[_Door, list[_Bridge]]], gap: float) -> None:
    """Give doors a second bridge where there is room; what they leave out holds no other door."""
    at = _by_loop([door for door, _ in doors])
    for door, bridges in doors:
        own = [loops[number] for number in door.loops]
        around = [
            (number, loops[number], [other for other in at[number] if other is not door])
            for number in door.loops
        ]
        wanted = min(gap, own[0].length / 4, own[1].length / 4)
        places = np.array([(bridge.first, bridge.second) for bridge in bridges])
        apart = [
            _pairs_apart(loop.along[places[:, end]], loop.length) for end, loop in enumerate(own)
        ]
        off = np.maximum(np.abs(apart[0] - wanted), np.abs(apart[1] - wanted))
        usable = np.argwhere(off < 0.5 * wanted)
        order = np.argsort(off[usable[:, 0], usable[:, 1]], kind="stable")
        for one, other in usable[order[:_MOST_TRIED]].tolist():
            pair = bridges[one], bridges[other]
            if all(
                _is_free(loop, number, loop.arc(*places[[one, other], end].tolist())[1:], others)
                for end, (number, loop, others) in enumerate(around)
            ):
                door.bridges = pair
                break


def _pairs_apart(along: Array, length: float) -> Array:
    """How far places on a loop are from each other, the shorter way round."""
    forward = (along[None, :] - along[:, None]) % length
    return np.minimum(forward, length - forward)


def _is_free(loop: _Loop, number: int, piece: tuple[int, int], doors: list[_Door]) -> bool:
    """Whether no door at a loop needs a place of a piece, or leaves out the piece's beginning."""
    for door in doors:
        _, begin, end = loop.arc(*door.places(number))
        if (
            loop.inside(begin, piece)
            or loop.inside(end, piece)
            or loop.inside(piece[0], (begin, end))
        ):
            return False
    return True


def _walked(
    loops: list[_Loop], at: dict[int, list[_Door]], parts: list[_Part | list[int]]
) -> list[int]:
    """The path along parts of loops and rows of vertices, with all loops behind doors."""
    path: list[int] = []
    to_do = parts[::-1]  # what is still to be walked, last first
    while to_do:
        item = to_do.pop()
        if isinstance(item, list):
            path += item
            continue
        to_do += _stages(loops, at, *item)[::-1]
    return path


def _stages(
    loops: list[_Loop],
    at: dict[int, list[_Door]],
    number: int,
    start: int,
    stop: int,
    forward: bool,
    came: _Door | None,
) -> list[_Part | list[int]]:
    """A loop from one place to another, with everything attached to it."""
    loop = loops[number]
    count = len(loop.row)
    step = 1 if forward else -1
    leaving: dict[int, list[tuple[int, _Door, bool]]] = {}
    for door in at.get(number, []):
        if door is came:
            continue
        _, begin, end = loop.arc(*door.places(number))
        if not forward:
            begin, end = end, begin
        leaving.setdefault(begin, []).append((end, door, begin == door.places(number)[0]))
    stages: list[_Part | list[int]] = []
    row: list[int] = []
    place = start
    # A whole loop comes back to where it began; a part of one ends at its last place.
    steps_left = (stop - start) * step % count or count
    while True:
        row.append(loop.row[place])
        for end, door, in_order in leaving.pop(place, []):
            one, other = door.bridges if in_order else door.bridges[::-1]
            here = door.loops[0] == number
            there = door.loops[1] if here else door.loops[0]
            over = one.way if here else one.way[::-1]
            back = other.way[::-1] if here else other.way
            entry, exit_ = (one.second, other.second) if here else (one.first, other.first)
            stages += [
                [*row, *over[1:-1]],
                _turn_of(loops[there], there, entry, exit_, door),
                back[1:-1],
            ]
            row = [loop.row[end]]
            steps_left -= (end - place) * step % count
            place = end
        if steps_left <= 0:
            break
        place = (place + step) % count
        steps_left -= 1
    stages.append(row)
    return stages


def _turn_of(loop: _Loop, number: int, entry: int, exit_: int, door: _Door) -> _Part:
    """How to walk a loop the long way from where it is entered to where it is left."""
    _, begin, _ = loop.arc(entry, exit_)
    # Forward leads through what the door leaves out if that begins at the entry.
    return number, entry, exit_, begin != entry or entry == exit_, door
