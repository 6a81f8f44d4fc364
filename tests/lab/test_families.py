"""Random families: valid, reproducible, and what they claim to be."""

from __future__ import annotations

from collections import Counter
from typing import Any

import networkx as nx
import pytest
import trimesh
from exhaustive_minima import minimum, noncrossing
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.decomposition import decompose
from cellcolor.lab.families import (
    LARGE,
    MEDIUM,
    SHAPES,
    SMALL,
    Family,
    Topology,
    hub,
    hub_grid,
    hub_minimum,
    planar_graph,
    voronoi,
)
from cellcolor.lab.families.meshes import make_mesh
from cellcolor.solvers.cpsat import CpSatSolver
from cellcolor.solvers.interface import Options
from examples import examples

pytestmark = pytest.mark.second


def test_hub_is_a_ring_around_one_cell() -> None:
    instance = hub(4, 9, 3)
    center, *petals = instance.cells
    assert center.colors == (0, 1, 2) and len(center.loops) == 1 and len(petals) == 9
    ring = [instance.cells[instance.across(dart)].colors for dart in center.loops[0]]
    assert all(len(colors) == 1 for colors in ring)
    assert all(a != b for a, b in zip(ring, ring[1:] + ring[:1], strict=True))
    assert _points(instance) == 2 - len(instance.cells) - 1 + len(instance.edges)
    assert instance.known is not None and instance.known.paper is not None
    assert instance.known.paper.segments == hub_minimum([color for (color,) in ring])


def test_hub_minimum_is_that_over_all_partitions() -> None:
    """A block of k petals of one color saves k - 1 segments."""
    for seed in range(20):
        ring = [cell.colors[0] for cell in hub(seed, 8, 3).cells[1:]]
        best = min(
            len(blocks)
            for blocks in noncrossing(8)
            if all(len({ring[i] for i in block}) == 1 for block in blocks)
        )
        assert hub_minimum(ring) == best


@pytest.mark.parametrize(
    ("rows", "columns", "colors", "side"), [(1, 2, 2, 2), (1, 3, 3, 1), (2, 2, 2, 1), (2, 2, 3, 1)]
)
def test_hub_grid_against_brute_force(rows: int, columns: int, colors: int, side: int) -> None:
    for seed in range(3):
        instance = hub_grid(seed, rows, columns, colors, side)
        answer = CpSatSolver().minimize(instance, Options(workers=1))
        assert answer.lower_bound == minimum(instance)


@pytest.mark.parametrize("self_edges", [False, True])
def test_planar_graphs_are_planar_and_connected(self_edges: bool) -> None:
    kinds: Counter[str] = Counter()
    for seed in range(40):
        instance = planar_graph(seed, 5, 9, 3, self_edges=self_edges)
        assert len(instance.edges) == 9 and all(len(cell.loops) == 1 for cell in instance.cells)
        assert _points(instance) == 2 - 5 + 9
        for edge in instance.edges:
            shared = set(instance.cells[edge.left].colors) & set(instance.cells[edge.right].colors)
            kinds["self-edge"] += edge.left == edge.right
            kinds["dead"] += not instance.joinable(edge.id)
            kinds["partly dead"] += 0 < len(instance.joinable(edge.id)) < len(shared)
    assert (kinds["self-edge"] > 0) == self_edges
    assert kinds["dead"] > 0 and kinds["partly dead"] > 0


def _points(instance: Instance) -> int:
    """The points where areas meet. On a sphere, with the outside as one more area of as many loops
    as it takes, Euler's formula fixes how many there are."""
    place = {
        d: (loop, i) for cell in instance.cells for loop in cell.loops for i, d in enumerate(loop)
    }
    outer = [edge.id for edge in instance.edges if edge.right == OUTSIDE]
    assert all(edge.left != OUTSIDE for edge in instance.edges)
    if outer:  # the outside's one loop, walked the other way round than its cells are
        around = tuple(-edge for edge in reversed(outer))
        place |= {dart: (around, i) for i, dart in enumerate(around)}
    points, seen = 0, set[int]()
    for first in place:
        points += first not in seen
        dart = first
        while dart not in seen:
            seen.add(dart)
            loop, i = place[-dart]
            dart = loop[i - 1]
    return points


