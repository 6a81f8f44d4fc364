"""Exact minima of parts whose shape allows a recursion (docs/bounds.md, with the proofs).

- **Forests**: no cycle of cells and live edges, one live loop a cell. A recursion over the tree
  asks of each subtree how many segments it needs, and in which colors joining it saves one.
- **Wheels**: one hub, and around it cells whose other edges lead to their neighbors there. What
  such an edge joins the hub can join as well, so that a wheel is solved as the star within it.
- **Hubs of one-colored neighbors**: every cell with several colors has only neighbors with one. A
  **leaf set** is such a neighbor, or several that are connected in any case. Hub after hub is
  added; all that is remembered is which leaf sets that later hubs share are connected (a frontier,
  or transfer matrix, method). Of the ways to divide a hub that connect the same shared leaf sets
  only the best is kept.

All hand back a division with the minimum, by traceback. They hold where each live edge is crossed
once at most: always in the search space ``paper``.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.grouping import MOST_ENTRIES, best_grouping, recursion_size
from cellcolor.solvers.cpsat.dart_graph import DartGraph
from cellcolor.solvers.cpsat.painting import Block, Painting, canonical
from cellcolor.union_find import UnionFind

MOST_WAYS = 2_000
"""Ways to divide a range of darts; a hub with more of them is left to other methods."""

Groups = frozenset[frozenset[int]]
"""Groups of shared leaf sets that are connected, each of two and more."""

Areas = tuple[tuple[int, tuple[int, ...]], ...]
"""Areas of a hub, each with its color and its darts."""

Ways = dict[Groups, tuple[int, Areas]]
"""By the groups that a way connects: the most links that it can have besides, and its areas. These
links are the ones to leaf sets of the hub's own, and between those where an area has no others."""

MOST_STATES = 20_000
"""The most states of the frontier; beyond that the hubs are left to other methods."""

_Loops = Sequence[Sequence[int]]
"""The live darts of each cell."""

_Joinable = dict[int, frozenset[int]]
"""The joinable colors of each dart."""

Exact = tuple[int, dict[int, Areas]]
"""A minimum, and the areas of a division that has it: of cells that are divided or joined, each
with its color and the darts across which it is joined. Other cells are joined from outside."""


def exact_minimum(instance: Instance, deadline: Deadline) -> Exact | None:
    """The minimum of a forest, a wheel, or hubs with one-colored neighbors; None for other parts.

    No division that crosses each live edge once at most has fewer segments.
    """
    if instance.most_live_loops > 1:
        return None
    loops: _Loops = [own[0] if own else () for own in instance.live_loops]
    joinable = {dart: frozenset(instance.joinable(dart)) for loop in loops for dart in loop}
    # Edges connect all cells, so they make a tree if there are fewer of them than cells.
    star = loops if len(joinable) < 2 * len(loops) else _without_rim(instance, loops, joinable)
    if star is not None:
        return _tree_minimum(instance, star, joinable, deadline)
    return _hubs_minimum(instance, loops, joinable, deadline)


def painting_of_areas(graph: DartGraph, areas: dict[int, Areas]) -> Painting:
    """The division, canonical, on a graph with a strand of each live edge."""
    joined = {-dart for own in areas.values() for _, darts in own for dart in darts}
    painting = []
    for cell, colors in enumerate(graph.colors):
        edges = [graph.darts[dart].name[0] for dart in graph.lists[cell]]
        own = areas.get(cell) or ((min(colors), tuple(dart for dart in edges if dart in joined)),)
        painting.append([Block(c, {graph.number_of[d, 1] for d in darts}) for c, darts in own])
    return canonical(graph, painting)


def _without_rim(instance: Instance, loops: _Loops, joinable: _Joinable) -> _Loops | None:
    """The loops of a wheel without its rim; None if this is no wheel."""
    hub = max(range(len(loops)), key=lambda cell: len(loops[cell]))
    spokes, count = loops[hub], len(loops[hub])
    place = {instance.across(dart): at for at, dart in enumerate(spokes)}
    if len(place) < count or len(place) < len(loops) - 1 or hub in place:
        return None
    for cell, at in place.items():
        rim = [dart for dart in loops[cell] if dart != -spokes[at]]
        if len(rim) > 2:
            return None
        for dart in rim:
            other = place[instance.across(dart)]
            own = joinable[spokes[at]] & joinable[spokes[other]]
            if (other - at) % count not in (1, count - 1) or not joinable[dart] <= own:
                return None
    return [loops[hub] if cell == hub else (-spokes[place[cell]],) for cell in range(len(loops))]


