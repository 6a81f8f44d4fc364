"""Whether what a forged certificate claims is true all the same: all colorings of a mesh tell."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import networkx as nx
from forged_certificates import Original

from cellcolor.data.bounds import Bound
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.decomposition import decomposition_of


@dataclass(frozen=True)
class _Segment:
    color: int
    cells: frozenset[int]


@cache
def _colorings(original: Original) -> tuple[tuple[_Segment, ...], ...]:
    """The segments of every coloring of a small mesh."""
    surface = original.surface
    assert surface is not None
    cell_of = decomposition_of(surface, None).vertex_cell
    found = []
    for colors in itertools.product(*(own or (None,) for own in surface.vertex_colors)):
        graph = nx.Graph()
        graph.add_nodes_from(v for v, own in enumerate(colors) if own is not None)
        graph.add_edges_from(
            (a, b)
            for a, b in surface.left_of
            if colors[a] is not None
            and colors[a] == colors[b]
            and colors[a] not in surface.cracked(a, b)
        )
        found.append(
            tuple(
                _Segment(colors[min(together)], frozenset(cell_of[v] for v in together))
                for together in nx.connected_components(graph)
            )
        )
    return tuple(found)


def claims_truth(original: Original, forged: Bound) -> bool:
    """Whether no coloring of a small mesh contradicts anything that a forged certificate says.

    On a large instance never: a division has fewer segments than it claims.
    """
    certificate = forged.certificate
    if original.surface is None or certificate is None or forged.value > original.bound.value:
        return False  # a division exists that has fewer segments
    colorings: Sequence[tuple[_Segment, ...]] = _colorings(original)
    fewest = min(map(len, colorings))
    for color, cell, _ in certificate["left_out"]:
        colorings = _without(original.instance, colorings, color, cell)
        if min(map(len, colorings), default=fewest + 1) > fewest:
            return False
    cells = {cell for part in certificate["parts"] for cell in part["cells"]}
    if cells - {cell.id for cell in original.instance.cells}:
        return False
    conflicts = [conflict for part in certificate["parts"] for conflict in part["conflicts"]]
    for segments in colorings:
        if sum(not cells.isdisjoint(s.cells) for s in segments) < forged.value:
            return False
        if any(_both_connected(segments, conflict) for conflict in conflicts):
            return False
    return True


def _without(
    instance: Instance, colorings: Sequence[tuple[_Segment, ...]], color: int, cell: int
) -> list[tuple[_Segment, ...]]:
    """The colorings that do not use a color region."""
    graph = nx.Graph()
    graph.add_nodes_from(own.id for own in instance.cells if color in own.colors)
    graph.add_edges_from(
        (edge.left, edge.right)
        for edge in instance.edges
        if OUTSIDE not in (edge.left, edge.right) and color in instance.joinable(edge.id)
    )
    region = nx.node_connected_component(graph, cell) if cell in graph else set()
    return [
        segments
        for segments in colorings
        if not any(s.color == color and not region.isdisjoint(s.cells) for s in segments)
    ]


def _both_connected(segments: Sequence[_Segment], conflict: dict[str, Any]) -> bool:
    """Whether a coloring connects both pairs of areas of a conflict, by two segments."""
    ends = zip(conflict["colors"], (conflict["one"], conflict["other"]), strict=True)
    connecting = [
        {
            number
            for number, segment in enumerate(segments)
            if segment.color == color and not any(segment.cells.isdisjoint(area) for area in areas)
        }
        for color, areas in ends
    ]
    return any(one != other for one, other in itertools.product(*connecting))
