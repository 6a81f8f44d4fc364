"""Trees in a divided cell: one for each sub-cell, connecting its darts, no two of them meeting.

The trees grow on the vertices of the cell. Where a mesh edge at a joined border ends in the cell
stands a *terminal* of its sub-cell. Two terminals, or what has been connected with them, are
connected next in one of two ways, and either leaves a drawing of the whole division possible
(docs/painting.md):

- along the wall: on a walk round what is free, if no unfinished sub-cell is met between the two;
- across, by a shortest way, if they are on different walks round what is free.

What is too narrow for that has to be refined.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from heapq import heappop, heappush

from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition.borders import Step
from cellcolor.union_find import UnionFind

_AT_A_WALL, _AT_A_PIECE = 10, 1000
"""What a way pays for a vertex there; elsewhere it pays 1. It makes long detours round a piece of
another sub-cell, which has to be reached later, and short ones round other walls."""


class TooNarrow(Exception):
    """The mesh of the cell leaves too little room for disjoint trees."""


def grow_trees(
    vertices: Iterable[int],
    around: Mapping[int, Sequence[int]],
    third: Mapping[Step, int],
    cracked: Callable[[int, int], bool],
    terminals: list[list[int]],
    deadline: Deadline = NEVER,
) -> dict[int, int]:
    """Disjoint connected sets of vertices, one for each sub-cell.

    Args:
        vertices: those of the cell.
        around: the neighbors of each vertex over mesh edges.
        third: the triangle on the left of each directed mesh edge, of a mesh without border.
        cracked: whether a mesh edge has a crack, given either way round.
        terminals: the vertices that each sub-cell has to contain, non-crossing.
        deadline: when to give up.

    Returns:
        ``{vertex: sub-cell}`` for those that were needed.

    Raises:
        OutOfTime: the deadline came first.
        TooNarrow: there is no room, or two sub-cells have one terminal in common.
    """
    return _Trees(vertices, around, third, cracked, terminals, deadline).grown()


class _Trees:
    def __init__(
        self,
        vertices: Iterable[int],
        around: Mapping[int, Sequence[int]],
        third: Mapping[Step, int],
        cracked: Callable[[int, int], bool],
        terminals: list[list[int]],
        deadline: Deadline,
    ) -> None:
        self.deadline = deadline
        self.free = set(vertices)
        self.third = third
        self.cracked = cracked
        self.around = around
        inside = self.free.union(*terminals)
        self.open = {
            v: [x for x in around[v] if x in inside and not cracked(v, x)]
            for v in deadline.watch(inside)
        }
        """The neighbors in the cell to which no crack bars the way."""
        self.walls = {
            (f, x) for f in deadline.watch(self.free) for x in around[f] if self._is_wall(f, x)
        }
        """Free vertices and what is beside them, if no tree can grow there."""
        self.owned: list[list[int]] = [[] for _ in terminals]
        self.owner: dict[int, int] = {}
        self.piece: UnionFind[int] = UnionFind()
        self.pieces = [len(set(own)) for own in terminals]
        for block, own in enumerate(terminals):
            for vertex in own:
                if self.owner.get(vertex, block) != block:
                    raise TooNarrow
                if vertex not in self.owner:
                    self._take(vertex, block)

    def grown(self) -> dict[int, int]:
        while any(count > 1 for count in self.pieces):
            walks = self._walks()
            path = self._along_a_wall(walks) or self._across(walks)
            if path is None:
                raise TooNarrow
            block, way = path
            self.pieces[block] += len(way)
            for vertex in way:
                self._take(vertex, block)
        return self.owner

    def _take(self, vertex: int, block: int) -> None:
        """Give a free vertex to a sub-cell: one piece less for each piece that it touches."""
        self.free.discard(vertex)
        self.owner[vertex] = block
        self.owned[block].append(vertex)
        for other in self.around[vertex]:
            self.walls.discard((vertex, other))
            if other in self.free:
                self.walls.add((other, vertex))
            touching = self.owner.get(other) == block and not self.cracked(vertex, other)
            if touching and self.piece[vertex] != self.piece[other]:
                self.piece.union(vertex, other)
                self.pieces[block] -= 1

    def _walks(self) -> list[list[Step]]:
        """Every walk round what is free, as steps (free vertex, what is beside it)."""
        left = set(self.walls)
        walks = []
        for first in self.deadline.watch(sorted(left)):
            if first not in left:
                continue
            walk = []
            step = first
            while True:
                self.deadline.check()
                left.discard(step)
                walk.append(step)
                step = self._following(step)
                if step == first:
                    break
            walks.append(walk)
        return walks

    def _following(self, step: Step) -> Step:
        f, x = step
        w = self.third[f, x]
        if self._is_wall(f, w):
            return f, w
        if self._is_wall(w, x):
            return w, x
        return x, f  # the free end of a crack: back along its other side

    def _is_wall(self, f: int, x: int) -> bool:
        """Whether no tree can grow from a free vertex to what is beside it."""
        return x not in self.free or self.cracked(f, x)

    def _unfinished(self, step: Step) -> int | None:
        """The sub-cell of several pieces that a step touches."""
        f, x = step
        block = self.owner.get(x)
        if block is None or self.pieces[block] == 1 or self.cracked(f, x):
            return None
        return block

    def _along_a_wall(self, walks: list[list[Step]]) -> tuple[int, list[int]] | None:
        """The shortest way along a wall between two pieces of one sub-cell."""
        best: tuple[int, list[int]] | None = None
        for walk in walks:
            met = [
                (place, block)
                for place, step in enumerate(walk)
                if (block := self._unfinished(step)) is not None
            ]
            for (here, block), (there, other) in zip(met, met[1:] + met[:1], strict=True):
                if block != other or self.piece[walk[here][1]] == self.piece[walk[there][1]]:
                    continue
                steps = walk[here : there + 1] if here < there else walk[here:] + walk[: there + 1]
                # Round the free end of a crack two of these are no neighbors. They are the next
                # pieces to be connected then, by the one vertex that lies ahead of the end.
                way = list(dict.fromkeys(f for f, _ in steps))
                if (best is None or len(way) < len(best[1])) and self._leaves_room(block, way):
                    best = block, way
        return best

    def _across(self, walks: list[list[Step]]) -> tuple[int, list[int]] | None:
        """The shortest way between pieces of one sub-cell on two different walks."""
        best: tuple[int, list[int]] | None = None
        touched: dict[int, dict[int, set[int]]] = {}
        for number, walk in enumerate(walks):
            for f, x in walk:
                block = self._unfinished((f, x))
                if block is not None:
                    touched.setdefault(block, {}).setdefault(number, set()).add(f)
        for block, by_walk in touched.items():
            for number, starts in by_walk.items():
                ends = {f for other, found in by_walk.items() if other > number for f in found}
                way = self._shortest(block, starts, ends)
                shorter = way and (best is None or len(way) < len(best[1]))
                if way and shorter and self._leaves_room(block, way):
                    best = block, way
        return best

    def _shortest(self, block: int, starts: set[int], ends: set[int]) -> list[int] | None:
        """The shortest way through what is free, away from walls and from other sub-cells' pieces.

        A way that ran along a wall could shut a piece in between.
        """
        before: dict[int, int | None] = {}
        queue: list[tuple[int, int, int | None]] = [(0, f, None) for f in sorted(starts)]
        while queue:
            self.deadline.check()
            far, vertex, previous = heappop(queue)
            if vertex in before:
                continue
            before[vertex] = previous
            if vertex in ends:
                way = []
                at: int | None = vertex
                while at is not None:
                    way.append(at)
                    at = before[at]
                return way
            for other in self.around[vertex]:
                if other in self.free and other not in before and not self.cracked(vertex, other):
                    heappush(queue, (far + self._crowded(block, other), other, vertex))
        return None

    def _crowded(self, block: int, f: int) -> int:
        """What a way has to pay for a free vertex: more if something is beside it."""
        cost = 1
        for x in self.around[f]:
            if not self._is_wall(f, x):
                continue
            met = self._unfinished((f, x))
            cost = max(cost, _AT_A_WALL if met is None or met == block else _AT_A_PIECE)
        return cost

    def _leaves_room(self, block: int, way: list[int]) -> bool:
        """Whether every unfinished sub-cell can still be connected, seen for itself."""
        taken = set(way)
        reached: dict[int, int] = {}
        for other, count in enumerate(self.pieces):
            if count <= 1:
                continue
            own = self.owned[other]
            if own[0] not in reached:
                self._flood(own[0], block, taken, reached)
            if any(reached.get(vertex) != reached[own[0]] for vertex in own):
                return False
        return True

    def _flood(self, start: int, block: int, taken: set[int], reached: dict[int, int]) -> None:
        """Give ``start`` to all that is connected with it once ``block`` has taken a way.

        The way is a wall to all but its own sub-cell. Everything that meets one piece is connected.
        """
        owner, left, way_met = self.owner, [start], False
        reached[start] = start
        while left:
            self.deadline.check()
            vertex = left.pop()
            mine, on_way = owner.get(vertex), vertex in taken
            # The way is one piece, even where it passes the free end of a crack.
            if on_way and not way_met:
                way_met = True
                left += [other for other in taken if other not in reached]
                reached.update(dict.fromkeys(taken, start))
            for other in self.open[vertex]:
                if other in reached:
                    continue
                theirs = owner.get(other)
                if mine is not None:
                    leads = mine == theirs or (
                        theirs is None and (other not in taken or mine == block)
                    )
                elif theirs is None:
                    leads = (other in taken) == on_way
                else:
                    leads = self.pieces[theirs] > 1 and (not on_way or theirs == block)
                if leads:
                    reached[other] = start
                    left.append(other)
