"""The same instance written in other ways.

Are two topological graphs the same up to the names of cells, edges and starting darts?

A cell carries its set of color names and a set of cyclic lists of darts; a dart has a joinable
set and, unless the outside lies beyond it, a twin. An isomorphism maps cells to cells and darts to
darts and keeps all of that. Following loops and twins from one dart to its image fixes everything
that hangs together; only unconnected loops and components leave a choice, which is searched.

Written from the definition of the format alone: it shares nothing with the decomposition.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import replace

from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
from cellcolor.data.instance import Instance


def turned(instance: Instance, rng: random.Random) -> Instance:
    """Other starting darts and another order of loops: seams then lie elsewhere."""
    cells = []
    for cell in instance.cells:
        loops = [loop[k:] + loop[:k] for loop in cell.loops for k in [rng.randrange(len(loop))]]
        rng.shuffle(loops)
        cells.append(replace(cell, loops=tuple(loops)))
    return replace(instance, cells=tuple(cells))


def renamed(instance: Instance, rng: random.Random) -> Instance:
    """Other numbers for cells, edges and colors, and edges seen from their other side."""
    cell_to = [*rng.sample(range(len(instance.cells)), len(instance.cells)), -1]
    color_to = rng.sample(range(len(instance.colors)), len(instance.colors))
    numbers = rng.sample(range(1, 5 * len(instance.edges) + 1), len(instance.edges))
    dart_to: dict[int, int] = {}
    edges = []
    for edge, number in zip(instance.edges, numbers, strict=True):
        signed = number * rng.choice((1, -1))
        dart_to |= {edge.id: signed, -edge.id: -signed}
        left, right = cell_to[edge.left], cell_to[edge.right]
        if signed < 0:
            left, right = right, left
        colors = None if edge.colors is None else tuple(color_to[c] for c in edge.colors)
        edges.append(Edge(number, left, right, colors))
    cells = [
        Cell(
            cell_to[cell.id],
            tuple(color_to[c] for c in cell.colors),
            tuple(tuple(dart_to[d] for d in loop) for loop in cell.loops),
        )
        for cell in instance.cells
    ]
    cells.sort(key=lambda cell: cell.id)
    rng.shuffle(edges)
    return Instance("renamed", instance.colors, tuple(cells), tuple(edges))


def mirrored(instance: Instance) -> Instance:
    """Seen in a mirror: loops run the other way, left and right change places."""
    cells = tuple(
        replace(cell, loops=tuple(tuple(-d for d in reversed(loop)) for loop in cell.loops))
        for cell in instance.cells
    )
    edges = tuple(replace(edge, left=edge.right, right=edge.left) for edge in instance.edges)
    return replace(instance, cells=cells, edges=edges, surface=None)


Loop = tuple[int, int]  # (cell, number of the loop in it)


class _Graph:
    def __init__(self, instance: Instance) -> None:
        self.instance = instance
        self.loops: dict[Loop, tuple[int, ...]] = {
            (cell.id, number): loop
            for cell in instance.cells
            for number, loop in enumerate(cell.loops)
        }
        self.place = {
            dart: (loop, position)
            for loop, darts in self.loops.items()
            for position, dart in enumerate(darts)
        }

    def names(self, colors: tuple[int, ...]) -> frozenset[str]:
        return frozenset(self.instance.colors[color] for color in colors)

    def cell_kind(self, cell: int) -> object:
        found = self.instance.cells[cell]
        return self.names(found.colors), sorted(len(loop) for loop in found.loops)

    def dart_kind(self, dart: int) -> object:
        outside = self.instance.across(dart) == OUTSIDE
        return outside, self.names(self.instance.joinable(dart))


class _Match:
    """A partial isomorphism."""

    def __init__(self, one: _Graph, other: _Graph) -> None:
        self.one, self.other = one, other
        self.cells: dict[int, int] = {}
        self.loops: dict[Loop, Loop] = {}

    def copy(self) -> _Match:
        twin = _Match(self.one, self.other)
        twin.cells, twin.loops = dict(self.cells), dict(self.loops)
        return twin

    def add_cell(self, cell: int, image: int) -> bool:
        if cell in self.cells or image in self.cells.values():
            return self.cells.get(cell) == image
        self.cells[cell] = image
        return self.one.cell_kind(cell) == self.other.cell_kind(image)

    def add_dart(self, dart: int, image: int) -> bool:
        """Map a dart, and with it all that follows from that; False on a contradiction."""
        darts: dict[int, int] = {}
        todo = [(dart, image)]
        while todo:
            dart, image = todo.pop()
            if dart in darts:
                if darts[dart] != image:
                    return False
                continue
            (loop, start), (loop_image, start_image) = self.one.place[dart], self.other.place[image]
            if loop in self.loops or loop_image in self.loops.values():
                return False  # reached before, and then dart would be in darts
            around, around_image = self.one.loops[loop], self.other.loops[loop_image]
            if len(around) != len(around_image) or not self.add_cell(loop[0], loop_image[0]):
                return False
            self.loops[loop] = loop_image
            for step in range(len(around)):
                d = around[(start + step) % len(around)]
                e = around_image[(start_image + step) % len(around)]
                if self.one.dart_kind(d) != self.other.dart_kind(e):
                    return False
                darts[d] = e
                if self.one.instance.across(d) != OUTSIDE:
                    todo.append((-d, -e))
        return True

    def extensions(self) -> Iterator[_Match]:
        """Every way to map one more cell or loop."""
        loop = next(
            (lp for lp in self.one.loops if lp not in self.loops and lp[0] in self.cells), None
        )
        if loop is None:
            cell = next(c.id for c in self.one.instance.cells if c.id not in self.cells)
            for image in range(len(self.other.instance.cells)):
                match = self.copy()
                if match.add_cell(cell, image):
                    yield match
            return
        for loop_image, around in self.other.loops.items():
            if loop_image[0] == self.cells[loop[0]] and loop_image not in self.loops.values():
                for dart in around:
                    match = self.copy()
                    if match.add_dart(self.one.loops[loop][0], dart):
                        yield match

    def complete(self) -> bool:
        return len(self.cells) == len(self.one.instance.cells) and len(self.loops) == len(
            self.one.loops
        )


def isomorphic(one: Instance, other: Instance) -> bool:
    """Whether two instances are the same rotation system with the same colors."""
    if set(one.colors) != set(other.colors) or len(one.cells) != len(other.cells):
        return False
    if len(one.edges) != len(other.edges):
        return False

    def search(match: _Match) -> bool:
        return match.complete() or any(search(extension) for extension in match.extensions())

    return search(_Match(_Graph(one), _Graph(other)))
