"""Rule 5 of a scheme: can all edges in state 0 show two colors, or one that cannot join?"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

from cellcolor.solvers.cpsat.graph import DartGraph
from cellcolor.solvers.cpsat.painting import Block

__all__ = ["zeros_can_differ"]


def zeros_can_differ(graph: DartGraph, painting: Sequence[Sequence[Block]]) -> bool:
    """Whether the darts in state 0 can be dealt to the blocks before and after them.

    Within a gap the dealt colors change once, from that before to that after. Each dart in state 0
    has a choice, early or late; a 2-satisfiability problem, solved by trying and propagating:
    what a choice forces is kept when it leads to no contradiction, for it then hinders nothing.

    Args:
        graph: the dart graph.
        painting: each cell's blocks.
    """
    colors, forced = _gaps(graph, painting)
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
    graph: DartGraph, painting: Sequence[Sequence[Block]]
) -> tuple[dict[int, tuple[int, int]], dict[tuple[int, bool], int | None]]:
    """The colors before and after each dart in state 0, and which dart its choice forces.

    A dart that shows the later color makes the next one do so; one that shows the earlier color
    makes the one before it do so.
    """
    colors: dict[int, tuple[int, int]] = {}
    forced: dict[tuple[int, bool], int | None] = {}
    for cell, blocks in zip(graph.lists, painting, strict=True):
        color_of = {dart: block.color for block in blocks for dart in block.darts}
        start = next((place for place, dart in enumerate(cell) if dart in color_of), 0)
        before = color_of[cell[start]] if color_of else blocks[0].color
        run: list[int] = []
        for dart in [*cell[start:], *cell[:start]]:
            if dart not in color_of:
                run.append(dart)
                continue
            _add_run(run, (before, color_of[dart]), colors, forced)
            before, run = color_of[dart], []
        after = color_of[cell[start]] if color_of else blocks[0].color
        _add_run(run, (before, after), colors, forced)
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
