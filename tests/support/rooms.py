"""Hubs with petals, and rings that cross; and whether two segments can pass each other on a mesh.

A hub is a cell of all colors; its petals are cells of one color or more all round it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import networkx as nx
from hypothesis import strategies as st

from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families.meshes import make_mesh

RED, BLUE, GREEN = 0, 1, 2


def graph(
    *cells: Sequence[Sequence[int]], cracks: Mapping[int, tuple[int, ...]] | None = None
) -> Instance:
    """Each cell as its colors and its loops; edges lie between the cells that have their darts.

    ``cracks`` has the joinable colors of edges that are cracked in some.
    """
    cell_of = {dart: n for n, (_, *loops) in enumerate(cells) for loop in loops for dart in loop}
    return Instance(
        "graph",
        tuple(f"color {c}" for c in range(1 + max(max(colors) for colors, *_ in cells))),
        tuple(
            Cell(n, tuple(colors), tuple(map(tuple, loops)))
            for n, (colors, *loops) in enumerate(cells)
        ),
        tuple(
            Edge(e, cell_of.get(e, OUTSIDE), cell_of.get(-e, OUTSIDE), (cracks or {}).get(e))
            for e in sorted(set(map(abs, cell_of)))
        ),
    )


def petal_cells(*colors: int | Sequence[int]) -> list[Sequence[Sequence[int]]]:
    """Cells for ``graph`` in these colors, across the darts 1, 2, … of another cell."""
    return [
        ((own,) if isinstance(own, int) else own, (-dart,))
        for dart, own in enumerate(colors, start=1)
    ]


def can_pass(
    mesh: LabelledSurface, colors: tuple[int, int], one: list[set[int]], other: list[set[int]]
) -> bool:
    """Whether two disjoint sets of mesh vertices exist, connected in the one and the other color,
    that each touch two sets of vertices: every path without shortcuts is tried for the first."""
    graphs = []
    for color in colors:
        graph: nx.Graph[int] = nx.Graph()
        graph.add_nodes_from(v for v, own in enumerate(mesh.vertex_colors) if color in own)
        cracked = {(c.i, c.j) for c in mesh.cracks if color in c.colors}
        graph.add_edges_from(
            (i, j)
            for i, j in mesh.left_of
            if i in graph and j in graph and (min(i, j), max(i, j)) not in cracked
        )
        graphs.append(graph)
    first, second = graphs

    def others_meet(path: list[int]) -> bool:
        rest = second.subgraph(second.nodes - set(path))
        return any(
            not part.isdisjoint(other[0]) and not part.isdisjoint(other[1])
            for part in nx.connected_components(rest)
        )

    def extend(path: list[int]) -> bool:
        if not others_meet(path):
            return False
        if path[-1] in one[1]:
            return True
        near = set().union(*(first[v] for v in path[:-1])) | set(path)
        return any(extend([*path, v]) for v in first[path[-1]] if v not in near)

    return any(extend([start]) for start in sorted(one[0]))


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


def hub(*colors: int | tuple[int, ...]) -> Instance:
    """A cell of all colors, two at least, with petals in these colors, each in one or more."""
    around = petal_cells(*colors)
    every = range(max(1, *(max(own) for own, _ in around)) + 1)
    return graph((every, range(1, len(colors) + 1)), *around)


def four_colors_in_turn(petals: int) -> Instance:
    """A hub however large, made at once, since no minimum is worked out with it."""
    return hub(*(number % 4 for number in range(petals)))


def hub_with_a_hole() -> Instance:
    """A hub in three colors, with leaf cells around it and in its hole, one of them with two.

    In colors 0 and 1 alone its first edge cannot be joined, and both loops have another first dart.
    """
    petals = {1: (2, 3), 2: (0,), 3: (1,), 4: (0,), 5: (0,), 6: (1,)}
    leaves = [Cell(n, own, ((-n, 7) if n == 1 else (-n,),)) for n, own in petals.items()]
    hub = Cell(0, (0, 1, 3), ((1, 2, 3, 4), (5, 6)))
    edges = (*(Edge(n, 0, n) for n in petals), Edge(7, 1, 7))
    cells = (hub, *leaves, Cell(7, (2,), ((-7,),)))
    return Instance("hub with a hole", ("a", "b", "c", "d"), cells, edges)
