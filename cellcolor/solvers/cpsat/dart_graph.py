"""The instance as the model sees it: one cyclic list of live darts for each cell, with strands.

A strand is one of several parallel corridors across an edge; a seam is a virtual edge that makes
one cyclic list of two loops of a cell (docs/semantics.md, sections 4 and 5). The reference solver
(``dfs/graph.py``) and the checker (``dart_lists.py``) insert strands and seams with their own
code. This is on purpose: the others reveal a mistake made in only one of the three.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

from cellcolor.data.cells_and_edges import Strand
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Seam
from cellcolor.errors import TooLarge
from cellcolor.solvers.cpsat.parts import Loops, loops_of, seam_places

MOST_STRANDS = 100_000
"""The most strands of seams in a complete graph."""


class Dart(NamedTuple):
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
    """The live darts with their order around each cell, which is all that a model is built from.

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

    @cached_property
    def number_of(self) -> dict[Strand, int]:
        """The index of each dart by its name."""
        return {dart.name: number for number, dart in enumerate(self.darts)}

    @property
    def edges(self) -> list[int]:
        """One dart of every strand: the one with the lower index."""
        return [number for number, dart in enumerate(self.darts) if number < dart.twin]


def enough_strands(counts: Sequence[int]) -> list[int]:
    """Strands for the seams of a cell that leave its minimum unchanged (semantics, section 5).

    All of them leave from one corner of the first loop.

    Args:
        counts: the live darts of each of its loops, strands counted.

    Returns:
        Strands of the seam to the second, third, … loop.
    """
    live = sum(count > 0 for count in counts)
    enough = max(0, sum(counts) // 2 - (live == 2))
    return [enough if live > 1 and count else 0 for count in counts[1:]]


def seams_of(instance: Instance, strands: Mapping[int, int], most: int | None) -> tuple[Seam, ...]:
    """Seams from the first live loop of every cell to its other live loops; see ``widened``."""
    loops = loops_of(instance)
    return widened(instance, strands, loops, seam_places(instance, loops), most)


def widened(
    instance: Instance,
    strands: Mapping[int, int],
    loops: Loops,
    places: Sequence[Seam],
    most: int | None,
    *,
    lone: bool = False,
) -> tuple[Seam, ...]:
    """Seams with as many strands as are ever needed.

    Args:
        strands: strands of each live edge.
        loops: the loops between which seams run.
        places: where they run, in the order of cells and loops.
        most: no seam gets more strands than this; None for as many as are ever needed.
        lone: whether further loops with a single live dart get no strands, and count for none.
    """
    left = iter(places)
    seams: list[Seam] = []
    for own in loops:
        if len(own) < 2:
            continue
        counts = [sum(strands[abs(d)] for d in loop if instance.joinable(d)) for loop in own]
        if lone:
            counts[1:] = [0 if count == 1 else count for count in counts[1:]]
        widths = [count if most is None else min(count, most) for count in enough_strands(counts)]
        seams += [replace(next(left), strands=width) for width in widths]
    return tuple(seams)


def dart_graph(
    instance: Instance,
    strands: Mapping[int, int],
    seams: Sequence[Seam] | None,
    loops: Loops | None = None,
    *,
    lone: bool = False,
) -> DartGraph:
    """Put strands and seams into the instance's loops and leave out what is dead.

    Args:
        strands: strands of each live edge.
        seams: one for each further loop of a cell, all from the cell's first loop; None leaves the
            loops apart.
        loops: the loops of each cell between which its seams run; None for its live ones.
        lone: whether a further loop with a single live dart stays apart, without a seam.
    """
    loops = loops_of(instance) if loops is None else loops
    found: list[tuple[Strand, int, frozenset[int]]] = []
    lists: list[tuple[tuple[int, ...], ...]] = []
    seams_of: dict[int, list[Seam]] = {}
    for seam in seams or ():
        seams_of.setdefault(seam.cell, []).append(seam)
    colors = tuple(frozenset(cell.colors) for cell in instance.cells)
    joinable_of = {edge: frozenset(instance.joinable(edge)) for edge in instance.live_edges}
    for cell, own in zip(instance.cells, loops, strict=True):
        between = None if seams is None else seams_of.get(cell.id, [])
        apart = [
            lone and sum(strands[abs(d)] for d in loop if instance.joinable(d)) == 1
            for loop in own[1:]
        ]
        walks = _walks(own, between, apart)
        cyclic = []
        for walk in walks:
            first = len(found)
            for dart, through in walk:
                if through is None:
                    shared = joinable_of.get(abs(dart), frozenset())
                    count = strands[abs(dart)] if shared else 0
                else:
                    shared, count = colors[cell.id], through.strands
                numbers = range(1, count + 1)
                order = numbers if dart > 0 else reversed(numbers)
                found += [((dart, strand), cell.id, shared) for strand in order]
            cyclic.append(tuple(range(first, len(found))))
        lists.append(tuple(cyclic))
    index = {name: number for number, (name, _, _) in enumerate(found)}
    darts = tuple(Dart(name, cell, index[-name[0], name[1]], own) for name, cell, own in found)
    return DartGraph(darts, tuple(lists), colors, tuple(seams or ()))


def complete_graph(
    instance: Instance,
    strands: Mapping[int, int],
    loops: Loops,
    places: Sequence[Seam],
) -> DartGraph:
    """The graph in which every scheme can be drawn: seams as wide as needed, lone darts apart.

    Args:
        strands: of each live edge.
        loops: the loops of each cell between which its seams run.
        places: where they run, in the order of cells and loops.

    Raises:
        TooLarge: seams would need too many strands.
    """
    seams = widened(instance, strands, loops, places, None, lone=True)
    count = sum(seam.strands for seam in seams)
    if count > MOST_STRANDS:
        message = f"{count} strands of seams, {MOST_STRANDS} are the most"
        raise TooLarge(f"The model was not built: it would need {message}.")
    return dart_graph(instance, strands, seams, loops, lone=True)


def _walks(
    loops: Sequence[tuple[int, ...]], seams: Sequence[Seam] | None, apart: Sequence[bool]
) -> list[list[tuple[int, Seam | None]]]:
    """The lists of a cell: one that seams make, and the loops that stay apart.

    Args:
        seams: one for each loop but the first; None if all of them stay apart.
        apart: whether each loop but the first does.
    """
    if seams is None:
        return [_unseamed(loop) for loop in loops]
    others = list(zip(loops[1:], seams, apart, strict=True)) if loops else []
    seamed = [loop for loop, _, own in others if not own]
    through = [seam for _, seam, own in others if not own]
    return [
        _walk([*loops[:1], *seamed], through),
        *(_unseamed(loop) for loop, _, own in others if own),
    ]


def _unseamed(loop: Sequence[int]) -> list[tuple[int, Seam | None]]:
    return [(dart, None) for dart in loop]


def _walk(loops: Sequence[tuple[int, ...]], seams: Sequence[Seam]) -> list[tuple[int, Seam | None]]:
    """A cell's darts in one cyclic list, its seams with them."""
    if not loops:
        return []
    base, *others = loops
    walk = _unseamed(base[1:])
    for seam, loop in zip(seams, others, strict=True):
        # Every seam leaves after the first dart of the first loop, so the last one is met first,
        # and arrives after the first dart of the other.
        walk[:0] = [(seam.id, seam), *_unseamed(loop[1:] + loop[:1]), (-seam.id, seam)]
    return [*_unseamed(base[:1]), *walk]
