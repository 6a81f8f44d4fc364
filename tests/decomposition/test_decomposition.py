"""The decomposition, held to graphs drawn by hand and to what no relabelling may change."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from library import INSTANCES, PAPER
from meshes import (
    beside,
    drawn,
    finer,
    grid_faces,
    grid_points,
    octahedron,
    surface,
    surfaces,
    torus,
)
from relabelled import isomorphic, mirrored

from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from examples import examples


class Asked(Deadline):
    """A deadline that passes when it has been asked so many times.

    The ``moment`` counts how many times are left.
    """

    @property
    def over(self) -> bool:
        object.__setattr__(self, "moment", self.moment - 1)
        return self.moment < 0


BUILT_CASES = sorted(PAPER.glob("*.surface.json"))


def with_loops(instance: Instance, cell: int, *loops: tuple[int, ...]) -> Instance:
    cells = list(instance.cells)
    cells[cell] = replace(cells[cell], loops=loops)
    return replace(instance, cells=tuple(cells))


@pytest.mark.parametrize("path", BUILT_CASES, ids=lambda path: path.name)
def test_case_builds_into_its_graph(path: Path) -> None:
    expected = Instance.read(path.with_name(path.name.replace(".surface", "")))
    assert isomorphic(decompose(LabelledSurface.read(path)), expected)


@pytest.mark.parametrize(
    "path",
    sorted((INSTANCES / "scenes" / "feasibility").glob("*.surface.json"))
    + sorted((INSTANCES / "random").glob("*.surface.json")),
    ids=lambda path: path.name,
)
def test_counts_of_surfaces_from_elsewhere(path: Path) -> None:
    labelled = LabelledSurface.read(path)
    instance = decompose(labelled)
    assert len(instance.cells) == labelled.meta["known_cells"]
    if "known_edges" in labelled.meta:
        assert len(instance.edges) == labelled.meta["known_edges"]


class TestIsomorphism:
    """The judge of the tests above has to notice differences."""

    def test_swapped_cyclic_order(self) -> None:
        hub = Instance.read(PAPER / "crossing-zeros.json")
        (loop,) = hub.cells[0].loops
        assert isomorphic(hub, with_loops(hub, 0, loop[2:] + loop[:2]))
        swapped = (loop[2], loop[1], loop[0], *loop[3:])
        assert not isomorphic(hub, with_loops(hub, 0, swapped))

    def test_mirror_image(self) -> None:
        # Blue, green, red in counter-clockwise order is not red, green, blue.
        case = Instance.read(PAPER / "figeasycell3.json")
        assert not isomorphic(case, mirrored(case))

    def test_sides_of_an_edge(self) -> None:
        """A loop that meets both sides of an edge twice: which twin is which matters."""
        edges = (Edge(1, 0, 0), Edge(2, 0, 0), Edge(3, 0, OUTSIDE), Edge(4, 0, 0, ()))

        def loop(*darts: int) -> Instance:
            return Instance("loop", ("red",), (Cell(0, (0,), (darts,)),), edges)

        case = loop(3, 1, -1, 2, -2, 4, -4)
        assert isomorphic(case, loop(3, -2, 2, 1, -1, -4, 4))
        assert not isomorphic(case, loop(3, 1, 2, -1, -2, 4, -4))

    def test_outside(self) -> None:
        """Two holes beside each other are not two holes apart."""
        case = Instance.read(PAPER / "split-cell.json")
        (loop,) = case.cells[2].loops
        moved = tuple(dart for dart in loop if dart != -7)
        place = moved.index(-5) + 1
        assert not isomorphic(case, with_loops(case, 2, (*moved[:place], -7, *moved[place:])))


@examples(40)
@given(surfaces(), st.randoms(use_true_random=False))
def test_names_and_order_mean_nothing(labelled: LabelledSurface, random: object) -> None:
    shuffle = random.shuffle  # type: ignore[attr-defined]
    order = list(range(len(labelled.vertices)))
    shuffle(order)
    new_name = np.argsort(order)
    faces = [tuple(new_name[list(face)].tolist()) for face in labelled.faces]
    faces = [face[turn:] + face[:turn] for turn, face in enumerate(faces) for turn in [turn % 3]]
    shuffle(faces)
    renamed = surface(
        labelled.vertices[order],
        faces,
        [labelled.vertex_colors[old] for old in order],
        [
            (int(new_name[crack.j]), int(new_name[crack.i]), color)
            for crack in labelled.cracks
            for color in crack.colors
        ],
    )
    assert isomorphic(decompose(labelled), decompose(renamed))


@examples(40)
@given(surfaces())
def test_mirrored_mesh_gives_mirrored_graph(labelled: LabelledSurface) -> None:
    image = replace(labelled, faces=labelled.faces[:, ::-1].copy())
    assert isomorphic(decompose(image), mirrored(decompose(labelled)))


@examples(40)
@given(surfaces())
def test_cells_of_vertices(labelled: LabelledSurface) -> None:
    """Each vertex's cell has its colors, and every mesh edge between cells is an edge of both."""
    instance = decompose(labelled, "surface.json")
    assert instance.surface is not None
    cell_of = instance.surface.vertex_cell
    pairs = {frozenset((edge.left, edge.right)) for edge in instance.edges}
    cracked = {(crack.i, crack.j) for crack in labelled.cracks}
    for vertex, cell in enumerate(cell_of):
        colors = () if cell == OUTSIDE else instance.cells[cell].colors
        assert colors == labelled.vertex_colors[vertex]
    for a, b in labelled.left_of:
        if cell_of[a] != cell_of[b]:
            assert frozenset((cell_of[a], cell_of[b])) in pairs
            same = labelled.vertex_colors[a] == labelled.vertex_colors[b]
            assert not same or (min(a, b), max(a, b)) in cracked


