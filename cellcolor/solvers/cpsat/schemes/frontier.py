"""Optimal schemes by dynamic programming over the cells: counted exactly, listed, drawn at random.

The cells are painted one after the other. Two partial paintings that look alike from the cells to
come have the same completions, and are one **front**: what the darts towards unpainted cells have
decided, which of them are connected, what zeros among them can show, and how many segments are
complete. The fronts after each cell form a layered graph whose paths are the schemes, each one
once. Counting paths backwards counts the schemes, and leads every walk to the end of one.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import cache
from itertools import combinations, product
from random import Random
from typing import NamedTuple

from cellcolor.deadline import Deadline
from cellcolor.errors import TooLarge
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph
from cellcolor.solvers.cpsat.model.painting import Block, Painting
from cellcolor.solvers.cpsat.schemes.scheme_model import unconnected_differ
from cellcolor.union_find import UnionFind

MOST_STEPS = 1_000_000
MOST_DARTS = 200  # of one cell, whose divisions are listed by recursion over its darts
"""Steps from front to front that are kept; they take some hundred megabytes."""

Blocks = tuple[tuple[int, tuple[int, ...]], ...]
"""The sub-cells of a cell: color and darts in state 1 of each."""

Clause = tuple[int, ...]
"""One or two literals, dart + 1: the dart, a zero, shows the later of its two colors; negative: the
earlier one. In ascending order."""

Shown = tuple[tuple[int, int], ...]
"""The earlier and the later color of each zero of a front, -1 for one that cannot be joined."""


class _Front(NamedTuple):
    """What the cells to come see of a partial painting.

    Attributes:
        closed: segments that are complete.
        joined: color and segment of each dart of the front, (-1, -1) for a zero.
        shown: what the zeros can show: in one of these ways, colors and clauses.
    """

    closed: int
    joined: tuple[tuple[int, int], ...]
    shown: frozenset[tuple[Shown, frozenset[Clause]]]


_EMPTY = _Front(0, (), frozenset({((), frozenset())}))


class Frontier:
    """All schemes of a graph with a number of segments.

    Args:
        graph: the dart graph, loops apart.
        regions: color and cells of each color region.
        segments: of the schemes, the fewest there are.
        can_be_drawn: whether the blocks of a cell with several loops do not cross.
        deadline: when to stop.
        given: cells that are divided in one way only.

    Attributes:
        count: of all schemes.

    Raises:
        TooLarge: there are too many fronts, or darts of one cell.
        OutOfTime: the deadline came first.
    """

    def __init__(
        self,
        graph: DartGraph,
        regions: Sequence[tuple[int, frozenset[int]]],
        segments: int,
        can_be_drawn: Callable[[int, Sequence[Block]], bool],
        deadline: Deadline,
        given: Mapping[int, Blocks] | None = None,
    ) -> None:
        self._graph, self._segments, self._deadline = graph, segments, deadline
        self._given = given or {}
        # The color of each dart of given cells, -1 for a zero.
        self._decided = {
            dart: next((color for color, own in blocks if dart in own), -1)
            for cell, blocks in self._given.items()
            for dart in graph.lists[cell]
        }
        if max(map(len, graph.lists), default=0) > MOST_DARTS:
            raise TooLarge("a cell has too many darts for its divisions to be counted")
        self._can_be_drawn = can_be_drawn
        self._region = {(cell, c): n for n, (c, cells) in enumerate(regions) for cell in cells}
        self._order = _order(graph, self._given)
        self._fronts = self._open_darts()
        self._needed = cache(self._needed_now)
        self._local = cache(self._local_now)
        self._resolved = cache(_resolved)
        # Of each layer: the steps from each front, as (blocks of the cell, number of the next one).
        self._steps: list[list[list[tuple[Blocks, int]]]] = []
        self._build()
        self._counts: list[list[int]] = [[]] * len(self._steps) + [[1] * self._ends]
        for depth in reversed(range(len(self._steps))):
            after = self._counts[depth + 1]
            self._counts[depth] = [
                sum(after[end] for _, end in steps) for steps in self._steps[depth]
            ]
        self.count = self._counts[0][0] if self._counts[0] else 0

    def paintings(self) -> Iterator[Painting]:
        """Every scheme, once."""
        if not self.count:
            return
        trail = [iter(self._steps[0][0])]
        chosen: list[Blocks] = []
        while trail:
            step = next(trail[-1], None)
            if step is None:
                trail.pop()
                if chosen:
                    chosen.pop()
                continue
            blocks, end = step
            depth = len(trail)
            if not self._counts[depth][end]:
                continue
            chosen.append(blocks)
            if depth < len(self._steps):
                trail.append(iter(self._steps[depth][end]))
            else:
                yield self._painting(chosen)
                chosen.pop()

    def drawn(self, rng: Random) -> Painting:
        """One scheme, each as likely as any other. There has to be one."""
        chosen: list[Blocks] = []
        at = 0
        for depth, layer in enumerate(self._steps):
            place = rng.randrange(self._counts[depth][at])
            for blocks, end in layer[at]:
                place -= self._counts[depth + 1][end]
                if place < 0:
                    chosen.append(blocks)
                    at = end
                    break
        return self._painting(chosen)

    def _painting(self, chosen: Sequence[Blocks]) -> Painting:
        of_cell = dict(zip(self._order, chosen, strict=True))
        return [
            [Block(color, set(darts)) for color, darts in of_cell[cell]]
            for cell in range(len(self._order))
        ]

    def _open_darts(self) -> list[tuple[int, ...]]:
        """After each number of cells, the painted darts whose twin is not painted yet."""
        place = {cell: number for number, cell in enumerate(self._order)}
        when = [place[dart.cell] for dart in self._graph.darts]
        return [
            tuple(
                number
                for number, dart in enumerate(self._graph.darts)
                if when[number] < depth <= when[dart.twin]
            )
            for depth in range(len(self._order) + 1)
        ]

    def _build(self) -> None:
        kept = 0
        layer: dict[_Front, int] = {_EMPTY: 0}
        for depth, cell in enumerate(self._order):
            following: dict[_Front, int] = {}
            steps: list[list[tuple[Blocks, int]]] = []
            for front in layer:
                self._deadline.check()
                own = []
                for blocks, after in self._onward(depth, cell, front):
                    own.append((blocks, following.setdefault(after, len(following))))
                steps.append(own)
                kept += len(own)
                if kept > MOST_STEPS:
                    raise TooLarge("the schemes have too many fronts to be counted")
            self._steps.append(steps)
            layer = following
        self._ends = len(layer)

    def _onward(self, depth: int, cell: int, front: _Front) -> Iterator[tuple[Blocks, _Front]]:
        """Paint the next cell in every way; where that leads."""
        graph = self._graph
        open_now, open_then = self._fronts[depth], self._fronts[depth + 1]
        joined = dict(zip(open_now, front.joined, strict=True))
        darts = graph.lists[cell]
        decided = self._decided | {dart: color for dart, (color, _) in joined.items()}
        known = tuple(decided.get(graph.darts[dart].twin) for dart in darts)
        for blocks, gaps in self._local(cell, known):
            segment: UnionFind[int] = UnionFind(range(-len(blocks), len(open_now)))
            holder = {dart: number for number, (_, own) in enumerate(blocks) for dart in own}
            for dart, number in holder.items():
                twin = graph.darts[dart].twin
                if twin in joined:
                    segment.union(-1 - number, joined[twin][1])
                elif twin in holder:
                    segment.union(-1 - number, -1 - holder[twin])
            names: dict[int, int] = {}
            then = []
            held = 0
            for dart in open_then:
                if dart in holder:
                    color, root = blocks[holder[dart]][0], segment[-1 - holder[dart]]
                elif dart in joined and joined[dart][0] >= 0:
                    color, root = joined[dart][0], segment[joined[dart][1]]
                else:
                    then.append((-1, -1))
                    continue
                then.append((color, names.setdefault(root, len(names))))
                held |= 1 << self._region[graph.darts[dart].cell, color]
            before = {own for color, own in front.joined if color >= 0}
            roots = {segment[s] for s in before} | {segment[-1 - n] for n in range(len(blocks))}
            closed = front.closed + len(roots - names.keys())
            if closed + self._needed(depth + 1, held) > self._segments:
                continue
            shown = self._shown(front, joined, open_now, open_then, cell, gaps)
            if shown and (depth + 1 < len(self._order) or closed == self._segments):
                yield blocks, _Front(closed, tuple(then), shown)

    def _shown(
        self,
        front: _Front,
        joined: Mapping[int, tuple[int, int]],
        open_now: Sequence[int],
        open_then: Sequence[int],
        cell: int,
        gaps: Sequence[Mapping[int, tuple[int, int]]],
    ) -> frozenset[tuple[Shown, frozenset[Clause]]]:
        """What the zeros of the next front can show; nothing if two sides have to show one color.

        ``gaps`` has each way to show colors in the cell: of each zero the earlier and later one.
        """
        darts = self._graph.darts
        zeros_now = [dart for dart in open_now if joined[dart][0] < 0]
        found = set()
        for colors_now, clauses in front.shown:
            old = dict(zip(zeros_now, colors_now, strict=True))
            for new in gaps:
                shows = old | dict(new)
                more = set(clauses)
                for dart, after in zip(new, list(new)[1:], strict=False):
                    if dart + 1 == after and new[dart] == new[after]:
                        more.add((-dart - 1, after + 1))
                for loop in self._graph.loops[cell]:
                    if len(loop) > 1 and loop[0] in new and loop[-1] in new:
                        ends = loop[-1], loop[0]
                        if new[ends[0]] == new[ends[1]] and any(d not in new for d in loop):
                            more.add(tuple(sorted((-ends[0] - 1, ends[1] + 1))))
                for dart in new:
                    twin = darts[dart].twin
                    if twin in shows and (twin not in new or dart < twin):
                        for late, there in product((0, 1), (0, 1)):
                            color = shows[dart][late]
                            if color == shows[twin][there] and color in darts[dart].colors:
                                literals = {
                                    (-number - 1 if side else number + 1)
                                    for number, side in ((dart, late), (twin, there))
                                }
                                more.add(tuple(sorted(literals)))
                for dart, (early, later) in shows.items():
                    if early == later:
                        more.add((dart + 1,))
                kept = [dart for dart in open_then if dart in shows]
                seen = [[c if c in darts[d].colors else -1 for c in shows[d]] for d in kept]
                free = frozenset(d for d, (one, two) in zip(kept, seen, strict=True) if one != two)
                left = self._resolved(frozenset(more), free)
                if left is not None:
                    found.add((tuple((one, two) for one, two in seen), left))
        return frozenset(found)

    def _needed_now(self, depth: int, held: int) -> int:
        """As many regions, or more, include those held and touch every cell to come."""
        cells = [
            sum(1 << self._region[cell, c] for c in self._graph.colors[cell])
            for cell in self._order[depth:]
        ]
        wanted = frozenset(regions for regions in cells if not regions & held)
        return held.bit_count() + _apart(wanted)

    def _local_now(
        self, cell: int, known: tuple[int | None, ...]
    ) -> list[tuple[Blocks, list[dict[int, tuple[int, int]]]]]:
        """Every way to divide a cell, with the ways in which its zeros can show colors.

        Args:
            cell: the cell.
            known: of each dart the color in which its edge is joined, -1 for a zero, None if
                nothing is decided yet.
        """
        loops = self._graph.loops[cell]
        found = []
        if cell in self._given:
            darts = self._graph.lists[cell]
            agrees = all(k in (None, self._decided[d]) for k, d in zip(known, darts, strict=True))
            divisions = iter([self._given[cell]] if agrees else [])
        elif len(loops) < 2:
            divisions = self._divisions(cell, known)
        else:
            divisions = self._divisions_of_loops(cell, known)
        for blocks in divisions:
            self._deadline.check()
            colors = {dart: color for color, own in blocks for dart in own}
            choices = []
            for loop in loops:
                ones = [dart for dart in loop if dart in colors]
                if ones:
                    choices.append([_gaps(loop, colors)])
                else:
                    own = sorted({color for color, _ in blocks})
                    choices.append([dict.fromkeys(loop, (c, c)) for c in own])
            gaps = []
            for choice in product(*choices):
                gap: dict[int, tuple[int, int]] = {}
                for one in choice:
                    gap |= one
                gaps.append(gap)
            found.append((blocks, gaps))
        return found

    def _options(self, dart: int, known: int | None) -> list[int]:
        """The colors in which a dart can be in state 1, -1 for state 0."""
        return [-1, *sorted(self._graph.darts[dart].colors)] if known is None else [known]

    def _divisions(self, cell: int, known: tuple[int | None, ...]) -> Iterator[Blocks]:
        """The divisions of a cell with one loop, by rules 2 to 4, dart by dart.

        The sub-cells that can go on are a stack: a dart in state 1 goes on with one of them, which
        completes those above it, or begins a new one.
        """
        darts = self._graph.lists[cell]
        at = {dart: place for place, dart in enumerate(darts)}
        partner = [at.get(self._graph.darts[dart].twin, -1) for dart in darts]
        colors: list[int] = []
        members: list[list[int]] = []
        state: list[int] = []

        def rec(stack: tuple[int, ...], last: int, first: int) -> Iterator[Blocks]:
            place = len(state)
            if place == len(darts):
                if not colors:
                    yield from (((color, ()),) for color in sorted(self._graph.colors[cell]))
                elif len(colors) == 1 or (
                    min(map(len, members)) > 1 and (last == first or colors[last] != colors[first])
                ):
                    yield tuple((c, tuple(m)) for c, m in zip(colors, members, strict=True))
                return
            self._deadline.check()
            options = self._options(darts[place], known[place])
            if 0 <= partner[place] < place:
                options = [state[partner[place]]]
            for color in options:
                state.append(color)
                if color < 0:
                    yield from rec(stack, last, first)
                else:
                    for level in reversed(range(len(stack))):
                        block = stack[level]
                        same = block == last
                        if colors[block] == color and (same or colors[last] != color):
                            members[block].append(darts[place])
                            yield from rec(stack[: level + 1], block, first)
                            members[block].pop()
                        if len(members[block]) == 1:
                            break  # completed with a single dart it would be superfluous
                    if last < 0 or colors[last] != color:
                        new = len(colors)
                        colors.append(color)
                        members.append([darts[place]])
                        yield from rec((*stack, new), new, first if first >= 0 else new)
                        colors.pop()
                        members.pop()
                state.pop()

        yield from rec((), -1, -1)

    def _divisions_of_loops(self, cell: int, known: tuple[int | None, ...]) -> Iterator[Blocks]:
        """The divisions of a cell with several loops: all partitions, tested one by one."""
        graph, darts, loops = self._graph, self._graph.lists[cell], self._graph.loops[cell]
        at = {dart: place for place, dart in enumerate(darts)}
        twins = [
            (place, other)
            for place, dart in enumerate(darts)
            if (other := at.get(graph.darts[dart].twin, -1)) > place
        ]
        options = [self._options(dart, known[place]) for place, dart in enumerate(darts)]
        for states in product(*options):
            self._deadline.check()
            if any(states[one] != states[other] for one, other in twins):
                continue
            ones = {dart: c for dart, c in zip(darts, states, strict=True) if c >= 0}
            if not ones:
                yield from (((color, ()),) for color in sorted(graph.colors[cell]))
                continue
            for parts in _partitions(ones):
                blocks = [Block(ones[part[0]], set(part)) for part in parts]
                holder = {dart: number for number, part in enumerate(parts) for dart in part}
                if (
                    (len(parts) == 1 or min(map(len, parts)) > 1)
                    and all(_successive(loop, ones, holder) for loop in loops)
                    and unconnected_differ(graph, _alone(graph, cell, blocks))
                    and self._can_be_drawn(cell, blocks)
                ):
                    yield tuple((ones[part[0]], tuple(part)) for part in parts)


def _alone(graph: DartGraph, cell: int, blocks: list[Block]) -> Painting:
    """A painting in which all other cells are whole."""
    return [blocks if number == cell else [Block(0, set())] for number in range(len(graph.loops))]


def _order(graph: DartGraph, given: Collection[int]) -> list[int]:
    """The given cells, and then the others in an order with few open darts."""
    order = sorted(given)
    left = set(range(len(graph.lists))).difference(order)
    reached: set[int] = set()
    while left:

        def weight(cell: int) -> tuple[int, int, int]:
            around = [graph.darts[graph.darts[dart].twin].cell for dart in graph.lists[cell]]
            free = sum(other in left and other != cell for other in around)
            return free, 2 * free - len(around), cell

        chosen = min(reached & left or left, key=weight)
        left.discard(chosen)
        order.append(chosen)
        reached |= {graph.darts[graph.darts[dart].twin].cell for dart in graph.lists[chosen]}
    return order


def _gaps(loop: Sequence[int], colors: Mapping[int, int]) -> dict[int, tuple[int, int]]:
    """Of each zero of a loop with darts in state 1 the colors before and after it."""
    start = next(place for place, dart in enumerate(loop) if dart in colors)
    turned = [*loop[start:], *loop[:start]]
    before = colors[turned[0]]
    waiting: list[int] = []
    found: dict[int, tuple[int, int]] = {}
    for dart in [*turned[1:], turned[0]]:
        if dart in colors:
            found |= dict.fromkeys(waiting, (before, colors[dart]))
            before, waiting = colors[dart], []
        else:
            waiting.append(dart)
    return {dart: found[dart] for dart in loop if dart in found}


def _successive(loop: Sequence[int], ones: Mapping[int, int], holder: Mapping[int, int]) -> bool:
    """Rule 4, and no two blocks that cross on the loop."""
    own = [dart for dart in loop if dart in ones]
    for one, other in zip(own, own[1:] + own[:1], strict=True):
        if holder[one] != holder[other] and ones[one] == ones[other]:
            return False
    return not any(
        holder[a] == holder[c] != holder[b] == holder[d] for a, b, c, d in combinations(own, 4)
    )


def _partitions(ones: Mapping[int, int]) -> Iterator[list[list[int]]]:
    """The ways to put darts of one color into blocks."""
    darts = list(ones)

    def rec(number: int, parts: list[list[int]]) -> Iterator[list[list[int]]]:
        if number == len(darts):
            yield [list(part) for part in parts]
            return
        dart = darts[number]
        for part in parts:
            if ones[part[0]] == ones[dart]:
                part.append(dart)
                yield from rec(number + 1, parts)
                part.pop()
        parts.append([dart])
        yield from rec(number + 1, parts)
        parts.pop()

    yield from rec(0, [])


def _resolved(clauses: frozenset[Clause], kept: frozenset[int]) -> frozenset[Clause] | None:
    """What clauses of two literals say of some darts alone; None if they contradict each other.

    All resolvents are added: then those of the darts are just what is implied for them.
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
    alone = {clause[0] for clause in found if len(clause) == 1}
    return frozenset(
        clause
        for clause in found
        if all(abs(x) - 1 in kept for x in clause)
        and (len(clause) == 1 or alone.isdisjoint(clause))
    )


def _apart(sets: frozenset[int]) -> int:
    """How many of some bit sets have no bit in common, chosen greedily."""
    taken = count = 0
    for own in sorted(sets, key=lambda own: (own.bit_count(), own)):
        if not own & taken:
            taken |= own
            count += 1
    return count
