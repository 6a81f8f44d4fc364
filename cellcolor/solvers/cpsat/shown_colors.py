"""Rule 5 for a part of the cells: what darts in state 0, zeros, can show towards the others.

Each zero shows the color of the sub-cell before it or after it along the border. To choose them so
that no edge shows one joinable color on both sides is a 2-satisfiability problem. When only some
cells are painted, all that matters of it is what it says about the zeros towards the other cells.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from itertools import pairwise, product
from typing import NamedTuple

from cellcolor.solvers.cpsat.cell_divisions import Blocks
from cellcolor.solvers.cpsat.dart_graph import DartGraph

Clause = tuple[int, ...]
"""One or two literals in ascending order, at least one of which is true. ``dart + 1`` says that the
dart shows the later of its two colors, ``-dart - 1`` that it shows the earlier one."""


class Choices(NamedTuple):
    """What the zeros among some darts can show.

    Attributes:
        colors: of each zero, in the order of the darts, the earlier and the later color; -1 for
            one that cannot be joined there, as all of these are alike.
        clauses: all that follows for these zeros from the rest, and nothing that follows from two
            others of these.
    """

    colors: tuple[tuple[int, int], ...]
    clauses: frozenset[Clause]


ShownColors = dict[int, tuple[int, int]]
"""The early and the late color of each zero."""


def shown_in_cell(loops: Sequence[Sequence[int]], blocks: Blocks) -> list[ShownColors]:
    """The ways to show colors in a divided cell: one for each choice of blocks for free loops."""
    color_of = {dart: color for color, own in blocks for dart in own}
    every = sorted({color for color, _ in blocks})
    choices = [
        [_gap_colors(loop, color_of, color) for color in every]
        if color_of.keys().isdisjoint(loop)
        else [_gap_colors(loop, color_of, every[0])]
        for loop in loops
    ]
    return [
        {dart: pair for loop in chosen for dart, pair in loop.items()}
        for chosen in product(*choices)
    ]


def choices_with(
    graph: DartGraph,
    before: Iterable[tuple[ShownColors, frozenset[Clause]]],
    cell: int,
    ways: Sequence[ShownColors],
    open_darts: Collection[int],
) -> frozenset[Choices]:
    """The choices that are left when one more cell is painted; none if its edges rule out all.

    Args:
        before: the choices without the cell.
        ways: to show colors in it.
        open_darts: those towards the cells that are still not painted.
    """
    found = set()
    for (old, clauses), own in product(before, ways):
        shown = old | own
        every = {*clauses, *_clauses(graph, cell, own, shown)}
        zeros = [dart for dart in open_darts if dart in shown]
        colors = [
            tuple(color if color in graph.darts[dart].colors else -1 for color in shown[dart])
            for dart in zeros
        ]
        kept = {dart for dart, (one, two) in zip(zeros, colors, strict=True) if one != two}
        left = _about(kept, every)
        if left is not None:
            found.add(Choices(tuple((one, two) for one, two in colors), left))
    return frozenset(found)


def _clauses(graph: DartGraph, cell: int, own: ShownColors, shown: ShownColors) -> Iterable[Clause]:
    """What the zeros of a cell have to heed; ``shown`` are the colors of those of all cells."""
    for loop in graph.loops[cell]:
        for dart, following in pairwise((*loop, loop[0])):
            if dart != following and dart in own and following in own:
                yield (-dart - 1, following + 1)  # the color changes once in a gap
    for dart, pair in own.items():
        if pair[0] == pair[1]:
            yield (dart + 1,)
        twin = graph.darts[dart].twin
        for late, late_there in product((0, 1), repeat=2) if twin in shown else ():
            color = pair[late]
            if color == shown[twin][late_there] and color in graph.darts[dart].colors:
                one = -dart - 1 if late else dart + 1
                other = -twin - 1 if late_there else twin + 1
                yield (min(one, other), max(one, other))


def _about(darts: Collection[int], clauses: Collection[Clause]) -> frozenset[Clause] | None:
    """What clauses say about some darts alone; None if they contradict each other.

    With all resolvents added, the clauses that name only these darts are just what is implied.
    """
    found = set(clauses)
    new = list(found)
    while new:
        one = new.pop()
        for other in tuple(found):
            for literal in one:
                if -literal in other:
                    rest = {x for x in (*one, *other) if abs(x) != abs(literal)}
                    if any(-x in rest for x in rest):
                        continue
                    clause = tuple(sorted(rest))
                    if not clause:
                        return None
                    if clause not in found:
                        found.add(clause)
                        new.append(clause)
    units = {clause[0] for clause in found if len(clause) == 1}
    return frozenset(
        clause
        for clause in found
        if all(abs(literal) - 1 in darts for literal in clause)
        and (len(clause) == 1 or units.isdisjoint(clause))
    )


def _gap_colors(
    loop: Sequence[int], color_of: Mapping[int, int], otherwise: int
) -> dict[int, tuple[int, int]]:
    """The colors before and after each dart in state 0 of a loop.

    Args:
        color_of: the color of each dart in state 1.
        otherwise: the color that all show if the loop has no dart in state 1.
    """
    met = [color_of[dart] for dart in loop if dart in color_of] or [otherwise]
    found = {}
    passed = 0
    for dart in loop:
        if dart in color_of:
            passed += 1
        else:
            found[dart] = met[passed - 1], met[passed % len(met)]
    return found
