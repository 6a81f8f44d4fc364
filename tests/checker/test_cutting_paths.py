"""Cutting paths are counted as curves on the surface; where seams lie does not matter."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterable, Sequence

import networkx as nx
import pytest
from holes import as_division, divisions, holed, live_loops, paths
from hypothesis import given
from hypothesis import strategies as st
from rooms import graph, petal_cells

from cellcolor.checker.cutting_paths import cutting_paths
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, number_segments
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options
from examples import examples

pytestmark = pytest.mark.second

Triangles = list[tuple[int, int, int]]
Loops = list[list[int]]


RED, BLUE = 0, 1
SEEDS = st.integers(0, 10**6)


def petals(loops: Sequence[Sequence[int]], colors: Sequence[int]) -> Instance:
    """A cell of all colors, with a cell of one color across each of its darts 1, 2, …"""
    many = tuple(range(max(colors, default=0) + 1))
    return graph((many, *loops), *petal_cells(*colors))


def division(instance: Instance, blocks: Iterable[Iterable[int]]) -> Division:
    """Sub-cells of the first cell, whatever their colors."""
    found = [(0, tuple(block)) for block in blocks]
    return number_segments([found, *([(0, ())] for _ in instance.cells[1:])])


def count(loops: Sequence[Sequence[int]], *blocks: Sequence[int]) -> int:
    instance = petals(loops, [RED] * sum(map(len, loops)))
    return cutting_paths(instance, division(instance, blocks))


@pytest.mark.parametrize(
    ("loops", "blocks", "expected"),
    [
        # A disc: one path for each sub-cell beyond the first.
        ([[1, 2, 3, 4]], [[1, 2, 3, 4]], 0),
        ([[1, 2, 3, 4]], [[1, 2], [3, 4]], 1),
        ([[1, 2, 3, 4, 5, 6]], [[1, 2], [3, 4], [5, 6]], 2),
        # An annulus: a closed curve between its loops; a path from a loop to itself, with the
        # other loop on one side; two paths from loop to loop.
        ([[1, 2], [3, 4]], [[1, 2], [3, 4]], 1),
        ([[1, 2, 3], [4]], [[1, 4], [2, 3]], 1),
        ([[1, 2], [3, 4]], [[1, 3], [2, 4]], 2),
        # Loops without darts in state 1 are in nobody's way.
        ([[1, 2], [3, 4]], [[1, 2]], 0),
        ([[1, 2], [3, 4], [5]], [[1, 3], [2, 4]], 2),
        # Three loops. Two bands from the first to the second and two on to the third leave three
        # gaps between bands, of which one touches four bands and takes three paths.
        ([[1, 2], [3, 4, 5, 6], [7, 8]], [[1, 3], [2, 4], [5, 7], [6, 8]], 5),
        # A sub-cell that all loops share, and one at each of two loops.
        ([[1, 2], [3, 4], [5, 6]], [[1, 2, 3, 5], [4], [6]], 2),
        # A ring of loops and bands has three bands inside and outside, with two paths each.
        ([[1, 2], [3, 4], [5, 6]], [[1, 4], [3, 6], [5, 2]], 4),
        # A sphere of one cell.
        ([], [[]], 0),
    ],
)
def test_worked_by_hand(loops: list[list[int]], blocks: list[list[int]], expected: int) -> None:
    assert count(loops, *blocks) == expected


def annulus(rings: int, columns: int) -> tuple[Triangles, Loops]:
    """Triangles of rings of vertices, and the two border loops."""
    triangles = []
    for ring, column in itertools.product(range(rings - 1), range(columns)):
        following = (column + 1) % columns
        a, b = ring * columns + column, ring * columns + following
        triangles += [(a, b, b + columns), (a, b + columns, a + columns)]
    first, last = list(range(columns)), list(range((rings - 1) * columns, rings * columns))
    return triangles, [first, last[::-1]]


def curves(triangles: Triangles, label: Sequence[int]) -> int:
    """The curves between the labels of a mesh, counted one by one.

    They run through the triangles and edges with two labels. In a triangle with three labels a
    curve ends at another. So each curve has two ends, at the mesh's border or at a curve, but for
    closed ones: of several curves that hang together without an end at the border, one is closed.
    """
    sides: dict[tuple[int, int], list[int]] = {}
    for number, triangle in enumerate(triangles):
        for a, b in itertools.combinations(sorted(triangle), 2):
            sides.setdefault((a, b), []).append(number)
    graph: nx.Graph[object] = nx.Graph()
    ends = sum(len({label[v] for v in triangle}) == 3 for triangle in triangles)
    at_border = []
    for (a, b), found in sides.items():
        if label[a] == label[b]:
            continue
        graph.add_edges_from(((a, b), number) for number in found)
        if len(found) == 1:
            ends += 1
            at_border.append((a, b))
    parts = list(nx.connected_components(graph))
    closed = sum(not any(end in part for end in at_border) for part in parts)
    assert ends % 2 == 0
    return ends // 2 + closed


def areas(triangles: Triangles, color: Sequence[int]) -> list[set[int]]:
    graph: nx.Graph[int] = nx.Graph()
    graph.add_nodes_from(range(len(color)))
    for triangle in triangles:
        graph.add_edges_from(
            (a, b) for a, b in itertools.combinations(triangle, 2) if color[a] == color[b]
        )
    return list(nx.connected_components(graph))


def counted(
    triangles: Triangles, loops: Loops, color: Sequence[int]
) -> tuple[frozenset[frozenset[int]], int, int] | None:
    """The darts of each area, curves counted on the mesh, and cutting paths by the checker.

    None if an area does not touch the border: sub-cells without darts in state 1 are superfluous.
    """
    dart = {v: number for number, v in enumerate(itertools.chain(*loops), start=1)}
    found = areas(triangles, color)
    blocks = frozenset(frozenset(dart[v] for v in area if v in dart) for area in found)
    if not all(blocks):
        return None
    label = [next(n for n, area in enumerate(found) if v in area) for v in range(len(color))]
    paths = count([[dart[v] for v in loop] for loop in loops], *map(sorted, blocks))
    return blocks, curves(triangles, label), paths


@pytest.mark.parametrize(("rings", "columns", "colors"), [(3, 4, 2), (4, 3, 2), (3, 3, 3)])
def test_every_coloring_of_an_annulus(rings: int, columns: int, colors: int) -> None:
    """Of all colorings with the same darts together, one has as few curves as the checker says."""
    triangles, loops = annulus(rings, columns)
    fewest: dict[frozenset[frozenset[int]], int] = {}
    said: dict[frozenset[frozenset[int]], int] = {}
    for color in itertools.product(range(colors), repeat=rings * columns):
        if color[0] == 0 and (found := counted(triangles, loops, color)) is not None:
            blocks, seen, said[blocks] = found
            fewest[blocks] = min(fewest.get(blocks, seen), seen)
    # With six darts that are all alone, three colors on three columns leave no room for a closed
    # curve between the loops, and there are no more colors.
    said.pop(frozenset(frozenset([dart]) for dart in range(1, 7)), None)
    assert len(said) > 30
    assert {blocks: fewest[blocks] for blocks in said} == said


def with_two_holes() -> tuple[Triangles, Loops]:
    """Triangles of a grid without two squares, and the three border loops."""
    columns, rows, holes = 7, 4, ((1, 1), (4, 1))
    triangles = []
    for x, y in itertools.product(range(columns - 1), range(rows - 1)):
        if (x, y) not in holes:
            a = y * columns + x
            triangles += [(a, a + 1, a + 1 + columns), (a, a + 1 + columns, a + columns)]
    corners = [[(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)] for x, y in holes]
    rim = [(x, 0) for x in range(columns)] + [(columns - 1, y) for y in range(1, rows)]
    rim += [(x, rows - 1) for x in range(columns - 1)] + [(0, y) for y in range(1, rows - 1)]
    return triangles, [[y * columns + x for x, y in loop] for loop in (rim, *corners)]


def test_colorings_with_two_holes() -> None:
    """None has fewer curves than the checker says, and most have as many."""
    triangles, loops = with_two_holes()
    rng = random.Random(7)
    as_many = total = 0
    for _ in range(400):
        centers = [rng.sample(range(28), rng.randint(1, 3)) for _ in range(3)]
        color = [
            min(
                range(3),
                key=lambda c: min(
                    abs(v % 7 - w % 7) + abs(v // 7 - w // 7) + 0.1 * c for w in centers[c]
                ),
            )
            for v in range(28)
        ]
        if (found := counted(triangles, loops, color)) is not None:
            _, seen, said = found
            assert seen >= said
            as_many += seen == said
            total += 1
    assert total > 200 and as_many > total / 2


@examples(10)
@given(seed=SEEDS, darts=st.integers(4, 5), loops=st.integers(2, 3), colors=st.integers(2, 3))
def test_every_division_with_holes(seed: int, darts: int, loops: int, colors: int) -> None:
    """Against all ways to group the loops of each cell."""
    instance = holed(seed, darts, loops, colors)
    borders = [live_loops(instance, cell) for cell in instance.cells]
    for painted in divisions(instance):
        expected = sum(
            paths(own, frozenset(block for _, block in cell))
            for own, cell in zip(borders, painted, strict=True)
        )
        assert cutting_paths(instance, as_division(painted)) == expected


def test_loops_turned_are_the_same_instance() -> None:
    """One path: the red sub-cell holds a dart of either loop, the blue one two of one loop."""
    for loops in ([[1], [2, 3, 4]], [[3, 4, 2], [1]], [[4, 2, 3], [1]]):
        instance = petals(loops, (RED, RED, BLUE, BLUE))
        found = solve(instance, Options())
        assert found.segments == 2 and found.cells is not None
        assert cutting_paths(instance, found.cells, found.seams) == 1
