"""Refined surfaces: the same topological graph, and the old vertices as they were."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from relabelled import isomorphic

from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.lab.families.surfaces import voronoi
from cellcolor.painting.refined import interpolated, unrefined
from examples import examples

SHAPES = st.sampled_from(["disc", "annulus", "sphere", "torus"])


@given(st.integers(0, 10**6), SHAPES, st.integers(0, 4), st.floats(0.02, 1.0), st.integers(1, 3))
@examples(20)
def test_the_graph_stays_what_it_was(
    seed: int, shape: str, cracks: int, share: float, rounds: int
) -> None:
    """Whatever is marked to be refined, and however often: held to an independent isomorphism."""
    surface = voronoi(seed, shape, size=9, regions=12, colors=3, cracks=cracks, holes=1)
    rng = np.random.default_rng(seed)
    refined = unrefined(surface)
    for _ in range(rounds):
        refined = refined.halved(rng.random(len(refined.mesh.points)) < share)
    finer = refined.surface()
    count = len(surface.vertices)
    # Places are values like any other: what is interpolated from the old ones is where it is.
    assert np.allclose(interpolated(refined.between, surface.vertices), finer.vertices)
    assert (refined.between[count:] < np.arange(count, len(finer.vertices))[:, None]).all()
    assert np.array_equal(finer.vertices[:count], surface.vertices)
    assert finer.vertex_colors[:count] == surface.vertex_colors
    assert isomorphic(decompose(finer), decompose(surface))


def test_one_edge_between_two_cells_with_a_crack() -> None:
    """By hand: the middle copies the marked end, and the crack stays beyond it."""
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    surface = LabelledSurface(
        "square", ("a", "b"), square, [[0, 1, 2], [0, 2, 3]], ((0, 1), (0,), (0,), (0,)),
        (Crack(0, 2, (0,)),), given_up=(),
    )  # fmt: skip
    finer = unrefined(surface).halved(np.array([True, False, False, False])).surface()
    # New vertices in the middle of 0-1, 0-2 and 0-3, in this order, all with the colors of 0.
    assert finer.vertices[4:].tolist() == [[0.5, 0, 0], [0.5, 0.5, 0], [0, 0.5, 0]]
    assert finer.vertex_colors[4:] == ((0, 1),) * 3
    # 0-2 is 0-5-2 now: vertex 5 stands for 0, so that the crack is between 5 and 2. Of the first
    # face a square 4-1-2-5 is left, parted between 2 and 4: that stands for 2-0 as well.
    assert finer.cracks == (Crack(2, 4, (0,)), Crack(2, 5, (0,)))


def test_values_of_vertices_reach_the_new_ones() -> None:
    """By hand, two rounds: numbers, and rows of any shape."""
    triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    surface = LabelledSurface("triangle", ("a",), triangle, [[0, 1, 2]], ((0,),) * 3)
    once = unrefined(surface).halved(np.array([True, False, False]))
    twice = once.halved(np.array([False, False, False, True, False]))
    # 3 is between 0 and 1, 4 between 0 and 2; then 5 to 8 between 3 and its neighbors.
    assert twice.between[3:].tolist() == [[0, 1], [0, 2], [0, 3], [1, 3], [2, 3], [3, 4]]
    found = interpolated(twice.between, np.array([0.0, 8.0, 16.0]))
    assert found.tolist() == [0, 8, 16, 4, 8, 2, 6, 10, 6]
    assert interpolated(twice.between, np.eye(3))[8].tolist() == [0.5, 0.25, 0.25]