def _tree_minimum(
    instance: Instance, loops: _Loops, joinable: _Joinable, deadline: Deadline
) -> Exact | None:
    """The minimum where cells and live edges make a tree: from the leaves to cell 0, and back."""
    sizes = (recursion_size([joinable[d] for d in own]) for own in loops)
    if max(sizes) > MOST_ENTRIES:
        return None
    order, up = [0], {0: 0}
    for cell in order:
        for dart in loops[cell]:
            if dart != up[cell]:
                beyond = instance.across(dart)
                up[beyond] = -dart
                order.append(beyond)
    # Of each dart that leads down: the fewest segments of what lies there, and the colors in
    # which joining it to a segment that is counted elsewhere saves one of them.
    fewest: dict[int, int] = {}
    saving: dict[int, frozenset[int]] = {}
    for cell in reversed(order):
        deadline.check()
        dart, darts = up[cell], _down(loops[cell], up[cell])
        below = sum(fewest[d] for d in darts)
        sets = [saving[d] for d in darts if saving[d]]
        least = below - len(sets) + max(1, len(best_grouping(sets)))
        if cell == 0:
            break
        fewest[-dart] = least
        saving[-dart] = frozenset(
            color
            for color in joinable[dart]
            if below - len(sets) + len(best_grouping([frozenset((color,)), *sets])) == least
        )
    areas: dict[int, Areas] = {}
    joined: dict[int, int] = {}
    for cell in order:
        deadline.check()
        darts = [d for d in _down(loops[cell], up[cell]) if saving[d]]
        sets = [saving[d] for d in darts]
        if cell in joined:
            darts, sets = [up[cell], *darts], [frozenset((joined[cell],)), *sets]
        groups = best_grouping(sets)
        areas[cell] = tuple((color, tuple(darts[place] for place in own)) for color, own in groups)
        for color, own in areas[cell]:
            joined |= {instance.across(dart): color for dart in own if dart != up[cell]}
    return least, areas


def _down(loop: Sequence[int], up: int) -> Sequence[int]:
    """The darts of a cell in cyclic order from the one that leads up, if any, without that."""
    at = loop.index(up) if up else len(loop)
    return (*loop[at + 1 :], *loop[:at])


_State = tuple[int, ...]
"""A label for each leaf set on the frontier; connected ones have the same."""

_Step = dict[_State, tuple[_State, Areas]]
"""For each state after a hub: the state before it, and the areas of the hub."""


def _hubs_minimum(
    instance: Instance, loops: _Loops, joinable: _Joinable, deadline: Deadline
) -> Exact | None:
    """Add hub after hub; a state says which leaf sets on the frontier are connected."""
    one_colored = [len(cell.colors) == 1 for cell in instance.cells]
    leaf_sets = UnionFind(cell for cell, one in enumerate(one_colored) if one)
    for edge in instance.live_edges:
        left, right = instance.edge(edge).left, instance.edge(edge).right
        if left == right or not (one_colored[left] or one_colored[right]):
            return None
        if one_colored[left] and one_colored[right]:
            leaf_sets.union(left, right)
    left_hubs = {
        hub: [leaf_sets[instance.across(dart)] for dart in loops[hub]]
        for hub, one in enumerate(one_colored)
        if not one
    }
    users = Counter(leaf_set for own in left_hubs.values() for leaf_set in set(own))
    frontier: list[int] = []
    states: dict[_State, int] = {(): 0}  # with the most connections that lead to each
    steps: list[tuple[int, _Step]] = []
    while left_hubs:
        deadline.check()
        # The hub that leaves the shortest frontier comes next.
        widths = {
            hub: sum(users[p] > (p in own) for p in {*frontier, *own})
            for hub, own in left_hubs.items()
        }
        hub = min(widths, key=lambda hub: (widths[hub], hub))
        own = left_hubs.pop(hub)
        shared = {p for p in own if users[p] > 1 or p in frontier or own.count(p) > 1}
        colors = [min(joinable[dart]) for dart in loops[hub]]
        ways = hub_ways(loops[hub], colors, own, shared, deadline)
        if ways is None or len(states) * len(ways) > 100 * MOST_STATES:
            return None
        places = [*frontier, *(p for p in dict.fromkeys(own) if p in shared - set(frontier))]
        users.subtract(set(own))
        kept = [place for place, leaf_set in enumerate(places) if users[leaf_set]]
        states, step = _with_hub(states, ways, places, kept, deadline)
        if len(states) > MOST_STATES:
            return None
        frontier = [places[place] for place in kept]
        steps.append((hub, step))
    areas: dict[int, Areas] = {}
    last: _State = ()
    for hub, step in reversed(steps):
        last, areas[hub] = step[last]
    return len(leaf_sets.sets()) - states[()], areas


