"""A graph that is its surface's, however it is written, and one that is not."""

from __future__ import annotations

import random
from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st
from relabelled import turned

from cellcolor.decomposition import decomposition_of
from cellcolor.decomposition.same_graph import wrong_cell
from cellcolor.lab.families.voronoi import voronoi
from examples import examples

SHAPES = st.sampled_from(["disc", "annulus", "sphere", "torus"])


@given(st.integers(0, 10**6), SHAPES)
@examples(30)
def test_a_graph_is_known_again_and_a_changed_one_is_not(seed: int, shape: str) -> None:
    """Where loops begin does not matter; an edge that joins another color does."""
    rng = random.Random(seed)
    surface = voronoi(seed, shape, size=8, regions=rng.randint(3, 12), colors=rng.randint(2, 4))
    decomposition = decomposition_of(surface)
    instance, cells = decomposition.instance, decomposition.vertex_cell
    assert wrong_cell(surface, instance, cells) is None
    assert wrong_cell(surface, turned(instance, rng), cells) is None
    live = [edge for edge in instance.edges if instance.joinable(edge.id)]
    if not live:
        return
    edge = rng.choice(live)
    fewer = instance.joinable(edge.id)[1:]
    edges = tuple(replace(e, colors=fewer) if e.id == edge.id else e for e in instance.edges)
    assert wrong_cell(surface, replace(instance, edges=edges), cells) is not None
