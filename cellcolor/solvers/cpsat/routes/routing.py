"""Segments as routes that compete for room: a first division, usually with the fewest segments.

Every planned segment is a net that has to connect cells in which only it can be painted. Nets are
routed one after the other as if they were alone, and may overlap at a price. Where
they do, the price rises with every round, until some make room (negotiated congestion:
McMurchie and Ebeling, PathFinder, FPGA 1995). Cells that no route touches are then painted from
their neighbors.
"""

from __future__ import annotations

import heapq
import random
from collections.abc import Iterable
from math import inf

from cellcolor.deadline import NEVER, Deadline
from cellcolor.solvers.cpsat.model.painting import Painting
from cellcolor.solvers.cpsat.routes.sectors import RefinedGraph, painting_of_nodes
from cellcolor.solvers.cpsat.routes.segment_plans import SegmentPlan

FIRST_PRICE, PRICE_FACTOR, HIGHEST_PRICE = 0.5, 1.3, 50.0
"""What a node costs for each other net that uses it, in units of an unused node. The price begins
low, so that nets find their shortest ways, and rises by the factor after each round with nodes that
are shared."""


def route(
    graph: RefinedGraph,
    plan: SegmentPlan,
    rounds: int,
    seed: int,
    deadline: Deadline = NEVER,
) -> Painting:
    """Paint a plan.

    Args:
        graph: cells cut into nodes.
        plan: the segments to route.
        rounds: of routing all nets that are in conflict.
        seed: of the order in which cells are connected.
        deadline: when to stop; looked at after each net.

    Returns:
        A painting; with more segments than planned if some could not be connected.
    """
    router = _Router(graph, plan, seed)
    for _ in range(rounds):
        if router.improve(deadline) or deadline.over:
            break
    return painting_of_nodes(graph, router.colors())


class _Router:
    def __init__(self, graph: RefinedGraph, plan: SegmentPlan, seed: int) -> None:
        self._graph = graph
        self._plan = plan
        self._random = random.Random(seed)
        self._nets_of = [
            [net for net, segment in enumerate(plan) if cell in segment.region[1]]
            for cell in range(len(graph.nodes))
        ]
        # The cells that only one net can be in cost it nothing.
        self._own: list[set[int]] = [set() for _ in plan]
        for cell, nets in enumerate(self._nets_of):
            if len(nets) == 1:
                self._own[nets[0]].add(cell)
        # Cells that no other region of the plan reaches.
        self._terminals = [
            [
                cell
                for cell in sorted(segment.cells)
                if all(plan[net].region == segment.region for net in self._nets_of[cell])
            ]
            for segment in plan
        ]
        self._routes: list[set[int]] = [set() for _ in plan]
        self._used = [0] * len(graph.cell)
        self._past = [0.0] * len(graph.cell)
        self._price = FIRST_PRICE

    def improve(self, deadline: Deadline) -> bool:
        """One round; whether no two nets share a node and every cell is touched."""
        for net in range(len(self._plan)):
            if deadline.over:
                return False
            if self._has_to_move(net):
                self._reroute(net)
        shared = [node for node, count in enumerate(self._used) if count > 1]
        for node in shared:
            self._past[node] += 1.0
        if shared:
            self._price = min(self._price * PRICE_FACTOR, HIGHEST_PRICE)
            return False
        owner = self._spread()
        missed = next(
            (
                cell
                for cell, nodes in enumerate(self._graph.nodes)
                if all(owner[node] is None for node in nodes)
            ),
            None,
        )
        if missed is not None:
            self._terminals[self._random.choice(self._nets_of[missed])].append(missed)
        return missed is None

    def colors(self) -> list[int]:
        """A color for every node; where nets share one it belongs to the first of them."""
        owner = self._spread()
        return [
            self._plan[self._nets_of[cell][0] if net is None else net].region[0]
            for cell, net in zip(self._graph.cell, owner, strict=True)
        ]

    def _has_to_move(self, net: int) -> bool:
        route = self._routes[net]
        touched = {self._graph.cell[node] for node in route}
        return any(self._used[node] > 1 for node in route) or not touched.issuperset(
            self._terminals[net]
        )

    def _reroute(self, net: int) -> None:
        """Connect a net's cells from scratch, each to what is nearest."""
        for node in self._routes[net]:
            self._used[node] -= 1
        cells = self._terminals[net][:]
        self._random.shuffle(cells)
        start = min(
            self._graph.nodes[cells[0]],
            key=lambda node: (self._cost(node, net), self._random.random()),
        )
        self._routes[net] = self._grown(net, start, set(cells) - {cells[0]})
        for node in self._routes[net]:
            self._used[node] += 1

    def _grown(self, net: int, start: int, targets: set[int]) -> set[int]:
        """A route from a node to all target cells, always on to the nearest one.

        One search serves for all of them (Dijkstra): what a new way takes starts at distance 0
        again, and distances that are known already can only become shorter by that.
        """
        near = self._graph.near(self._plan[net].region[0])
        cell_of, past, used, price = self._graph.cell, self._past, self._used, self._price
        own = self._own[net]
        route = set(self._taken(start))
        left = set(targets)
        distance = dict.fromkeys(route, 0.0)
        before: dict[int, int] = {}
        heap = [(0.0, node) for node in sorted(route)]
        while left:
            length, node = heapq.heappop(heap)
            if length > distance[node]:
                continue
            if cell_of[node] in left:
                left.discard(cell_of[node])
                while node not in route:
                    for taken in self._taken(node):
                        route.add(taken)
                        distance[taken] = 0.0
                        heapq.heappush(heap, (0.0, taken))
                    node = before[node]
                continue  # it stands in the heap again, at distance 0
            for other in near[node]:
                known = distance.get(other, inf)
                if known <= length:
                    continue
                longer = length
                if cell_of[other] not in own:
                    # As in ``_cost``; a call for each neighbor would take most of the time.
                    longer += (1.0 + past[other]) * (1.0 + price * used[other])
                if longer < known:
                    distance[other] = longer
                    before[other] = node
                    heapq.heappush(heap, (longer, other))
        return route

    def _cost(self, node: int, net: int) -> float:
        if self._graph.cell[node] in self._own[net]:
            return 0.0
        return (1.0 + self._past[node]) * (1.0 + self._price * self._used[node])

    def _taken(self, node: int) -> Iterable[int]:
        """What a route takes with a node: the whole cell, if no other net can be in it."""
        cell = self._graph.cell[node]
        return self._graph.nodes[cell] if len(self._nets_of[cell]) == 1 else (node,)

    def _spread(self) -> list[int | None]:
        """The net of each node, routes grown over free nodes as far as their regions go."""
        owner: list[int | None] = [None] * len(self._used)
        near = [self._graph.near(segment.region[0]) for segment in self._plan]
        for net, route in reversed(list(enumerate(self._routes))):
            for node in route:
                owner[node] = net
        reached = [node for node, net in enumerate(owner) if net is not None]
        for node in reached:
            its = owner[node]
            assert its is not None
            for other in near[its][node]:
                if owner[other] is None:
                    owner[other] = its
                    reached.append(other)
        return owner
