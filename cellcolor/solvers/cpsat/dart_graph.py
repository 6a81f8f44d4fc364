"""The instance as the model sees it: one cyclic list of live darts for each cell, with strands.

A strand is one of several parallel corridors across an edge; a seam is a virtual edge that makes
one cyclic list of two loops of a cell (docs/semantics.md, sections 4 and 5). The reference solver
(``dfs/graph.py``) and the checker (``dart_lists.py``) have their own code for both, on purpose: a
mistake in one of the three is found by comparing.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

from cellcolor.data.cells_and_edges import Cell, Edge, Strand
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Seam
from cellcolor.errors import TooLarge
from cellcolor.union_find import UnionFind

MOST_STRANDS = 100_000
"""The most strands of seams in a complete graph."""


class Dart(NamedTuple):
    """One side of one strand of a live edge or seam.

    Attributes:
        name: the signed edge or seam, and the strand.
        twin: index of the other side in ``DartGraph.darts``.
        colors: the colors joinable across it.
    """

    name: Strand
    cell: int
    twin: int
    colors: frozenset[int]


@dataclass(frozen=True)
class DartGraph:
    """The live darts with their order around each cell, which is all that a model is built from.

    Attributes:
        loops: each cell's darts as indices, loop by loop, in cyclic order with the cell on the
            left. Seams make one loop of all live loops of a cell; without seams they are apart.
        colors: of each cell.
        seams: those whose darts are among the darts.
    """

    darts: tuple[Dart, ...]
    loops: tuple[tuple[tuple[int, ...], ...], ...]
    colors: tuple[frozenset[int], ...]
    seams: tuple[Seam, ...]

    @cached_property
    def lists(self) -> tuple[tuple[int, ...], ...]:
        """Each cell's darts in one list; cyclic where seams connect its loops."""
        return tuple(tuple(dart for loop in loops for dart in loop) for loops in self.loops)

    @cached_property
    def number_of(self) -> dict[Strand, int]:
        """The index of each dart by its name."""
        return {dart.name: number for number, dart in enumerate(self.darts)}


def dart_graph(
    instance: Instance, strands: Mapping[int, int], seams: Sequence[Seam] | None
) -> DartGraph:
    """Put strands and seams into the instance's loops and leave out what is dead.

    Args:
        strands: of each live edge.
        seams: one for each further loop of a cell, all from the cell's first loop; None leaves the
            loops apart.
    """
    colors = tuple(frozenset(cell.colors) for cell in instance.cells)
    joinable = {edge: frozenset(instance.joinable(edge)) for edge in instance.live_edges}
    count = dict(strands)
    seams_of: list[list[int]] = [[] for _ in colors]
    for seam in seams or ():
        seams_of[seam.cell].append(seam.id)
        joinable[seam.id], count[seam.id] = colors[seam.cell], seam.strands
    found: list[tuple[Strand, int]] = []
    lists: list[tuple[tuple[int, ...], ...]] = []
    for cell, loops in enumerate(_loops(instance)):
        cyclic = []
        for walk in loops if seams is None else [_walk(loops, seams_of[cell])]:
            first = len(found)
            for dart in walk:
                numbers = range(1, count[abs(dart)] + 1)
                order = numbers if dart > 0 else reversed(numbers)
                found += [((dart, strand), cell) for strand in order]
            cyclic.append(tuple(range(first, len(found))))
        lists.append(tuple(cyclic))
    index = {name: number for number, (name, _) in enumerate(found)}
    darts = tuple(
        Dart(name, cell, index[-name[0], name[1]], joinable[abs(name[0])]) for name, cell in found
    )
    return DartGraph(darts, tuple(lists), colors, tuple(seams or ()))