def _with_hub(
    states: dict[_State, int],
    ways: Ways,
    places: Sequence[int],
    kept: Sequence[int],
    deadline: Deadline,
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
        deadline.check()
        labels = [*state, *range(len(places), 2 * len(places) - len(state))]
        for links, areas, groups in placed:
            after, joined = _united(labels, groups)
            number: dict[int, int] = {}  # labels are numbered as they come
            key = tuple(number.setdefault(after[place], len(number)) for place in kept)
            if value + links + joined > found.get(key, -1):
                found[key] = value + links + joined
                step[key] = state, areas
    return found, step


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


def hub_ways(
    darts: Sequence[int],
    colors: Sequence[int],
    leaf_sets: Sequence[int],
    shared: set[int],
    deadline: Deadline,
) -> Ways | None:
    """All undominated ways to divide a hub, by a recursion over ranges of its darts.

    Args:
        darts: of the hub, in cyclic order, each with one color, and a leaf set across it.
        shared: leaf sets of other hubs as well, or met twice by this one.

    Returns:
        None if there are too many.
    """
    count = len(darts)
    own_shared = [frozenset((leaf_set,)) & shared for leaf_set in leaf_sets]
    # Of the darts from the one number to before the other.
    ways: dict[tuple[int, int], Ways] = {}
    for first in reversed(range(count + 1)):
        ways[first, first] = {frozenset(): (0, ())}
        for end in range(first + 1, count + 1):
            deadline.check()
            found = _of_range(darts, colors, own_shared, ways, first, end)
            if found is None:
                return None
            ways[first, end] = found
    return ways[0, count]


def _of_range(
    darts: Sequence[int],
    colors: Sequence[int],
    shared: Sequence[frozenset[int]],
    ways: dict[tuple[int, int], Ways],
    first: int,
    end: int,
) -> Ways | None:
    """The ways of a range from those of shorter ones.

    The area of the range's first dart takes in further darts of its color. That leaves a shorter
    range between each two of them, and one behind the last.
    """
    found: Ways = {}
    # Open areas by their last dart, the groups between their darts, and their own shared leaf sets:
    # links, the areas between their darts, their darts.
    open_: dict[tuple[int, Groups, frozenset[int]], tuple[int, Areas, tuple[int, ...]]]
    open_ = {(first, frozenset(), shared[first]): (0, (), (first,))}
    for last in range(first, end):
        behind = ways[last + 1, end]
        further = [dart for dart in range(last + 1, end) if colors[dart] == colors[first]]
        for (at, groups, own), (links, areas, members) in list(open_.items()):
            if at != last:
                continue
            area = (colors[first], tuple(darts[member] for member in members))
            closed = groups | {own} if len(own) > 1 else groups
            for others, (more, beyond) in behind.items():
                if links + more > found.get(closed | others, (-1,))[0]:
                    found[closed | others] = links + more, (*areas, area, *beyond)
            for dart in further:
                # A leaf set of its own is a link; a shared one is counted as it connects.
                link = int(not shared[dart] or not own)
                for others, (more, between) in ways[last + 1, dart].items():
                    key = dart, groups | others, own | shared[dart]
                    if links + more + link > open_.get(key, (-1,))[0]:
                        total = links + more + link
                        open_[key] = total, (*areas, *between), (*members, dart)
        if len(open_) > 10 * MOST_WAYS:
            return None
    best = _undominated(found)
    return best if len(best) <= MOST_WAYS else None


def _undominated(found: Ways) -> Ways:
    """Without dominated ways: another one connects the same leaf sets with no fewer links."""
    kept: Ways = {}
    order = sorted(found, key=lambda groups: (-found[groups][0], -sum(map(len, groups))))
    for groups in order:
        if not any(
            all(any(group <= its for its in other) for group in groups)
            for other, (links, _) in kept.items()
            if links >= found[groups][0]
        ):
            kept[groups] = found[groups]
    return kept
