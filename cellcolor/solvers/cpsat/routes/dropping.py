"""Improve a division segment by segment: leave one out, and reroute all others.

The literature calls this ruin and recreate (Schrimpf, Schneider, Stamm-Wilbrandt and Dueck, "Record
breaking optimization results using the ruin and recreate principle", 2000).

The segments of a division are a segment plan that can be drawn. Without one of them it is a plan
with one segment less, if other segments can reach the cells that only this one touched. Routing
such a plan takes much less time than a model, and tries what windows cannot: segments that make
room for each other all over the surface.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterator, Sequence

from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph
from cellcolor.solvers.cpsat.model.painting import Painting, canonical, colored_segments
from cellcolor.solvers.cpsat.routes.routing import route
from cellcolor.solvers.cpsat.routes.sectors import RefinedGraph, held_nodes, refined
from cellcolor.solvers.cpsat.routes.segment_plans import PlannedSegment, SegmentPlan

ROUNDS = 20
"""Rounds of routing a plan; most that can be routed take a few."""

PATIENCE = 6
"""Rounds in succession without fewer shared nodes after which a plan is given up."""

RINGS = (1, 1, 2)
"""Rings of sectors, drawn for each plan: one leaves room enough in most cells, and is quicker."""

EXCHANGED = 0.5
"""The share of tries in which a segment in another region takes the place of the one left out."""

FRUITLESS = 3
"""Tries for each segment of a division before nothing better is expected."""


def drop_segments(
    graph: DartGraph,
    painting: Painting,
    regions: Sequence[Region],
    seed: int,
    deadline: Deadline,
    tries: float = FRUITLESS,
) -> Iterator[Painting]:
    """Better and better divisions of a graph, each with at least one segment less.

    An equally good division replaces the old one, so the search does not stay at one division.

    Args:
        painting: a canonical painting of it.
        regions: the color regions of the instance.
        seed: of the choice of segments and of routing.
        tries: for each segment, before nothing better is expected.
    """
    chance = random.Random(seed)
    region_of = {(region[0], cell): region for region in regions for cell in region[1]}
    ways: dict[int, RefinedGraph] = {}

    def planned(painting: Painting) -> list[PlannedSegment]:
        return [
            PlannedSegment(region_of[color, min(cells)], frozenset(cells))
            for color, cells in colored_segments(graph, painting)
        ]

    segments = planned(painting)
    held: dict[int, list[tuple[int, set[int]]]] = {}
    fruitless, fewest = 0, len(segments)
    while fruitless < tries * len(segments) and not deadline.over:
        fruitless += 1
        change = _exchanged if chance.random() < EXCHANGED else _without_one
        kept = change(segments, regions, chance)
        if kept is None:
            continue
        plan = _each_cell_once(kept, len(graph.lists), chance)
        rings = chance.choice(RINGS)
        if rings not in ways:
            ways[rings] = refined(graph, rings)
        if rings not in held:
            held[rings] = held_nodes(ways[rings], painting)
        begun = _kept_nodes(ways[rings], plan, segments, held[rings])
        routed = route(
            ways[rings], plan, ROUNDS, chance.randrange(2**20), deadline, begun, PATIENCE
        )
        if deadline.over:
            return
        changed = canonical(graph, routed)
        found = planned(changed)
        if len(found) <= len(segments):
            painting, segments = changed, found
            held = {}
        if len(found) < fewest:
            fruitless, fewest = 0, len(found)
            yield changed


def _without_one(
    segments: Sequence[PlannedSegment], regions: Sequence[Region], chance: random.Random
) -> list[PlannedSegment] | None:
    """The segments without one, where their color regions still touch every cell.

    Where they would not, two segments give way to one in another region that touches what is
    missing. None if there is no such one, or no second segment that is not needed then.
    """
    dropped, kept, missed = _left_out(segments, chance)
    if not missed:
        return kept
    others = _regions_with(missed, regions, dropped)
    if not others:
        return None
    added = PlannedSegment(chance.choice(others), missed)
    used = Counter(segment.region for segment in [*kept, added])
    reach = Counter(cell for region in used for cell in region[1])
    spare = [s for s in kept if used[s.region] > 1 or all(reach[cell] > 1 for cell in s.region[1])]
    if not spare:
        return None
    second = chance.choice(spare)
    return [*(segment for segment in kept if segment is not second), added]


def _exchanged(
    segments: Sequence[PlannedSegment], regions: Sequence[Region], chance: random.Random
) -> list[PlannedSegment] | None:
    """The segments with one replaced by a segment in another region, a large one if possible.

    None if no other region has all the cells that only the replaced one could touch.
    """
    dropped, kept, missed = _left_out(segments, chance)
    others = _regions_with(missed, regions, dropped)
    if not others:
        return None
    (region,) = chance.choices(others, [len(cells) for _, cells in others])
    cells = missed or frozenset((chance.choice(sorted(region[1])),))
    return [*kept, PlannedSegment(region, cells)]


def _left_out(
    segments: Sequence[PlannedSegment], chance: random.Random
) -> tuple[PlannedSegment, list[PlannedSegment], frozenset[int]]:
    """A random segment, all others, and the cells that none of their regions has."""
    holders = Counter(cell for segment in segments for cell in segment.cells)
    # The fewer cells a segment has for itself, the likelier the others can do without it.
    weights = [1 / (1 + sum(holders[cell] == 1 for cell in s.cells)) for s in segments]
    (dropped,) = chance.choices(segments, weights)
    kept = [segment for segment in segments if segment is not dropped]
    return dropped, kept, dropped.cells.difference(*(segment.region[1] for segment in kept))


def _regions_with(
    cells: frozenset[int], regions: Sequence[Region], dropped: PlannedSegment
) -> list[Region]:
    """The regions with all of some cells, except that of the segment that was left out."""
    return [region for region in regions if cells <= region[1] and region != dropped.region]


def _kept_nodes(
    graph: RefinedGraph,
    plan: SegmentPlan,
    segments: Sequence[PlannedSegment],
    held: Sequence[tuple[int, set[int]]],
) -> list[set[int]]:
    """The nodes that each planned segment already has, where routing begins; none for a new one.

    Args:
        plan: what is to be routed.
        segments: before a segment was left out or exchanged.
        held: the connected nodes of one color, the largest sets first; each goes to one segment.
    """
    left = [(color, nodes, {graph.cell[node] for node in nodes}) for color, nodes in held]
    found: list[set[int]] = []
    for segment in plan:
        whole = [
            s.cells for s in segments if s.region == segment.region and segment.cells <= s.cells
        ]
        place = next(
            (
                number
                for number, (color, _, cells) in enumerate(left)
                if color == segment.region[0] and any(cells <= its for its in whole)
            ),
            None,
        )
        found.append(set() if place is None else left.pop(place)[1])
    return found


def _each_cell_once(
    segments: Sequence[PlannedSegment], cells: int, chance: random.Random
) -> SegmentPlan:
    """Each cell given to one of the segments that have it, or else to one that could."""
    order = list(range(len(segments)))
    chance.shuffle(order)
    holder: dict[int, int] = {}
    for number in order:
        for cell in segments[number].cells:
            holder.setdefault(cell, number)
    for cell in range(cells):
        if cell not in holder:
            holder[cell] = chance.choice([n for n in order if cell in segments[n].region[1]])
    own: list[set[int]] = [set() for _ in segments]
    for cell, number in holder.items():
        own[number].add(cell)
    return tuple(
        PlannedSegment(segment.region, frozenset(its))
        for segment, its in zip(segments, own, strict=True)
        if its
    )
