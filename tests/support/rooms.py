"""Rooms that segments cross in pieces of one color, on graphs and meshes, and whether they can.

Hubs with petals: a cell of all colors, and cells of one color or more all round it.
"""

from __future__ import annotations

from collections.abc import Sequence

import networkx as nx
from hypothesis import strategies as st
from meshes import grid_faces, grid_points, surface

from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families.meshes import make_mesh

RED, BLUE, GREEN = 0, 1, 2


def room(*loops: Sequence[int | tuple[int, ...]]) -> Instance:
    """A cell of all colors with petals round its loops, numbered from 1 as they come."""
    petals = [(own,) if isinstance(own, int) else own for loop in loops for own in loop]
    numbers = iter(range(1, len(petals) + 1))
    return Instance(
        "room",
        ("red", "blue", "green"),
        (
            Cell(0, (RED, BLUE, GREEN), tuple(tuple(next(numbers) for _ in lp) for lp in loops)),
            *(Cell(n, own, ((-n,),)) for n, own in enumerate(petals, start=1)),
        ),
        tuple(Edge(n, 0, n) for n in range(1, len(petals) + 1)),
    )


ISLAND_BETWEEN = room((RED, BLUE, RED, GREEN), (BLUE, GREEN))
"""Red, from left to right, passes the island above, where blue comes from, or below, as green."""


ROUND_A_PETAL = room((GREEN, RED, (BLUE, GREEN), RED, GREEN, (RED, BLUE)))
"""Blue passes from petal 3 to petal 6 only if red, from petal 2 to 4, goes round petal 6."""


@st.composite
def rooms(draw: st.DrawFn, width: int, height: int) -> LabelledSurface:
    """A frame in pieces of one color, and an island of two around which segments may pass."""
    several = st.sampled_from([(RED, BLUE, GREEN)] * 8 + [(RED, BLUE), (RED, GREEN)])
    rim = [(0, column) for column in range(width)]
    rim += [(row, width - 1) for row in range(1, height)]
    rim += [(height - 1, column) for column in reversed(range(width - 1))]
    rim += [(row, 0) for row in reversed(range(1, height - 1))]
    pieces: list[tuple[int, ...]] = draw(st.permutations([(RED,), (RED,), (BLUE,), (GREEN,)]))
    further = st.sampled_from([(RED,), (BLUE,), (GREEN,), (RED, BLUE), (BLUE, GREEN)])
    pieces += draw(st.lists(further, max_size=3))
    labels: dict[tuple[int, int], Sequence[int]] = {
        place: pieces[number * len(pieces) // len(rim)] for number, place in enumerate(rim)
    }
    halves = draw(several), draw(several)
    for row in range(1, height - 1):
        for column in range(1, width - 1):
            labels[row, column] = halves[2 * row > height]
    row, column = draw(st.integers(2, height - 4)), draw(st.integers(2, width - 3))
    upper, lower = draw(st.sampled_from([(BLUE, GREEN), (GREEN, BLUE), (RED, BLUE)]))
    labels[row, column], labels[row + 1, column] = (upper,), (lower,)
    return surface(
        grid_points(width, height),
        grid_faces(width, height),
        [labels[row, column] for row in range(height) for column in range(width)],
    )


def can_be_drawn(
    mesh: LabelledSurface, segments: Sequence[tuple[int, list[set[int]], set[int]]]
) -> bool:
    """Whether disjoint sets of mesh vertices exist, each connected in its color from a first set of
    vertices to a second without some others: every path without shortcuts is tried for all but the
    last."""
    mesh_graph: nx.Graph[int] = nx.Graph(mesh.left_of.keys())
    graphs = [
        mesh_graph.subgraph(
            v for v, own in enumerate(mesh.vertex_colors) if color in own and v not in avoided
        )
        for color, _, avoided in segments
    ]

    def fits(number: int, used: set[int]) -> bool:
        if any(
            not any(
                not part.isdisjoint(ends[0]) and not part.isdisjoint(ends[1])
                for part in nx.connected_components(graph.subgraph(graph.nodes - used))
            )
            for graph, (_, ends, _) in list(zip(graphs, segments, strict=True))[number:]
        ):
            return False
        if number == len(segments) - 1:
            return True
        graph, (start, end) = graphs[number], segments[number][1]

        def extend(path: list[int]) -> bool:
            if path[-1] in end:
                return fits(number + 1, used | set(path))
            near = set().union(*(graph[v] for v in path[:-1])) | set(path) | used
            return any(extend([*path, v]) for v in sorted(graph[path[-1]]) if v not in near)

        return any(extend([v]) for v in sorted(start - used))

    return fits(0, set())


@st.composite
def crossed_rings(draw: st.DrawFn) -> LabelledSurface:
    """Two narrow rings over a torus, one along it and one around it, in red, blue and both.

    The rings cross each other, so what red and blue reach covers the handle. A ring falls into
    cells of both colors with and without green, as no cell may lie around the handle.
    """
    size, width = 6, draw(st.integers(1, 2))
    vertices, faces = make_mesh("torus", size)
    kinds = st.sampled_from([(RED,), (BLUE,), None])
    labels: list[Sequence[int]] = []
    for row in range(size):
        for column in range(size):
            both = (RED, BLUE) if (row // 3 + column // 3) % 2 else (RED, BLUE, GREEN)
            inside = row < width or column < width
            labels.append((draw(kinds) or both) if inside else (GREEN,))
    return LabelledSurface("rings", ("red", "blue", "green"), vertices, faces, tuple(labels))


def hub(*petals: int | tuple[int, ...]) -> Instance:
    """A cell of all colors, two at least, with petals in these colors, each in one or more."""
    own = [(its,) if isinstance(its, int) else its for its in petals]
    colors = tuple(range(max(1, *map(max, own)) + 1))
    return Instance(
        "hub",
        tuple(f"color {c}" for c in colors),
        (
            Cell(0, colors, (tuple(range(1, len(petals) + 1)),)),
            *(Cell(i, petal, ((-i,),)) for i, petal in enumerate(own, start=1)),
        ),
        tuple(Edge(i, 0, i) for i in range(1, len(petals) + 1)),
    )


def four_colors_in_turn(petals: int) -> Instance:
    """A hub however large, made at once, since no minimum is worked out with it."""
    return hub(*(number % 4 for number in range(petals)))
