"""Rule 5 of a scheme: can all edges in state 0 show two colors, or one that cannot join?

A dart in state 0, a zero, shows the color of the sub-cell that it is given to: the one before it or
the one after it along the border (docs/semantics.md, section 3). The reference solver and the
checker decide the same with their own code, so they can be compared.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from itertools import product

from cellcolor.deadline import NEVER, Deadline
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph
from cellcolor.solvers.cpsat.model.painting import Block


def zeros_can_differ(
    graph: DartGraph, painting: Sequence[Sequence[Block]], deadline: Deadline = NEVER
) -> bool:
    """Whether the darts in state 0 can be assigned to the blocks before and after them.

    Within a gap the assigned colors change once, from the color before to the color after. Each
    dart in state 0 has a choice, early or late: a 2-satisfiability problem, solved by trying and
    propagating. The consequences of a choice are kept if they lead to no contradiction.

    A loop without darts in state 1, in a cell that has some on another loop, lies in one of the
    cell's blocks: each color that these have is tried.

    Args:
        graph: the dart graph.
        painting: each cell's blocks.
        deadline: when to stop.

    Raises:
        OutOfTime: the deadline has passed.
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
    """The colors worth trying for a loop: one that joins nowhere is as good as any."""
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
        found = []
        follower = forced[dart, late]
        if follower is not None:
            found.append((follower, late))
        twin = graph.darts[dart].twin
        color = colors[dart][late]
        if color in graph.darts[dart].colors:
            found += [(twin, not other) for other in (False, True) if colors[twin][other] == color]
        return found

    def choose(dart: int, late: bool) -> bool:
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
) -> tuple[dict[int, tuple[int, int]], dict[tuple[int, bool], int | None]]:
    """The colors before and after each dart in state 0, and which dart its choice forces.

    A dart that shows the later color makes the next one do so; one that shows the earlier color
    makes the one before it do so.
    """
    colors: dict[int, tuple[int, int]] = {}
    forced: dict[tuple[int, bool], int | None] = {}
    for loops, blocks in zip(graph.loops, painting, strict=True):
        color_of = {dart: block.color for block in blocks for dart in block.darts}
        for loop in loops:
            start = next((place for place, dart in enumerate(loop) if dart in color_of), None)
            if start is None:
                own = color_of_loop.get(loop, blocks[0].color)
                _add_run(loop, (own, own), colors, forced)
                continue
            before = color_of[loop[start]]
            run: list[int] = []
            for dart in [*loop[start:], *loop[: start + 1]]:
                if dart not in color_of:
                    run.append(dart)
                    continue
                _add_run(run, (before, color_of[dart]), colors, forced)
                before, run = color_of[dart], []
    return colors, forced


def _add_run(
    run: Sequence[int],
    pair: tuple[int, int],
    colors: dict[int, tuple[int, int]],
    forced: dict[tuple[int, bool], int | None],
) -> None:
    for place, dart in enumerate(run):
        colors[dart] = pair
        forced[dart, True] = run[place + 1] if place + 1 < len(run) else None
        forced[dart, False] = run[place - 1] if place else None
