"""Paintings: every division of a surface's cells becomes one color per vertex."""

from __future__ import annotations

import copy
import pickle
import random
from dataclasses import replace

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from library import INSTANCES, PAPER
from random_divisions import random_division, random_seams

import cellcolor
from cellcolor.data.solution import InstanceReference, Solution, count_segments
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import InputError
from cellcolor.lab.families.voronoi import voronoi
from cellcolor.painting.paint import paint
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

SURFACES = sorted(
    [*INSTANCES.glob("paper/*.surface.json"), *INSTANCES.glob("random/*.surface.json")]
)


@pytest.mark.parametrize("path", SURFACES, ids=lambda path: path.name.partition(".")[0])
@pytest.mark.parametrize("space", ["paper", "surface"])
def test_the_library_is_painted_as_proved(path: object, space: str) -> None:
    surface = LabelledSurface.read(path)
    decomposition = decomposition_of(surface)
    solution = solve(decomposition.instance, Options(space))
    painted = paint(surface, decomposition, solution)
    # Whatever is proved for the surface cannot be undercut, and nothing is painted in more.
    assert painted.segments == solution.segments if solution.proved_for_surface else True
    assert painted.segments <= solution.segments
    assert_whole(surface, painted, solution)


@given(
    st.integers(0, 10**6),
    st.sampled_from(["disc", "annulus", "sphere", "torus", "double torus"]),
    st.integers(1, 3),
)
@settings(max_examples=60, deadline=None)
def test_any_division_is_painted(seed: int, shape: str, strands: int) -> None:
    """Divisions drawn at random: cells of one vertex, cracks, holes, seams, several strands."""
    rng = random.Random(seed)
    surface = voronoi(
        seed, shape, size=rng.randint(8, 12), regions=rng.randint(3, 20), colors=rng.randint(2, 4),
        scattered=rng.random() < 0.5, cracks=rng.choice((0, 4)), islands=rng.choice((0, 3)),
        holes=rng.choice((0, 2)),
    )  # fmt: skip
    decomposition = decomposition_of(surface)
    instance = decomposition.instance
    seams = random_seams(instance, 2, rng)
    division = random_division(instance, seams, strands, rng)
    segments = count_segments(division)
    solution = Solution(
        InstanceReference(instance.name, instance.sha256), "surface", strands, "by chance",
        "feasible", segments, max(0, segments - 1), 0, 0, False, seams, division, 0.0,
    )  # fmt: skip
    assert_whole(surface, paint(surface, decomposition, solution), solution)


def assert_whole(surface: LabelledSurface, painted: object, solution: Solution) -> None:
    """Every segment is one connected set of vertices in a color that all of them have.

    Flooded here over the refined mesh, with neither the checker nor the graph.
    """
    fine = painted.surface
    assert fine.vertex_colors[: len(surface.vertices)] == surface.vertex_colors
    assert np.allclose(painted.interpolated(surface.vertices), fine.vertices)
    color = {sub.segment: sub.color for cell in solution.cells for sub in cell.subcells}
    cracks = {(crack.i, crack.j): crack.colors for crack in fine.cracks}
    members: dict[int, nx.Graph] = {}
    for vertex, segment in enumerate(painted.segment_of.tolist()):
        own = fine.vertex_colors[vertex]
        assert (segment == -1) == (not own)
        if own:
            assert color[segment] in own
            assert painted.plan.vertex_colors[vertex] == color[segment]
            members.setdefault(segment, nx.Graph()).add_node(vertex)
    for a, b in fine.left_of:
        segment = painted.segment_of[a]
        if segment == -1 or segment != painted.segment_of[b]:
            continue
        if color[segment] not in cracks.get((min(a, b), max(a, b)), ()):
            members[segment].add_edge(a, b)
    assert all(nx.is_connected(graph) for graph in members.values())
    # What hangs on seams only is no part of the surface; all else is painted.
    assert len(members) <= solution.segments
    assert painted.segments == len(members) - sum(len(group) - 1 for group in painted.merged)


def test_a_solution_without_a_division_is_refused() -> None:
    surface = LabelledSurface(
        "none", ("a",), [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], ((),) * 3
    )
    decomposition = decomposition_of(surface)
    with pytest.raises(InputError, match="cells: holds no division to paint"):
        paint(surface, decomposition, solve(decomposition.instance, Options()))


def test_values_are_interpolated_for_the_vertices_of_the_given_surface_only() -> None:
    surface = LabelledSurface.read(PAPER / "parallel-corridors.surface.json")
    painted = cellcolor.paint(surface, cellcolor.solve(surface, search_space="surface"))
    with pytest.raises(InputError, match="values: has 1 rows for"):
        painted.interpolated(surface.vertices[:1])


def test_a_painting_is_a_value() -> None:
    surface = LabelledSurface.read(PAPER / "parallel-corridors.surface.json")
    result = cellcolor.solve(surface, search_space="surface")
    painting = cellcolor.paint(surface, result)
    again = pickle.loads(pickle.dumps(painting))
    assert again == painting == copy.deepcopy(painting) and hash(again) == hash(painting)
    assert painting != replace(painting, segment_of=painting.segment_of[::-1])
    assert painting != "painting"
    assert repr(painting) == f"<Painted {painting}>"