def wide_enough_seams(
    instance: Instance, strands: Mapping[int, int], most: int | None = None
) -> tuple[Seam, ...]:
    """Seams from the first live loop of every cell to its other live loops.

    They have as many strands as leave the cell's minimum unchanged (semantics, section 5).

    Args:
        strands: of each live edge.
        most: of each seam.

    Raises:
        TooLarge: the seams would need too many strands.
    """
    widths: list[int] = []
    for own in instance.live_loops:
        darts = sum(strands[abs(dart)] for loop in own for dart in loop)
        for _ in own[1:]:
            enough = max(0, darts // 2 - (len(own) == 2))
            widths.append(enough if most is None else min(enough, most))
            darts += 2 * enough  # on both sides of this seam
    if sum(widths) > MOST_STRANDS:
        message = f"{sum(widths)} strands of seams, {MOST_STRANDS} are the most"
        raise TooLarge(f"The model was not built: it would need {message}.")
    places = seam_places(instance)
    return tuple(replace(seam, strands=w) for seam, w in zip(places, widths, strict=True))


def complete_graph(instance: Instance, strands: Mapping[int, int]) -> DartGraph:
    """The graph in which every scheme can be drawn, with so many strands of each live edge."""
    own = {edge: strands[edge] for edge in instance.live_edges}
    return dart_graph(instance, own, wide_enough_seams(instance, own))


def narrow_graph(instance: Instance, most: int) -> DartGraph:
    """The graph with one strand of each live edge, and at most so many of each seam."""
    once = dict.fromkeys(instance.live_edges, 1)
    return dart_graph(instance, once, wide_enough_seams(instance, once, most))


def seam_places(instance: Instance) -> tuple[Seam, ...]:
    """Seams from the first live loop of every cell to its other live loops, without strands."""
    seams: list[Seam] = []
    number = max((edge.id for edge in instance.edges), default=0)
    for cell, loops in enumerate(_loops(instance)):
        for loop in loops[1:]:
            number += 1
            seams.append(Seam(number, cell, loops[0][0], loop[0], 0))
    return tuple(seams)


def split(instance: Instance) -> list[tuple[Instance, list[int]]]:
    """The parts of an instance that live edges connect, the smallest first.

    Segments never reach from one into another, so minima and bounds add up.

    Returns:
        Each part with its cells renumbered in their order, and its live edges under their own ids;
        and the number that each of these cells has in the whole.
    """
    connected = UnionFind(range(len(instance.cells)))
    for edge in instance.live_edges:
        connected.union(instance.edge(edge).left, instance.edge(edge).right)
    loops = _loops(instance)
    parts = []
    for cells in sorted(map(sorted, connected.sets()), key=len):
        number = {cell: place for place, cell in enumerate(cells)}
        own = sorted(dart for c in cells for loop in loops[c] for dart in loop if dart > 0)
        edges = tuple(
            Edge(e.id, number[e.left], number[e.right], instance.joinable(e.id))
            for e in map(instance.edge, own)
        )
        within = tuple(
            Cell(place, instance.cells[cell].colors, tuple(loops[cell]))
            for cell, place in number.items()
        )
        parts.append((Instance(instance.name, instance.colors, within, edges), cells))
    return parts


def _loops(instance: Instance) -> list[list[tuple[int, ...]]]:
    """The live loops of each cell. All seams of a cell leave from the longest one, the first."""
    return [sorted(own, key=len, reverse=True) for own in instance.live_loops]


def _walk(loops: Sequence[tuple[int, ...]], seams: Sequence[int]) -> list[int]:
    """A cell's loops in one cyclic list, its seams with them."""
    if not loops:
        return []
    (first, *rest), *others = loops
    for seam, loop in zip(seams, others, strict=True):
        # Every seam leaves after the first dart of the first loop, so the last one is met first,
        # and arrives after the first dart of the other.
        rest = [seam, *loop[1:], loop[0], -seam, *rest]
    return [first, *rest]


def enough_crossings(instance: Instance) -> dict[int, float]:
    """How many strands of each live edge suffice for a minimum over all divisions, or infinity.

    An edge with a single joinable color is crossed at most once, any other at most as often as the
    other edges of the cell on either side together (docs/bounds.md). This is applied until nothing
    changes. It says nothing about a cell with several live loops, nor about edges with the same
    cell on both sides.
    """
    enough = {
        edge: math.inf if len(instance.joinable(edge)) > 1 else 1 for edge in instance.live_edges
    }
    borders = [
        [abs(dart) for dart in loops[0]] if len(loops) == 1 else [] for loops in instance.live_loops
    ]
    changed = True
    while changed:
        changed = False
        for edge in instance.edges:
            known = enough.get(edge.id, 1)
            if known == 1 or edge.left == edge.right:
                continue
            for border in (borders[edge.left], borders[edge.right]):
                others = sum(enough[other] for other in border if other != edge.id)
                if border and max(1, others) < enough[edge.id]:
                    enough[edge.id] = max(1, others)
                    changed = True
    return enough