@examples(40)
@given(surfaces(), surfaces())
def test_parts_side_by_side(one: LabelledSurface, other: LabelledSurface) -> None:
    """Two surfaces in one file: the cells, edges and loops of both, and nothing between them."""
    both = beside([one, other])
    first, second, union = decompose(one), decompose(other), decompose(both)
    assume(first.cells and second.cells)
    assert len(union.cells) == len(first.cells) + len(second.cells)
    assert len(union.edges) == len(first.edges) + len(second.edges)
    loops = [sum(len(cell.loops) for cell in part.cells) for part in (first, second, union)]
    assert loops[2] == loops[0] + loops[1]


def test_closed_surface_of_one_cell() -> None:
    points, faces = octahedron()
    instance = decompose(surface(points, faces, [[0, 2]] * 6))
    (cell,) = instance.cells
    assert (cell.colors, cell.loops, instance.edges) == ((0, 2), (), ())


def test_closed_surface_of_two_cells() -> None:
    points, faces = finer(*octahedron())
    colors = [[0] if z > 0.1 else [0, 1] for _, _, z in points]
    instance = decompose(surface(points, faces, colors))
    # One closed border without corners: an edge that starts and ends at an artificial one.
    assert [len(cell.loops) for cell in instance.cells] == [1, 1]
    (edge,) = instance.edges
    assert {edge.left, edge.right} == {0, 1}


def test_nothing_reachable() -> None:
    instance = decompose(drawn("... ... ...", {".": []}))
    assert (instance.cells, instance.edges) == ((), ())


def test_torus_of_one_cell_is_not_planar() -> None:
    points, faces = torus()
    with pytest.raises(InputError, match="not planar") as refusal:
        decompose(surface(points, faces, [[0]] * len(points)))
    assert refusal.value.field == "vertices[0]"


def test_torus_of_planar_cells() -> None:
    """The surface need not be planar, its cells must: two cuts open a torus into a disc."""
    points, faces = torus(6, 6)
    colors = [[1] if i in (0, 1) or j in (0, 1) else [0] for i in range(6) for j in range(6)]
    with pytest.raises(InputError, match=r"cell 0, which is not planar \(genus 1\)"):
        decompose(surface(points, faces, colors))
    # Two rings round the tube leave two annuli.
    colors = [[0] if i < 3 else [1] for i in range(6) for _ in range(6)]
    instance = decompose(surface(points, faces, colors))
    assert [len(cell.loops) for cell in instance.cells] == [2, 2]
    assert len(instance.edges) == 2