EULER = {"disc": 1, "annulus": 0, "sphere": 2, "torus": 0, "double torus": -2}
BORDERS = {"disc": 1, "annulus": 2, "sphere": 0, "torus": 0, "double torus": 0}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("size", [6, 7, 20])
def test_meshes_have_the_genus_of_their_shape_and_face_outward(shape: Topology, size: int) -> None:
    """Euler's formula, how many loops the border has, and a positive volume or area."""
    vertices, faces = make_mesh(shape, size)
    assert 0.7 <= len(vertices) / size**2 <= 1.4
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    assert mesh.euler_number == EULER[shape]
    assert len(mesh.outline().entities) == BORDERS[shape]
    if BORDERS[shape]:
        assert (mesh.face_normals[:, 2] > 0).all()
    else:
        assert mesh.is_winding_consistent and mesh.volume > 0


@examples(30)
@given(
    st.integers(0, 10**6),
    st.sampled_from(SHAPES),
    st.integers(6, 16),
    st.floats(0, 1),
    st.integers(1, 7),
    st.fixed_dictionaries(
        {
            "scattered": st.booleans(),
            "cracks": st.integers(0, 4),
            "islands": st.integers(0, 3),
            "holes": st.integers(0, 2),
        }
    ),
)
def test_voronoi_surfaces_are_legal(
    seed: int, shape: Topology, size: int, share: float, colors: int, more: Any
) -> None:
    """Surface and instance check themselves; the decomposition refuses cells with a handle."""
    decompose(voronoi(seed, shape, size, 1 + int(share * 0.7 * size**2), colors, **more))


@pytest.mark.parametrize("shape", ["torus", "double torus"])
def test_one_region_with_a_handle_is_cut(shape: Topology) -> None:
    """A single region that every color reaches is the whole surface, which is not planar."""
    for seed in range(5):
        instance = decompose(voronoi(seed, shape, 10, 1, 2, coverage=(1.0, 1.0)))
        assert len(instance.cells) > 1


def test_voronoi_surfaces_are_as_large_as_asked() -> None:
    """Neighbors with equal sets are rare among 2^6: nearly every region is a cell."""
    assert 50 <= len(decompose(voronoi(1, "sphere", 30, 60, 6, scattered=True)).cells) <= 60


@pytest.mark.parametrize(("scattered", "least", "most"), [(False, 4, 4), (True, 9, 99)])
def test_grown_colors_are_connected(scattered: bool, least: int, most: int) -> None:
    """Four colors, in as many parts or in more."""
    surface = voronoi(2, "sphere", 24, 80, 4, scattered=scattered, coverage=(0.3, 0.4))
    mesh: nx.Graph[int] = nx.Graph(list(surface.left_of))
    parts = 0
    for color in range(4):
        own = [v for v, colors in enumerate(surface.vertex_colors) if color in colors]
        parts += nx.number_connected_components(mesh.subgraph(own))
    assert least <= parts <= most


REGISTERED = [
    pytest.param(family, id=f"{size} {name}")
    for size, families in (("small", SMALL), ("medium", MEDIUM), ("large", LARGE))
    for name, family in families.items()
    if (size, name) != ("medium", "64 × 64 points, 10 colors")
]
"""Those that are made within a second."""


@pytest.mark.parametrize("family", REGISTERED)
def test_registered_families_are_functions_of_a_seed(family: Family) -> None:
    one, again, other = family(5), family(5), family(6)
    assert one.sha256 == again.sha256 != other.sha256


@pytest.mark.parametrize("name", SMALL)
def test_small_families_are_what_every_solver_can_bear(name: str) -> None:
    """No more live darts than a search over all divisions of a cell has time for."""
    for seed in range(8):
        made = SMALL[name](seed)
        instance = made if isinstance(made, Instance) else decompose(made)
        darts = max(
            sum(bool(instance.joinable(dart)) for loop in cell.loops for dart in loop)
            for cell in instance.cells
        )
        assert 2 <= len(instance.cells) <= 16 and darts <= 9
