"""Disjoint trees in a divided cell: one for each sub-cell, connecting its darts.

The trees consist of vertices of the cell. Each joined border has a mesh edge as its gate; the end
of a gate in this cell is a **terminal** of the sub-cell there. Terminals that mesh edges connect
form a **piece**; a sub-cell is unfinished while it has several pieces. Vertices on no tree are
**free**. A **wall** is whatever bounds the free vertices: trees, borders of the cell, cracks. A
**walk** goes round a connected part of the wall once, with the free vertices on its left.

Each step connects two pieces of one sub-cell in one of two ways. After either, the rest of the
division can still be drawn:

- along the wall, if the two pieces are on one walk and no unfinished sub-cell is met between them,
  so that nothing unfinished is shut in;
- across, by a shortest way, if they are on different walks: such a cut never parts a planar region.

One of the two is always possible, because sub-cells do not cross: on each walk one unfinished
sub-cell is innermost. If the mesh is too narrow for that, the caller has to refine it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from heapq import heappop, heappush

from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition.borders import Step
from cellcolor.union_find import UnionFind

_AT_A_WALL, _AT_A_PIECE = 10, 1000
"""Cost of a vertex beside a wall, and beside a piece of another unfinished sub-cell; any other
vertex costs 1. So a way across makes short detours round walls. It makes long ones round pieces:
they have to be connected later, so they must not be shut in."""


class TooNarrow(Exception):
    """The mesh of the cell leaves too little room for disjoint trees."""


class Trees:
    """Disjoint connected sets of vertices that grow, one for each sub-cell.

    Attributes:
        free: the vertices on no tree.
        open: the neighbors in the cell of each vertex, across edges without a crack.
        walls: pairs (free vertex, neighbor) such that no tree can grow from the one to the other.
        owner: the sub-cell of each vertex on a tree.
        owned: the vertices on the tree of each sub-cell.
        piece: the vertices of each piece, united.
        pieces: how many pieces each sub-cell has; it is finished with one.
    """

    def __init__(
        self,
        vertices: Iterable[int],
        around: Mapping[int, Sequence[int]],
        third: Mapping[Step, int],
        cracked: Callable[[int, int], bool],
        terminals: list[list[int]],
        deadline: Deadline = NEVER,
    ) -> None:
        """Each terminal alone is a tree.

        Args:
            vertices: those of the cell.
            around: the neighbors of each vertex over mesh edges.
            third: the third vertex of the triangle on the left of each directed mesh edge; the
                mesh is closed.
            cracked: whether a mesh edge has a crack, given in either direction.
            terminals: the vertices that each sub-cell has to contain; the sub-cells do not cross.

        Raises:
            TooNarrow: two sub-cells have one terminal in common.
        """
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
        self.walls = {
            (f, x) for f in deadline.watch(self.free) for x in around[f] if self._is_wall(f, x)
        }
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
        """``{vertex: sub-cell}`` of disjoint trees that connect each sub-cell's terminals.

        Raises:
            TooNarrow: there is no room.
        """
        while any(count > 1 for count in self.pieces):
            walks = self._walks()
            path = self._along_a_wall(walks) or self._across(walks)
            if path is None:
                raise TooNarrow
            block, way = path
            self.pieces[block] += len(way)  # each vertex alone at first: _take unites them
            for vertex in way:
                self._take(vertex, block)
        return self.owner

    def _take(self, vertex: int, block: int) -> None:
        """Give a free vertex to a sub-cell, and unite the pieces that it connects."""
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
        """All walks round walls, as steps (free vertex, its neighbor in the wall)."""
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
        """The next step of a walk, across the triangle on the left of the step."""
        f, x = step
        w = self.third[f, x]
        if self._is_wall(f, w):
            return f, w
        if self._is_wall(w, x):
            return w, x
        return x, f  # the free end of a crack: back along its other side

    def _is_wall(self, f: int, x: int) -> bool:
        """Whether no tree can grow from a free vertex to its neighbor ``x``."""
        return x not in self.free or self.cracked(f, x)

    def _unfinished(self, step: Step) -> int | None:
        """The unfinished sub-cell that a step touches, if it touches one."""
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
                # Where the walk goes round the end of a crack, two successive vertices of the way
                # are not neighbors. Then they are two pieces, connected by a later step through the
                # vertex ahead of that end.
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
        """The cheapest way through free vertices from some starts to some ends (Dijkstra).

        Vertices beside walls and beside other sub-cells' pieces cost more, because a way along a
        wall could shut a piece in.
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
        """The cost of a free vertex on a way of ``block``."""
        cost = 1
        for x in self.around[f]:
            if not self._is_wall(f, x):
                continue
            met = self._unfinished((f, x))
            cost = max(cost, _AT_A_WALL if met is None or met == block else _AT_A_PIECE)
        return cost

    def _leaves_room(self, block: int, way: list[int]) -> bool:
        """Whether each unfinished sub-cell, taken alone, could still be connected after the way."""
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
        """Label with ``start`` all vertices that are connected with it once ``block`` has a way.

        Vertices are connected as follows (``mine``, ``theirs``: their owners; None if free):

        - two vertices of one tree, always;
        - two free vertices, if both are on the way or neither is;
        - a free vertex and one of an unfinished sub-cell. If the free one is on the way, only
          if that sub-cell is ``block``: to all others the way is a wall.
        """
        owner, left, way_met = self.owner, [start], False
        reached[start] = start
        while left:
            self.deadline.check()
            vertex = left.pop()
            mine, on_way = owner.get(vertex), vertex in taken
            # The way counts as connected even where it goes round the end of a crack.
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
