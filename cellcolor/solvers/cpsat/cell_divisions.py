"""All divisions of one cell that keep rules 2 to 4 of a scheme (docs/semantics.md, section 3)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations, product

from cellcolor.deadline import Deadline
from cellcolor.solvers.cpsat.dart_graph import DartGraph
from cellcolor.solvers.cpsat.painting import Block
from cellcolor.union_find import UnionFind

ZERO = -1
"""Stands in place of a color for a dart in state 0."""

Blocks = tuple[tuple[int, tuple[int, ...]], ...]
"""The sub-cells of a cell: the color of each, and its darts in state 1."""


def divisions(
    graph: DartGraph,
    cell: int,
    known: Sequence[int | None],
    can_be_drawn: Callable[[int, Sequence[Block]], bool],
    deadline: Deadline,
) -> Iterator[Blocks]:
    """Every division of a cell in which its darts have the states that are known.

    Args:
        graph: the dart graph, loops apart.
        known: of each of its darts the color in which its edge is joined, ``ZERO`` if it is in
            state 0, None if that is open.
        can_be_drawn: whether blocks of a cell with several loops do not cross.
    """
    darts = graph.lists[cell]
    options = [
        [ZERO, *sorted(graph.darts[dart].colors)] if color is None else [color]
        for dart, color in zip(darts, known, strict=True)
    ]
    place_of = {dart: place for place, dart in enumerate(darts)}
    twins = [place_of.get(graph.darts[dart].twin) for dart in darts]
    one_loop = len(graph.loops[cell]) < 2
    listed = _of_one_loop if one_loop else _of_several_loops
    for blocks in listed(darts, options, twins, deadline):
        if not blocks:
            yield from (((color, ()),) for color in sorted(graph.colors[cell]))
        elif one_loop or _kept_between_loops(graph.loops[cell], blocks):
            made = [Block(color, set(own)) for color, own in blocks]
            if one_loop or can_be_drawn(cell, made):
                yield blocks


def _of_one_loop(
    darts: Sequence[int],
    options: Sequence[Sequence[int]],
    twins: Sequence[int | None],
    deadline: Deadline,
) -> Iterator[Blocks]:
    """Divisions of a cell with one loop, decided dart by dart; no blocks if all are in state 0.

    As blocks do not cross, those that can still get darts form a stack. A dart in state 1 goes to
    one of them, which completes the blocks above it, or begins a new block.
    """
    states: list[int] = []
    colors: list[int] = []
    members: list[list[int]] = []

    def decide(stack: tuple[int, ...], last: int) -> Iterator[Blocks]:
        """Decide the next dart; ``last`` is the block of the last one in state 1, -1 for none."""
        place = len(states)
        if place == len(darts):
            if len(members) < 2 or (
                min(map(len, members)) > 1 and (last == 0 or colors[last] != colors[0])
            ):
                yield tuple((c, tuple(m)) for c, m in zip(colors, members, strict=True))
            return
        deadline.check()
        twin = twins[place]
        for color in options[place] if twin is None or twin > place else [states[twin]]:
            states.append(color)
            if color == ZERO:
                yield from decide(stack, last)
            else:
                for level in reversed(range(len(stack))):
                    block = stack[level]
                    if colors[block] == color and (block == last or colors[last] != color):
                        members[block].append(darts[place])
                        yield from decide(stack[: level + 1], block)
                        members[block].pop()
                    if len(members[block]) == 1:
                        break  # no block beside others is complete with a single dart
                if last < 0 or colors[last] != color:
                    colors.append(color)
                    members.append([darts[place]])
                    yield from decide((*stack, len(colors) - 1), len(colors) - 1)
                    colors.pop()
                    members.pop()
            states.pop()

    return decide((), -1)


def _of_several_loops(
    darts: Sequence[int],
    options: Sequence[Sequence[int]],
    twins: Sequence[int | None],
    deadline: Deadline,
) -> Iterator[Blocks]:
    """All partitions of darts in state 1 by color that keep the sizes of rule 2."""
    for states in product(*options):
        deadline.check()
        if any(t is not None and states[t] != own for own, t in zip(states, twins, strict=True)):
            continue
        ones = {dart: c for dart, c in zip(darts, states, strict=True) if c != ZERO}
        for parts in _partitions(ones):
            if len(parts) < 2 or min(map(len, parts)) > 1:
                yield tuple((ones[part[0]], tuple(part)) for part in parts)


def _partitions(ones: Mapping[int, int]) -> Iterator[list[list[int]]]:
    """The ways to put darts of one color into blocks."""
    darts = list(ones)

    def decide(number: int, parts: list[list[int]]) -> Iterator[list[list[int]]]:
        if number == len(darts):
            yield parts
            return
        dart = darts[number]
        for part in parts:
            if ones[part[0]] == ones[dart]:
                part.append(dart)
                yield from decide(number + 1, parts)
                part.pop()
        parts.append([dart])
        yield from decide(number + 1, parts)
        parts.pop()

    return decide(0, [])


def _kept_between_loops(loops: Sequence[Sequence[int]], blocks: Blocks) -> bool:
    """Rule 4 on each loop and between loops, and no two blocks that cross on a loop."""
    block_of = {dart: number for number, (_, own) in enumerate(blocks) for dart in own}
    for loop in loops:
        held = [block_of[dart] for dart in loop if dart in block_of]
        for one, other in zip(held, held[1:] + held[:1], strict=True):
            if one != other and blocks[one][0] == blocks[other][0]:
                return False
        if any(a == c != b == d for a, b, c, d in combinations(held, 4)):
            return False
    # Sub-cells that no chain of loops and sub-cells connects differ in color.
    connected: UnionFind[int] = UnionFind(range(len(blocks)))
    for loop in loops:
        connected.union(*(block_of[dart] for dart in loop if dart in block_of))
    return not any(
        blocks[one][0] == blocks[other][0] and connected[one] != connected[other]
        for one, other in combinations(range(len(blocks)), 2)
    )
