"""The instance as the model sees it: one cyclic list of live darts a cell, strands put in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from cellcolor.data.instance import Cell, Instance
from cellcolor.data.solution import Seam

Strand = tuple[int, int]
"""A dart and its strand, strands counted from 1 along the positive dart."""


@dataclass(frozen=True, slots=True)
class Dart:
    """One side of one strand of a live edge or seam.

    Attributes:
        name: the signed edge or seam, and the strand.
        cell: the cell whose border it is on.
        twin: index of the other side in ``DartGraph.darts``.
        colors: the colors joinable across it.
    """

    name: Strand
    cell: int
    twin: int
    colors: frozenset[int]


@dataclass(frozen=True)
class DartGraph:
    """A rotation system of live darts.

    Attributes:
        darts: all live darts.
        loops: each cell's darts as indices, loop by loop, in cyclic order with the cell on the
            left. Seams make one loop of all live loops of a cell; without seams they are apart.
        colors: each cell's colors.
        seams: the seams whose darts are among them.
    """

    darts: tuple[Dart, ...]
    loops: tuple[tuple[tuple[int, ...], ...], ...]
    colors: tuple[frozenset[int], ...]
    seams: tuple[Seam, ...]

    @cached_property
    def lists(self) -> tuple[tuple[int, ...], ...]:
        """Each cell's darts in one list; cyclic where seams connect its loops."""
        return tuple(tuple(dart for loop in loops for dart in loop) for loops in self.loops)

    @property
    def edges(self) -> list[int]:
        """One dart of every strand: the one with the lower index."""
        return [number for number, dart in enumerate(self.darts) if number < dart.twin]


def enough_strands(counts: Sequence[int]) -> list[int]:
    """Strands for the seams of a cell that leave its minimum unchanged (semantics, section 5).

    Args:
        counts: the live darts of each of its loops, strands counted.

    Returns:
        Strands of the seam to the second, third, … loop.
    """
    live = [count for count in counts if count]
    total = sum(live)
    found = []
    for count in counts[1:]:
        if len(live) < 2 or not count:
            found.append(0)
        elif len(live) == 2:
            found.append(max(0, total // 2 - 1))
        else:
            found.append(total // 2)
            total += 2 * found[-1]
    return found


def seams_of(
    instance: Instance,
    colors: Sequence[frozenset[int]],
    strands: Mapping[int, int],
    most: int | None,
) -> tuple[Seam, ...]:
    """Seams from the first live loop of every cell to its other live loops.

    Args:
        instance: the topological graph.
        colors: the colors each cell may be painted in, all or some of its own.
        strands: strands of each live edge.
        most: no seam gets more strands than this; None for as many as are ever needed.
    """
    seams: list[Seam] = []
    number = max((edge.id for edge in instance.edges), default=0)
    for cell in instance.cells:
        loops = _live_loops(instance, cell)
        counts = [
            sum(strands[abs(d)] for d in loop if _joinable(instance, colors, cell, d))
            for loop in loops
        ]
        for loop, count in zip(loops[1:], enough_strands(counts), strict=False):
            number += 1
            width = count if most is None else min(count, most)
            seams.append(Seam(number, cell.id, loops[0][0], loop[0], width))
    return tuple(seams)


def dart_graph(
    instance: Instance,
    colors: Sequence[frozenset[int]],
    strands: Mapping[int, int],
    seams: Sequence[Seam] | None,
) -> DartGraph:
    """Put strands and seams into the instance's loops and leave out what is dead.

    Args:
        instance: the topological graph.
        colors: the colors each cell may be painted in, all or some of its own.
        strands: strands of each live edge.
        seams: one for each further live loop of a cell, all from the cell's first live loop; None
            leaves the loops apart.
    """
    found: list[tuple[Strand, int, frozenset[int]]] = []
    lists: list[tuple[tuple[int, ...], ...]] = []
    for cell in instance.cells:
        if seams is None:
            walks = [_unseamed(loop) for loop in _live_loops(instance, cell)]
        else:
            walks = [_walk(instance, cell, [s for s in seams if s.cell == cell.id])]
        loops = []
        for walk in walks:
            first = len(found)
            for dart, seam in walk:
                if seam is None:
                    joinable, count = _joinable(instance, colors, cell, dart), strands[abs(dart)]
                else:
                    joinable, count = colors[cell.id], seam.strands
                numbers = range(1, count + 1 if joinable else 1)
                order = numbers if dart > 0 else reversed(numbers)
                found += [((dart, strand), cell.id, joinable) for strand in order]
            loops.append(tuple(range(first, len(found))))
        lists.append(tuple(loops))
    index = {name: number for number, (name, _, _) in enumerate(found)}
    darts = tuple(
        Dart(name, cell, index[-name[0], name[1]], joinable) for name, cell, joinable in found
    )
    return DartGraph(darts, tuple(lists), tuple(colors), tuple(seams or ()))


def _joinable(
    instance: Instance, colors: Sequence[frozenset[int]], cell: Cell, dart: int
) -> frozenset[int]:
    return colors[cell.id] & colors[instance.across(dart)] & frozenset(instance.joinable(dart))


def _live_loops(instance: Instance, cell: Cell) -> list[list[int]]:
    """Loops as their live darts; which are live must not depend on the colors left over, since
    a solution is read without knowing what was left out."""
    loops = [[dart for dart in loop if instance.joinable(dart)] for loop in cell.loops]
    return [loop for loop in loops if loop]


def _unseamed(loop: Sequence[int]) -> list[tuple[int, Seam | None]]:
    return [(dart, None) for dart in loop]


def _walk(instance: Instance, cell: Cell, seams: Sequence[Seam]) -> list[tuple[int, Seam | None]]:
    """The cell's live darts in one cyclic list, its seams with them."""
    loops = _live_loops(instance, cell)
    if not loops:
        return []
    walk = _unseamed(loops[0])
    for seam, loop in zip(seams, loops[1:], strict=True):
        start = loop.index(seam.to) + 1
        inner = _unseamed(loop[start:] + loop[:start])
        place = walk.index((seam.from_, None)) + 1
        walk[place:place] = [(seam.id, seam), *inner, (-seam.id, seam)]
    return walk
