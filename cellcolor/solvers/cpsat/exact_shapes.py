"""Exact minima of parts whose shape allows a recursion (docs/bounds.md, with the proofs).

- **Forests**: no cycle of cells and live edges, one live loop a cell. A recursion over the tree
  asks of each subtree how many segments it needs, and in which colors joining it saves one.
- **Wheels**: one hub, and around it cells whose other edges lead to their neighbors there. What
  such an edge joins the hub can join as well, so that a wheel is solved as the star within it.
- **Hubs of one-colored neighbors**: every cell with several colors has only neighbors with one.
  Hub after hub is added; all that is remembered is which of the neighbors that later hubs share
  are connected (a frontier, or transfer matrix, method).

All hand back a division with the minimum, by traceback. They hold where each live edge is crossed
once at most: always in the search space ``paper``.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.grouping import MOST_ENTRIES, best_grouping, recursion_size
from cellcolor.solvers.cpsat.dart_graph import DartGraph
from cellcolor.solvers.cpsat.hub_ways import Areas, Ways, hub_ways
from cellcolor.solvers.cpsat.painting import Block, Painting
from cellcolor.union_find import UnionFind

MOST_STATES = 20_000
"""The most states of the frontier; beyond that the hubs are left to other methods."""


@dataclass(frozen=True, slots=True)
class Exact:
    """A minimum, with a division that has it.

    Attributes:
        segments: no division that crosses each live edge once at most has fewer.
        areas: the color of each cell's areas, and the darts across which each is joined.
    """

    segments: int
    areas: dict[int, list[tuple[int, list[int]]]]

    def painting(self, graph: DartGraph) -> Painting:
        """The division on a graph with a strand of each live edge."""
        return [
            [
                Block(color, {graph.number_of[dart, 1] for dart in darts})
                for color, darts in self.areas.get(cell) or [(min(colors), [])]
            ]
            for cell, colors in enumerate(graph.colors)
        ]


def exact_minimum(instance: Instance, deadline: Deadline) -> Exact | None:
    """The minimum of a forest or of hubs with one-colored neighbors; None for other parts."""
    if instance.most_live_loops > 1:
        return None
    read = _Part(instance, deadline)
    # Edges connect all cells, so they make a tree if there are fewer of them than cells.
    if len(read.joinable) < 2 * len(read.loops) or read.drop_rim():
        return _tree_minimum(read)
    return _Hubs(read).solve()


class _Part:
    """A part with one live loop a cell at most.

    Attributes:
        loops: of each cell.
        joinable: the colors in which each live dart can be joined.
    """

    def __init__(self, instance: Instance, deadline: Deadline) -> None:
        self.instance, self.deadline = instance, deadline
        self.colors = [frozenset(cell.colors) for cell in instance.cells]
        self.loops: list[Sequence[int]] = [
            loops[0] if loops else () for loops in instance.live_loops
        ]
        self.joinable = {
            dart: frozenset(instance.joinable(dart)) for loop in self.loops for dart in loop
        }

    def drop_rim(self) -> bool:
        """Leave out the rim of a wheel; False and nothing left out if this is none."""
        hub = max(range(len(self.loops)), key=lambda cell: len(self.loops[cell]))
        spokes, count = self.loops[hub], len(self.loops[hub])
        place = {self.instance.across(dart): at for at, dart in enumerate(spokes)}
        if len(place) < count or len(place) < len(self.loops) - 1 or hub in place:
            return False
        for cell, at in place.items():
            rim = [dart for dart in self.loops[cell] if dart != -spokes[at]]
            if len(rim) > 2:
                return False
            for dart in rim:
                other = self.instance.across(dart)
                apart = (place[other] - at) % count
                own = self.joinable[spokes[at]] & self.joinable[spokes[place[other]]]
                if apart not in (1, count - 1) or not self.joinable[dart] <= own:
                    return False
        for cell, at in place.items():
            self.loops[cell] = (-spokes[at],)
        return True


def _tree_minimum(part: _Part) -> Exact | None:
    """The minimum where cells and live edges make a tree: from the leaves to cell 0, and back."""
    sizes = (recursion_size([part.joinable[d] for d in own]) for own in part.loops)
    if max(sizes) > MOST_ENTRIES:
        return None
    order, up = [0], {0: 0}
    for cell in order:
        for dart in part.loops[cell]:
            if dart != up[cell]:
                beyond = part.instance.across(dart)
                up[beyond] = -dart
                order.append(beyond)
    # Of each dart that leads down: the fewest segments of what lies there, and the colors in
    # which joining it to a segment that is counted elsewhere saves one of them.
    fewest: dict[int, int] = {}
    saving: dict[int, frozenset[int]] = {}
    for cell in reversed(order):
        part.deadline.check()
        dart = up[cell]
        darts = _down(part.loops[cell], dart)
        below = sum(fewest[d] for d in darts)
        sets = [saving[d] for d in darts if saving[d]]
        least = below - best_grouping(sets).connections if sets else below + 1
        if cell == 0:
            break
        fewest[-dart] = least
        saving[-dart] = frozenset(
            color
            for color in part.joinable[dart]
            if below - best_grouping([frozenset((color,)), *sets]).connections == least - 1
        )
    areas: dict[int, list[tuple[int, list[int]]]] = {}
    joined: dict[int, int] = {}
    for cell in order:
        part.deadline.check()
        darts = [d for d in _down(part.loops[cell], up[cell]) if saving[d]]
        sets = [saving[d] for d in darts]
        if cell in joined:
            darts, sets = [up[cell], *darts], [frozenset((joined[cell],)), *sets]
        areas[cell] = []
        for group in best_grouping(sets).groups if sets else ():
            own = [darts[place] for place in group.darts]
            areas[cell].append((group.color, own))
            joined |= {part.instance.across(d): group.color for d in own if d != up[cell]}
    return Exact(least, areas)


def _down(loop: Sequence[int], up: int) -> Sequence[int]:
    """The darts of a cell in cyclic order from the one that leads up, without that."""
    if not up:
        return loop
    at = loop.index(up)
    return (*loop[at + 1 :], *loop[:at])


_State = tuple[int, ...]
"""A label for each leaf set on the frontier; connected ones have the same."""

_Step = dict[_State, tuple[_State, Areas]]
"""For each state after a hub: the state before it, and the areas of the hub."""


class _Hubs:
    """Hubs are the cells with several colors. Their neighbors, and what is joined among these
    neighbors whatever happens, are the **leaf sets**."""

    def __init__(self, part: _Part) -> None:
        self.instance, self.loops, self.joinable = part.instance, part.loops, part.joinable
        self.colors, self.deadline = part.colors, part.deadline
        self._hubs = [cell for cell, colors in enumerate(part.colors) if len(colors) > 1]
        self._leaf_set: dict[int, int] = {}  # across each dart of a hub

    def solve(self) -> Exact | None:
        """Add hub after hub; a state says which leaf sets on the frontier are connected."""
        leaf_sets = self._leaf_sets()
        if leaf_sets is None:
            return None
        own_of = {hub: [self._leaf_set[dart] for dart in self.loops[hub]] for hub in self._hubs}
        users = Counter(
            leaf_set for own in own_of.values() for leaf_set in set(own)
        )  # hubs to come
        frontier: list[int] = []
        states: dict[_State, int] = {(): 0}  # with the most connections that lead to each
        steps: list[_Step] = []
        order = self._order()
        for hub in order:
            self.deadline.check()
            own = own_of[hub]
            shared = {p for p in own if users[p] > 1 or p in frontier or own.count(p) > 1}
            color = [min(self.joinable[dart]) for dart in self.loops[hub]]
            ways = hub_ways(self.loops[hub], color, own, shared, self.deadline)
            if ways is None or len(states) * len(ways) > 100 * MOST_STATES:
                return None
            places = [*frontier, *(p for p in dict.fromkeys(own) if p in shared - set(frontier))]
            users.subtract(set(own))
            kept = [place for place, leaf_set in enumerate(places) if users[leaf_set]]
            states, step = self._with_hub(states, ways, places, kept)
            if len(states) > MOST_STATES:
                return None
            frontier = [places[place] for place in kept]
            steps.append(step)
        areas: dict[int, list[tuple[int, list[int]]]] = {}
        last: _State = ()
        for hub, step in zip(reversed(order), reversed(steps), strict=True):
            last, chosen = step[last]
            areas[hub] = [(color, list(darts)) for color, darts in chosen]
        self._join_leaf_sets(areas)
        return Exact(len(leaf_sets.sets()) - states[()], areas)

    def _leaf_sets(self) -> UnionFind[int] | None:
        """The leaf sets as sets of cells; None if two hubs touch, or a cell touches itself."""
        leaf_sets = UnionFind(cell for cell, colors in enumerate(self.colors) if len(colors) == 1)
        for edge in self.instance.live_edges:
            sides = self.instance.edge(edge).left, self.instance.edge(edge).right
            many = sum(len(self.colors[side]) > 1 for side in sides)
            if many == 2 or sides[0] == sides[1]:
                return None
            if not many:
                leaf_sets.union(*sides)
        self._leaf_set = {
            dart: leaf_sets[self.instance.across(dart)]
            for hub in self._hubs
            for dart in self.loops[hub]
        }
        return leaf_sets

    def _with_hub(
        self,
        states: dict[_State, int],
        ways: Ways,
        places: Sequence[int],
        kept: Sequence[int],
    ) -> tuple[dict[_State, int], _Step]:
        """The states after one more hub, and how each was reached.

        Args:
            places: the leaf sets on the frontier before, then the hub's other shared leaf sets.
            kept: those of the places that stay on the frontier.
        """
        at = {leaf_set: place for place, leaf_set in enumerate(places)}
        placed = [
            (links, areas, [[at[leaf_set] for leaf_set in group] for group in groups])
            for groups, (links, areas) in ways.items()
        ]
        found: dict[_State, int] = {}
        step: _Step = {}
        for state, value in states.items():
            self.deadline.check()
            labels = [*state, *range(len(places), 2 * len(places) - len(state))]
            for links, areas, groups in placed:
                after, joined = _united(labels, groups)
                key = _canonical([after[place] for place in kept])
                if value + links + joined > found.get(key, -1):
                    found[key] = value + links + joined
                    step[key] = state, areas
        return _best_states(found), step

    def _order(self) -> list[int]:
        """Breadth first from the hub that leaves the shortest frontiers, or as they come."""
        of: dict[int, list[int]] = {}
        for hub in self._hubs:
            for dart in self.loops[hub]:
                of.setdefault(self._leaf_set[dart], []).append(hub)
        orders = [self._hubs]
        for first in self._hubs[:20]:
            order = dict.fromkeys([first])
            for start in self._hubs:
                order.setdefault(start)
                waiting = list(order)
                for hub in waiting:
                    for dart in self.loops[hub]:
                        for other in of[self._leaf_set[dart]]:
                            if other not in order:
                                order[other] = None
                                waiting.append(other)
            orders.append(list(order))

        def widest(order: Sequence[int]) -> int:
            place = {hub: number for number, hub in enumerate(order)}
            change = [0] * (len(order) + 1)
            for own in of.values():
                places = [place[hub] for hub in own]
                change[min(places)] += 1
                change[max(places)] -= 1
            return max(sum(change[: number + 1]) for number in range(len(order)))

        return min(orders, key=widest) if self._hubs else []

    def _join_leaf_sets(self, areas: dict[int, list[tuple[int, list[int]]]]) -> None:
        """The other sides of what hubs and leaf sets join."""
        for hub in list(areas):
            for color, darts in areas[hub]:
                for dart in darts:
                    beyond = self.instance.across(dart)
                    areas.setdefault(beyond, [(color, [])])[0][1].append(-dart)
        for edge in self.instance.live_edges:
            if edge not in self._leaf_set and -edge not in self._leaf_set:
                for dart in (edge, -edge):
                    cell = self.instance.across(-dart)
                    own = areas.setdefault(cell, [(min(self.colors[cell]), [])])
                    own[0][1].append(dart)


def _united(labels: Sequence[int], groups: Iterable[Sequence[int]]) -> tuple[list[int], int]:
    """Labels with the places of each group under one, and how many labels that are fewer."""
    found, joined = list(labels), 0
    for first, *others in groups:
        for other in others:
            one, two = found[first], found[other]
            if one != two:
                found = [one if label == two else label for label in found]
                joined += 1
    return found, joined


def _canonical(labels: Iterable[int]) -> _State:
    """Labels numbered as they come."""
    number: dict[int, int] = {}
    return tuple(number.setdefault(label, len(number)) for label in labels)


def _best_states(found: dict[_State, int]) -> dict[_State, int]:
    """Without states that another one is never behind, by the best few.

    One with more connections than another has at most as many to gain later; it is behind by those
    that the other one could still make and it could not.
    """
    order = sorted(found, key=lambda state: (-found[state], len(set(state))))
    kept: dict[_State, int] = {}
    few: list[_State] = []
    for state in order:
        value = found[state]
        if any(_behind(state, other) <= found[other] - value for other in few):
            continue
        kept[state] = value
        if len(few) < 60:
            few.append(state)
    return kept


def _behind(state: _State, other: _State) -> int:
    """How many connections the first of two states lacks to be as connected as both together."""
    # By hand, as this takes most of the time. Labels of the other one are joined by the first.
    parent = list(range(len(other)))
    first: dict[int, int] = {}
    count = 0
    for one, two in zip(state, other, strict=True):
        while parent[two] != two:
            two = parent[two]
        if one not in first:
            first[one] = two
            continue
        root = first[one]
        while parent[root] != root:
            root = parent[root]
        if root != two:
            parent[two] = root
            count += 1
    return len(first) - (len(set(other)) - count)
