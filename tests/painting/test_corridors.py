"""Clearances and corridors, held against shortest ways on a graph and its connected parts."""

from __future__ import annotations

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families.voronoi import voronoi
from cellcolor.painting.corridors import Room
from cellcolor.painting.nearby import Nearby
from examples import examples


def drawn(seed: int, shape: str) -> tuple[LabelledSurface, list[int]]:
    """Segments at random, some vertices in none, each segment in one piece."""
    surface = voronoi(seed, shape, size=10, regions=6, colors=3, holes=1)
    graph = nx.Graph(surface.left_of.keys())
    # Vertices of equal color sets, flooded: what no color reaches is in no segment.
    alike = [(a, b) for a, b in graph.edges if surface.vertex_colors[a] == surface.vertex_colors[b]]
    parts = nx.Graph(alike)
    parts.add_nodes_from(graph)
    segment = [-1] * len(surface.vertices)
    for number, own in enumerate(nx.connected_components(parts)):
        for vertex in own:
            if surface.vertex_colors[vertex]:
                segment[vertex] = number
    return surface, segment


def room_of(surface: LabelledSurface, segment: list[int], radius: float) -> Room:
    return Room(Nearby(surface), segment, lambda _a, _b: True, radius)


def two_steps(surface: LabelledSurface) -> nx.Graph:
    """Vertices within two mesh edges of each other, and their straight distances."""
    graph = nx.Graph(surface.left_of.keys())
    near = nx.power(graph, 2)
    for a, b in near.edges:
        near.edges[a, b]["weight"] = np.linalg.norm(surface.vertices[a] - surface.vertices[b])
    return near


@given(st.integers(0, 10**6), st.sampled_from(["disc", "annulus", "sphere", "torus"]))
@examples(12)
def test_clearance_is_the_shortest_way_to_another_segment(seed: int, shape: str) -> None:
    """Borders lie in the middle of mesh edges; ways lead over vertices two mesh edges apart.

    A way through another segment is none, but that one's own border is nearer then.
    """
    surface, segment = drawn(seed, shape)
    room = room_of(surface, segment, radius := 0.25)
    near = two_steps(surface)
    for number in set(segment) - {-1}:
        others: dict[int, float] = {}
        for a, b in surface.left_of:
            for here, there in ((a, b), (b, a)):
                if segment[there] not in (number, -1) and segment[here] in (number, -1):
                    half = float(np.linalg.norm(surface.vertices[a] - surface.vertices[b])) / 2
                    others[here] = min(others.get(here, half), half)
        graph = near.subgraph(v for v in near if segment[v] in (number, -1)).copy()
        graph.add_weighted_edges_from(("border", v, half) for v, half in others.items())
        expected = nx.single_source_dijkstra_path_length(graph, "border") if others else {}
        for vertex, own in enumerate(segment):
            if own == number:
                wanted = min(expected.get(vertex, 3 * radius), 3 * radius)
                assert room.clearance[vertex] == pytest.approx(wanted)


@given(st.integers(0, 10**6), st.sampled_from(["disc", "annulus", "torus"]), st.floats(0.05, 0.3))
@examples(20)
def test_narrow_corridors_part_the_places_where_the_tool_fits(
    seed: int, shape: str, radius: float
) -> None:
    """Where the tool has room falls into pieces; each corridor joins two pieces of a segment."""
    surface, segment = drawn(seed, shape)
    room = room_of(surface, segment, radius)
    graph = nx.Graph(surface.left_of.keys())
    roomy = graph.subgraph(v for v in graph if segment[v] >= 0 and room.clearance[v] >= radius)
    inside = nx.Graph((a, b) for a, b in roomy.edges if segment[a] == segment[b])
    inside.add_nodes_from(roomy)
    pieces = list(nx.connected_components(inside))
    piece_of = {vertex: number for number, own in enumerate(pieces) for vertex in own}
    expected = len(pieces) - len({segment[v] for v in roomy})
    narrow = [found for found in room.corridors() if found.width_m < 2 * radius]
    joining = 0
    for corridor in narrow:
        narrowest = corridor.way[0]
        assert corridor.width_m == 2 * min(room.clearance[v] for v in corridor.way)
        assert corridor.place == pytest.approx(tuple(surface.vertices[narrowest]))
        assert {segment[v] for v in corridor.way} == {corridor.segment}
        way = graph.subgraph(corridor.way)
        assert nx.is_connected(way)
        beside = {piece_of[w] for v in corridor.way for w in graph[v] if w in piece_of}
        beside = {number for number in beside if segment[min(pieces[number])] == corridor.segment}
        joining += len(beside) > 1
    assert joining >= expected if expected else True
    assert bool(joining) == bool(expected)
