"""Cut triangles: the same surface, neighbors that fit, and the shorter diagonal."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from triangles import any_meshes, bumpy_ball

from cellcolor.mesh.dividing import cut, halved, new_points, with_longest_sides
from cellcolor.mesh.triangle_mesh import TriangleMesh, directed_edges

SEEDS, SHARES = st.integers(0, 10**6), st.floats(0.0, 1.0)


def spread(mesh: TriangleMesh, seed: int, share: float) -> np.ndarray:
    return np.random.default_rng(seed).random(len(mesh.edges)) < share


@given(any_meshes(), SEEDS, SHARES)
def test_halved_edges_of_any_mesh(mesh: TriangleMesh, seed: int, share: float) -> None:
    """Marked edges are gone, all others stay, and every triangle is the sum of its pieces."""
    marked = spread(mesh, seed, share)
    finer, of = halved(mesh, marked)
    count = len(mesh.points)
    assert np.array_equal(finer.points[:count], mesh.points)
    edges = mesh.edges.tolist()
    new = [number for number, is_marked in enumerate(marked) if is_marked]
    middles = {number: count + place for place, number in enumerate(new)}
    for number, middle in middles.items():
        a, b = mesh.points[edges[number]]
        assert np.array_equal(finer.points[middle], (a + b) / 2)
    left = {tuple(ends) for ends in finer.edges.tolist()}
    for number, (a, b) in enumerate(edges):
        if number in middles:
            assert (a, b) not in left
            assert {(a, middles[number]), (b, middles[number])} <= left
        else:
            assert (a, b) in left
    sums = np.zeros_like(mesh.area_vectors)
    np.add.at(sums, of, finer.area_vectors)
    assert np.allclose(sums, mesh.area_vectors)
    assert np.allclose(np.bincount(of, finer.areas, len(mesh.corners)), mesh.areas)


@given(SEEDS, SHARES)
def test_neighbors_fit_and_quadrilaterals_are_parted_on_the_short_way(
    seed: int, share: float
) -> None:
    mesh = bumpy_ball(seed)
    marked = spread(mesh, seed, share)
    shares = np.random.default_rng(seed + 1).uniform(0.1, 0.9, (int(marked.sum()), 1))
    ends = mesh.points[mesh.edges[marked]]
    points = np.concatenate([mesh.points, (1 - shares) * ends[:, 0] + shares * ends[:, 1]])
    new = new_points(mesh, marked)
    for places in (None, points):
        corners, of = cut(mesh, new, points=places)
        directed_edges(corners, len(points))  # refuses what is not manifold
        pieces = TriangleMesh(points, corners)
        assert np.bincount(of, pieces.areas) == pytest.approx(mesh.areas)
    edges = {tuple(pair) for pair in pieces.edges.tolist()}
    for corner, sides in zip(mesh.corners.tolist(), new[mesh.edge_of_side].tolist(), strict=True):
        if sum(side >= 0 for side in sides) != 2:
            continue
        k = (sides.index(-1) + 1) % 3
        a, c = corner[k], corner[k - 1]
        ab, bc = sides[k], sides[(k + 1) % 3]
        first, second = (np.linalg.norm(points[i] - points[j]) for i, j in ((a, bc), (c, ab)))
        assert ((a, bc) if first < second else (c, ab)) in edges


@given(SEEDS, st.floats(0.0, 0.3))
def test_longest_sides_are_marked_with_others(seed: int, share: float) -> None:
    mesh = bumpy_ball(seed)
    asked = spread(mesh, seed, share)
    marked = with_longest_sides(mesh, asked)
    assert (marked >= asked).all()
    for sides in mesh.edge_of_side:
        if marked[sides].any():
            assert marked[sides[np.argmax(mesh.lengths[sides])]]
    # No more than needed: each other marked edge is the longest of a triangle with one marked.
    needed = asked.copy()
    for _ in range(len(needed)):
        for sides in mesh.edge_of_side[needed[mesh.edge_of_side].any(axis=1)]:
            needed[sides[np.argmax(mesh.lengths[sides])]] = True
        if (needed == marked).all():
            break
    assert (needed == marked).all()
