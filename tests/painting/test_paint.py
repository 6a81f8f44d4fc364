"""Paintings: every division of a surface's cells becomes one color per vertex."""

from __future__ import annotations

import copy
import pickle
import random
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES, PAPER
from painted import assert_whole, random_solution

import cellcolor
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import InputError
from cellcolor.lab.families.surfaces import voronoi
from cellcolor.painting.paint import paint
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options
from examples import examples

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
@examples(30)
def test_any_division_is_painted(seed: int, shape: str, strands: int) -> None:
    """Divisions drawn at random: cells of one vertex, cracks, holes, seams, several strands."""
    rng = random.Random(seed)
    surface = voronoi(
        seed, shape, size=rng.randint(8, 12), regions=rng.randint(3, 20), colors=rng.randint(2, 4),
        scattered=rng.random() < 0.5, cracks=rng.choice((0, 4)), islands=rng.choice((0, 3)),
        holes=rng.choice((0, 2)),
    )  # fmt: skip
    decomposition = decomposition_of(surface)
    solution = random_solution(decomposition.instance, strands, rng)
    assert_whole(surface, paint(surface, decomposition, solution), solution)


def test_a_solution_without_a_division_is_refused() -> None:
    surface = LabelledSurface(
        "none", ("a",), [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], ((),) * 3
    )
    decomposition = decomposition_of(surface)
    with pytest.raises(InputError, match="cells: contains no division to paint"):
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
