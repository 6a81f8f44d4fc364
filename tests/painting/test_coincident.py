"""Surfaces whose vertices coincide, whose triangles have no area, or that are one single point."""

from __future__ import annotations

import random
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from meshes import drawn, surfaces
from painted import assert_whole, random_solution

import cellcolor
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import CellcolorError
from cellcolor.lab.families.surfaces import voronoi
from cellcolor.painting.moving import move_borders
from cellcolor.painting.paint import paint
from examples import examples


def squeezed(surface: LabelledSurface, seed: int) -> LabelledSurface:
    """Many vertices put where a neighbor is, or all on a line, or all at one point."""
    rng = random.Random(seed)
    places = np.array(surface.vertices)
    how = rng.randrange(4)
    if how == 0:
        places[:] = 0.0
    elif how == 1:
        places[:, 1:] = 0.0
    else:
        for a, b in surface.left_of:
            if rng.random() < 0.3:
                places[a] = places[b]
    return replace(surface, vertices=places)


@given(st.integers(0, 10**6), st.sampled_from(["disc", "annulus", "sphere", "torus"]))
@examples(40)
def test_any_division_is_painted_where_vertices_coincide(seed: int, shape: str) -> None:
    rng = random.Random(seed)
    made = voronoi(seed, shape, size=8, regions=rng.randint(3, 12), colors=rng.randint(2, 4))
    surface = squeezed(made, seed)
    decomposition = decomposition_of(surface)
    solution = random_solution(decomposition.instance, 1, rng)
    painted = paint(surface, decomposition, solution)
    assert_whole(surface, painted, solution)
    moved = move_borders(painted)
    assert check_plan(moved.surface, moved.plan).segments == painted.segments


@given(surfaces(), st.integers(0, 10**6), st.data())
@examples(40)
def test_the_oracle_says_where_a_plan_without_area_can_be_beaten(
    made: LabelledSurface, seed: int, data: st.DataObject
) -> None:
    """The minimum is that of the surface as it was: places do not count for it."""
    surface = squeezed(made, seed)
    choices = [st.sampled_from(colors) if colors else st.none() for colors in made.vertex_colors]
    colors = data.draw(st.tuples(*choices))
    verdict = cellcolor.Oracle(surface, workers=1).judge(colors)
    before = cellcolor.Oracle(made, workers=1).judge(colors)
    assert (verdict.segments, verdict.bounds) == (before.segments, before.bounds)
    assert (verdict.improvement is None) == (before.improvement is None)
    if verdict.improvement is not None:
        segment_of = check_plan(surface, Plan(colors)).segment_of
        found = tuple(segment_of[vertex] for vertex in verdict.improvement.places)
        assert found == verdict.improvement.joined and found[0] < found[1]


@pytest.mark.parametrize("pattern", ["contour", "back-and-forth"])
@pytest.mark.parametrize("seed", [*range(5), pytest.param(5, marks=pytest.mark.second), 6, 7])
def test_tool_paths_on_coinciding_vertices_end_in_paths_or_in_a_sentence(
    pattern: str, seed: int
) -> None:
    pytest.importorskip("potpourri3d")
    surface = squeezed(drawn("AAAA AAAA AABB AABB", {"A": [0], "B": [1]}), seed)
    plan = Plan(tuple(colors[0] for colors in surface.vertex_colors))
    try:
        covered = cellcolor.cover(surface, plan, pattern=pattern, spacing_m=0.5, tool_radius_m=0.4)
    except CellcolorError as error:
        assert "\n" not in str(error)
    else:
        for path in covered.paths.paths:
            assert np.isfinite(np.array(path.points)).all()
