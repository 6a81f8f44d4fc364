"""Random surfaces of any genus, hubs with loops: legal, seeded, as large."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from cellcolor.lab.families import (
    SHAPES,
    Topology,
    hub_with_loops,
    voronoi,
)
from cellcolor.lab.families.meshes import make_mesh
from cellcolor.mesh.oriented import directed_edges
from examples import examples

pytestmark = pytest.mark.second

EULER = {"disc": 1, "annulus": 0, "sphere": 2, "torus": 0, "double torus": -2}
BORDERS = {"disc": 1, "annulus": 2, "sphere": 0, "torus": 0, "double torus": 0}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("size", [6, 7, 20])
def test_meshes_have_the_genus_of_their_shape(shape: Topology, size: int) -> None:
    """Euler's formula, and how many loops the border has; the mesh itself refuses non-manifolds."""
    vertices, faces = make_mesh(shape, size)
    assert 0.7 <= len(vertices) / size**2 <= 1.4
    third = directed_edges(faces, len(vertices))
    edges = {(min(a, b), max(a, b)) for a, b in third}
    assert len(vertices) - len(edges) + len(faces) == EULER[shape]
    following = {b: a for a, b in third if (b, a) not in third}
    loops = 0
    while following:
        loops += 1
        vertex = next(iter(following))
        while vertex in following:
            vertex = following.pop(vertex)
    assert loops == BORDERS[shape]


@pytest.mark.parametrize("shape", SHAPES)
def test_meshes_face_outward(shape: Topology) -> None:
    """A closed mesh has a positive volume, a flat one positive areas."""
    vertices, faces = make_mesh(shape, 12)
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    normals = np.cross(b - a, c - a)
    if BORDERS[shape]:
        assert (normals[:, 2] > 0).all()
    else:
        assert (a * normals).sum() > 0


@examples(30)
@given(
    seed=st.integers(0, 10**6),
    shape=st.sampled_from(SHAPES),
    size=st.integers(6, 16),
    share=st.floats(0, 1),
    colors=st.integers(1, 7),
    scattered=st.booleans(),
    cracks=st.integers(0, 4),
    islands=st.integers(0, 3),
    holes=st.integers(0, 2),
)
def test_voronoi_surfaces_are_legal(
    seed: int,
    shape: Topology,
    size: int,
    share: float,
    colors: int,
    scattered: bool,
    cracks: int,
    islands: int,
    holes: int,
) -> None:
    """Surface and instance check themselves; the decomposition refuses cells with a handle."""
    regions = 1 + int(share * 0.7 * size**2)
    surface = voronoi(
        seed,
        shape,
        size,
        regions,
        colors,
        scattered=scattered,
        cracks=cracks,
        islands=islands,
        holes=holes,
    )
    decompose(surface)


@pytest.mark.parametrize("shape", ["torus", "double torus"])
def test_one_region_with_a_handle_is_cut(shape: Topology) -> None:
    """A single region that every color reaches is the whole surface, which is not planar."""
    for seed in range(5):
        instance = decompose(voronoi(seed, shape, 10, 1, 2, coverage=(1.0, 1.0)))
        assert len(instance.cells) > 1


def test_voronoi_surfaces_are_seeded_and_as_large_as_asked() -> None:
    one, again, other = (
        voronoi(s, "annulus", 20, 60, 6, cracks=3, islands=2, holes=2) for s in (3, 3, 4)
    )
    assert one.to_json() == again.to_json() != other.to_json()
    assert one.cracks and () in one.vertex_colors
    # Neighbors with equal sets are rare among 2^6: nearly every region is a cell.
    assert 50 <= len(decompose(voronoi(1, "sphere", 30, 60, 6, scattered=True)).cells) <= 60


def test_grown_colors_are_connected_and_scattered_ones_are_not() -> None:
    def components(scattered: bool) -> int:
        surface = voronoi(2, "sphere", 24, 80, 4, scattered=scattered, coverage=(0.3, 0.4))
        third = directed_edges(surface.faces, len(surface.vertices))
        count = 0
        for color in range(4):
            left = {v for v, own in enumerate(surface.vertex_colors) if color in own}
            while left:
                count += 1
                stack = [left.pop()]
                while stack:
                    vertex = stack.pop()
                    found = {b for a, b in third if a == vertex and b in left}
                    left -= found
                    stack += found
        return count

    assert components(False) == 4
    assert components(True) > 8


def test_hub_with_loops_has_a_ring_round_each() -> None:
    instance = hub_with_loops(3, 5, 4, 4)
    assert len(instance.cells) == 21
    assert [len(loop) for loop in instance.cells[0].loops] == [4] * 5
    for loop in instance.cells[0].loops:
        ring = [instance.cells[instance.across(dart)].colors[0] for dart in loop]
        assert all(a != b for a, b in zip(ring, ring[1:] + ring[:1], strict=True))
    assert hub_with_loops(3, 5, 4, 4).to_json() == instance.to_json()
    assert hub_with_loops(4, 5, 4, 4).to_json() != instance.to_json()
    assert _characteristic(instance) == 2


def _characteristic(instance: Instance) -> int:
    """2 on a sphere: each loop of each cell, and of what is unreachable, is glued to a disc.

    Walking from a dart to the one that ends where it begins gives the points where areas meet.
    """
    after: dict[int, int] = {}
    for cell in instance.cells:
        for loop in cell.loops:
            after |= dict(zip(loop, loop[1:] + loop[:1], strict=True))
    outer = [
        dart
        for edge in instance.edges
        for dart, side in ((edge.id, edge.left), (-edge.id, edge.right))
        if side == OUTSIDE
    ]
    # The ring of outer edges runs against the petals.
    by_petal = {instance.edge(dart).left: dart for dart in outer}
    first = 1
    for loop in instance.cells[0].loops:
        petals = list(range(first, first + len(loop)))
        for here, following in zip(petals, petals[1:] + petals[:1], strict=True):
            after[by_petal[following]] = by_petal[here]
        first += len(loop)
    points, seen = 0, set[int]()
    for dart in after:
        points += dart not in seen
        while dart not in seen:
            seen.add(dart)
            dart = after[-dart]
    holes = len(instance.cells[0].loops)
    # The hub is a sphere with so many holes, petals and what is unreachable are discs.
    return points - len(instance.edges) + (2 - holes) + (len(instance.cells) - 1) + holes


@pytest.mark.parametrize(
    "make",
    [
        lambda: voronoi(0, "torus", 5),
        lambda: voronoi(0, "disc", 8, 0),
        lambda: voronoi(0, "disc", 8, 65),
        lambda: voronoi(0, "disc", 8, 5, 0),
        lambda: hub_with_loops(0, 0, 4, 4),
        lambda: hub_with_loops(0, 2, 3, 2),
    ],
)
def test_impossible_families_are_refused(make: object) -> None:
    with pytest.raises(InputError):
        make()  # type: ignore[operator]