def test_annulus() -> None:
    instance = decompose(drawn("AAAAA AAAAA AABAA AAAAA AAAAA", {"A": [0, 1], "B": [1]}))
    ring, island = instance.cells
    assert sorted(len(loop) for loop in ring.loops) == [1, 1]
    assert [len(loop) for loop in island.loops] == [1]
    inner = next(edge for edge in instance.edges if OUTSIDE not in (edge.left, edge.right))
    assert instance.joinable(inner.id) == (1,)


def test_unreachable_hole() -> None:
    instance = decompose(drawn("AAAAA AAAAA AA.AA AAAAA AAAAA", {"A": [0], ".": []}))
    assert len(instance.cells) == 1
    assert len(instance.cells[0].loops) == 2
    assert all(OUTSIDE in (edge.left, edge.right) for edge in instance.edges)


def test_crack_with_two_free_ends() -> None:
    """A crack inside a cell is an edge with the cell on both sides, and a loop of its own."""
    labelled = drawn("AAAA AAAA AAAA AAAA", {"A": [0, 1]}, [(5, 6, 1)])
    instance = decompose(labelled)
    (cell,) = instance.cells
    crack = next(edge for edge in instance.edges if edge.right == edge.left == 0)
    assert crack.colors == (0,)
    assert {frozenset(loop) for loop in cell.loops} >= {frozenset((crack.id, -crack.id))}


def test_crack_from_the_border() -> None:
    """A crack that starts at the mesh's border hangs in the outer loop, both sides in a row."""
    instance = decompose(drawn("AAAA AAAA AAAA AAAA", {"A": [0]}, [(1, 2, 0)]))
    (cell,) = instance.cells
    (loop,) = cell.loops
    crack = next(edge for edge in instance.edges if edge.right == edge.left == 0)
    assert crack.colors == ()
    assert len(loop) == 3
    assert {crack.id, -crack.id} < set(loop)


def test_crack_through_a_cell_makes_two_of_one_set() -> None:
    grid = grid_points(4, 3)
    across = {(1, 2), (5, 6), (9, 10), (5, 2), (9, 6)}
    labelled = surface(grid, grid_faces(4, 3), [[0, 2]] * 12, [(a, b, 2) for a, b in across])
    instance = decompose(labelled)
    assert [cell.colors for cell in instance.cells] == [(0, 2), (0, 2)]
    between = [edge for edge in instance.edges if {edge.left, edge.right} == {0, 1}]
    assert [edge.colors for edge in between] == [(0,)]


def test_edge_where_the_joinable_colors_change() -> None:
    """One border, cracked for blue along a part of it only: two edges with a corner between."""
    rows = "AABB AABB AABB AABB AABB AABB"
    cracked = [(1, 2, 1), (5, 6, 1), (5, 2, 1), (9, 6, 1)]
    instance = decompose(drawn(rows, {"A": [0, 1], "B": [0, 1, 2]}, cracked))
    between = [edge for edge in instance.edges if {edge.left, edge.right} == {0, 1}]
    assert sorted(instance.joinable(edge.id) for edge in between) == [(0,), (0, 1)]


def test_lengths() -> None:
    """A straight border of a 1 m grid: the dual zigzags over edge middles and triangle centres."""
    instance = decompose(drawn("AB AB", {"A": [0], "B": [0, 1]}))
    between = next(edge for edge in instance.edges if {edge.left, edge.right} == {0, 1})
    middles = [np.array(p) for p in ((0.5, 1.0), (0.5, 0.5), (0.5, 0.0))]
    centres = [np.array(p) for p in ((1 / 3, 2 / 3), (2 / 3, 1 / 3))]
    path = [middles[0], centres[0], middles[1], centres[1], middles[2]]
    inside = sum(float(np.linalg.norm(b - a)) for a, b in pairwise(path))
    assert between.length == pytest.approx(inside)


def test_a_deadline_ends_it_wherever_it_is() -> None:
    """Asked a few times for each thousand vertices, and whenever it says so, that is the end."""
    labelled = surface(grid_points(40, 40), grid_faces(40, 40), [[i % 2] for i in range(1600)])
    patient = Asked(1e9)
    decompose(labelled, deadline=patient)
    times = int(1e9 - patient.moment)
    assert times > 20
    for asked in range(0, times, 4):
        with pytest.raises(OutOfTime):
            decompose(labelled, deadline=Asked(asked))
    decompose(labelled, deadline=Asked(times))
