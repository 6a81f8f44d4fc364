"""Whether graphs are the same up to names, against a search that shares nothing with it."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
import relabelled
from hypothesis import given
from hypothesis import strategies as st
from relabelled import turned

from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.decomposition.isomorphic import isomorphic
from cellcolor.decomposition.same_graph import wrong_cell
from cellcolor.lab.families.voronoi import voronoi
from examples import examples

SHAPES = st.sampled_from(["disc", "annulus", "sphere", "torus"])


def graph(seed: int, shape: str) -> Instance:
    rng = random.Random(seed)
    surface = voronoi(seed, shape, size=6, regions=rng.randint(2, 8), colors=rng.randint(1, 3))
    instance = decomposition_of(surface).instance
    return replace(instance, surface=None, colors=tuple("abc"[: len(instance.colors)]))


def renumbered(instance: Instance, rng: random.Random) -> Instance:
    """Cells and edges numbered anew, some edges turned round, loops begun elsewhere."""
    instance = turned(instance, rng)
    cells = rng.sample(range(len(instance.cells)), len(instance.cells))
    ids = [edge.id for edge in instance.edges]
    new = {
        old: number * rng.choice((1, -1))
        for old, number in zip(ids, rng.sample(range(1, len(ids) + 1), len(ids)), strict=True)
    }
    dart = {sign * old: sign * number for old, number in new.items() for sign in (1, -1)}

    def cell_of(old: int) -> int:
        return old if old == OUTSIDE else cells[old]

    edges = []
    for edge in instance.edges:
        ends = cell_of(edge.left), cell_of(edge.right)
        left, right = ends if new[edge.id] > 0 else ends[::-1]
        edges.append(Edge(abs(new[edge.id]), left, right, edge.colors, edge.length))
    found = [
        Cell(cells[c.id], c.colors, tuple(tuple(dart[d] for d in loop) for loop in c.loops), c.area)
        for c in instance.cells
    ]
    return Instance(
        "renumbered", instance.colors, tuple(sorted(found, key=lambda c: c.id)), tuple(edges)
    )


def mirrored(instance: Instance) -> Instance:
    """The graph seen from inside: loops the other way round."""
    cells = tuple(
        replace(cell, loops=tuple(tuple(-d for d in loop[::-1]) for loop in cell.loops))
        for cell in instance.cells
    )
    edges = tuple(replace(edge, left=edge.right, right=edge.left) for edge in instance.edges)
    return replace(instance, cells=cells, edges=edges)


@given(st.integers(0, 10**6), SHAPES)
@examples(30)
def test_a_renumbered_graph_is_the_same(seed: int, shape: str) -> None:
    one = graph(seed, shape)
    other = renumbered(one, random.Random(seed))
    assert isomorphic(one, other)
    assert relabelled.isomorphic(one, other)


@given(st.integers(0, 10**6), SHAPES)
@examples(30)
def test_changed_graphs_are_told_apart_as_by_the_definition(seed: int, shape: str) -> None:
    """Mirrored, with fewer joinable colors on an edge, or with two edges' colors exchanged."""
    rng = random.Random(seed)
    one = graph(seed, shape)
    others = [mirrored(one), graph(seed + 1, shape)]
    live = [edge.id for edge in one.edges if one.joinable(edge.id)]
    if live:
        chosen = rng.choice(live)
        fewer = one.joinable(chosen)[1:]
        edges = tuple(replace(e, colors=fewer) if e.id == chosen else e for e in one.edges)
        others.append(replace(one, edges=edges))
    for other in others:
        if other.colors == one.colors:
            other = renumbered(other, rng)
            assert isomorphic(one, other) == relabelled.isomorphic(one, other)


def test_the_number_in_the_name_of_a_color_means_nothing_and_its_branch_does() -> None:
    """Two cells of one branch beside each other, each in a color of its own."""

    def chain(*colors: str) -> Instance:
        cells = (Cell(0, (0,), ((1, 2),)), Cell(1, (1,), ((-2, 3),)))
        edges = (Edge(1, 0, OUTSIDE), Edge(2, 0, 1), Edge(3, 1, OUTSIDE))
        return Instance("chain", colors, cells, edges)

    assert isomorphic(chain("up 1", "down"), chain("up 2", "down"))
    assert isomorphic(chain("up", "down"), chain("down", "up"))
    assert not isomorphic(chain("up", "down"), chain("up", "other"))
    assert not isomorphic(chain("up 1", "up 2"), chain("up", "down"))


def test_nothing_is_the_same_as_nothing() -> None:
    nothing = Instance("nothing", (), (), ())
    assert isomorphic(nothing, nothing)
    assert not isomorphic(nothing, graph(0, "disc"))


def test_a_deadline_ends_the_comparison() -> None:
    with pytest.raises(OutOfTime):
        isomorphic(graph(0, "disc"), graph(0, "disc"), Deadline.after(-1.0))


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
