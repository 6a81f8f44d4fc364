"""Rule 5 of a scheme: no edge in state 0 has to show one joinable color on both sides.

A dart in state 0 (a zero) shows the color of the sub-cell before it or after it along the border
(docs/semantics.md, section 3). The reference solver and the checker decide this with code of their
own, so the three can be compared.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from itertools import pairwise, product

from cellcolor.deadline import NEVER, Deadline
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph
from cellcolor.solvers.cpsat.model.painting import Block


def zeros_can_differ(
    graph: DartGraph, painting: Sequence[Sequence[Block]], deadline: Deadline = NEVER
) -> bool:
    """Whether every dart in state 0 can show a color so that rule 5 holds.

    Between two successive darts in state 1 there is a run of zeros. The first ones of a run show
    the color of the block before it ("early"), the others that of the block after it ("late"). One
    choice for each zero is a 2-satisfiability problem. It is solved by unit propagation: try a
    value, derive its consequences, and keep them all unless they contradict each other.

    If a cell has darts in state 1, a loop of it without any lies in one of the cell's blocks, so
    each color of a block is tried for it.

    Args:
        painting: the blocks of each cell.
    """
    open_loops = {}
    for loops, blocks in zip(graph.loops, painting, strict=True):
        joined = {dart for block in blocks for dart in block.darts}
        for loop in loops if joined else ():
            if joined.isdisjoint(loop):
                open_loops[loop] = _colors_for(graph, loop, sorted({b.color for b in blocks}))
    for colors in product(*open_loops.values()):
        deadline.check()
        if _can_differ(graph, painting, dict(zip(open_loops, colors, strict=True))):
            return True
    return False


def _colors_for(graph: DartGraph, loop: Sequence[int], colors: list[int]) -> list[int]:
    """The colors worth trying for a loop; one that is joinable nowhere on it is the best choice."""
    idle = [c for c in colors if not any(c in graph.darts[dart].colors for dart in loop)]
    return idle[:1] or colors


def _can_differ(
    graph: DartGraph,
    painting: Sequence[Sequence[Block]],
    color_of_loop: Mapping[tuple[int, ...], int],
) -> bool:
    colors, forced = _gaps(graph, painting, color_of_loop)
    chosen: dict[int, bool] = {}

    def consequences(dart: int, late: bool) -> list[tuple[int, bool]]:
        """The choices that follow: for the next zero of the run, and for the edge's other side."""
        found = []
        if (dart, late) in forced:
            found.append((forced[dart, late], late))
        twin = graph.darts[dart].twin
        color = colors[dart][late]
        if color in graph.darts[dart].colors:
            found += [(twin, not other) for other in (False, True) if colors[twin][other] == color]
        return found

    def choose(dart: int, late: bool) -> bool:
        """Make a choice with all that follows from it, unless that is a contradiction."""
        trail = {dart: late}
        queue = deque([(dart, late)])
        while queue:
            for other, value in consequences(*queue.popleft()):
                known = chosen.get(other, trail.get(other))
                if known is None:
                    trail[other] = value
                    queue.append((other, value))
                elif known != value:
                    return False
        chosen.update(trail)
        return True

    return all(dart in chosen or choose(dart, False) or choose(dart, True) for dart in colors)


def _gaps(
    graph: DartGraph,
    painting: Sequence[Sequence[Block]],
    color_of_loop: Mapping[tuple[int, ...], int],
) -> tuple[dict[int, tuple[int, int]], dict[tuple[int, bool], int]]:
    """For each dart in state 0 the colors (early, late), and the dart that each choice forces.

    A dart that shows the late color forces the next one of its run to do so, too. One that shows
    the early color forces the one before it.
    """
    colors: dict[int, tuple[int, int]] = {}
    forced: dict[tuple[int, bool], int] = {}
    for loops, blocks in zip(graph.loops, painting, strict=True):
        color_of = {dart: block.color for block in blocks for dart in block.darts}
        for loop in loops:
            own = gap_colors(loop, color_of, color_of_loop.get(loop, blocks[0].color))
            colors |= own
            for dart, following in pairwise((*loop, loop[0])):
                if dart in own and following in own:
                    forced[dart, True], forced[following, False] = following, dart
    return colors, forced


def gap_colors(
    loop: Sequence[int], color_of: Mapping[int, int], otherwise: int
) -> dict[int, tuple[int, int]]:
    """The colors before and after each dart in state 0 of a loop.

    Args:
        loop: the darts, in cyclic order.
        color_of: the color of each dart in state 1.
        otherwise: the color that all of them show if the loop has no dart in state 1.
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
