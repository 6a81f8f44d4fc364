"""Borders that are moved: segments stay whole, borders get cheap and short."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from painted import assert_whole, mean_cost, random_solution

from cellcolor.data.plan import Plan
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import InputError
from cellcolor.lab.families.meshes import grid_faces
from cellcolor.lab.families.surfaces import voronoi
from cellcolor.painting.moving import move_borders
from cellcolor.painting.paint import Painted, paint
from examples import examples


def grid(
    columns: int, rows: int, segment: list[list[int]], cracks: tuple[Crack, ...] = (), **own: object
) -> Painted:
    """A painting of a grid of 1 m squares; each segment in a color of its own, which is everywhere.

    Args:
        segment: of each vertex, row by row.
        own: ``c3=(0, 1)``, say: the vertices of column 3 have these colors only.
    """
    places = [[x, y, 0.0] for y in range(rows) for x in range(columns)]
    numbers = np.array(segment, dtype=np.int64).ravel()
    every = tuple(range(int(numbers.max()) + 1))
    colors = tuple([own.get(f"c{int(x)}", every) for x, _, _ in places])
    surface = LabelledSurface(
        "grid", tuple(f"c{k}" for k in every), places, grid_faces(rows, columns), colors, cracks
    )
    same = np.arange(len(places))
    plan = Plan(tuple(numbers.tolist()))
    return Painted(surface, plan, len(every), numbers, same, np.stack([same, same], axis=1), ())


@given(st.integers(0, 10**6), st.sampled_from(["disc", "annulus", "sphere", "torus"]))
@example(1, "annulus")  # a segment falls apart unless both are looked at, cracks respected
@example(4, "disc")  # a segment closes in on itself unless that is looked at
@example(2, "sphere")  # segments of one color become one unless that is looked at
@examples(20)
def test_segments_stay_what_they_are(seed: int, shape: str) -> None:
    """Random divisions, random costs: held to a flooding of the mesh."""
    rng = random.Random(seed)
    surface = voronoi(
        seed, shape, size=rng.randint(8, 12), regions=rng.randint(3, 9), colors=rng.randint(2, 4),
        coverage=(0.5, 0.9), cracks=rng.choice((0, 6)), holes=rng.choice((0, 2)),
    )  # fmt: skip
    decomposition = decomposition_of(surface)
    solution = random_solution(decomposition.instance, rng.randint(1, 2), rng)
    drawn = paint(surface, decomposition, solution)
    shape = (len(drawn.surface.vertices), len(surface.colors))
    cost = np.random.default_rng(seed).random(shape) if seed % 2 else None
    moved = move_borders(drawn, cost=cost)
    assert_whole(surface, moved, solution)
    assert moved.merged == drawn.merged and moved.segments == drawn.segments


def length_by_hand(painting: Painted) -> float:
    """Triangle by triangle: what lies between the parts of different segments."""
    total = 0.0
    for face in painting.surface.faces.tolist():
        places = painting.surface.vertices[face]
        own = painting.segment_of[face]
        crossed = [
            (places[k] + places[k - 1]) / 2
            for k in range(3)
            if own[k] != own[k - 1] and -1 not in (own[k], own[k - 1])
        ]
        if len(crossed) == 2:
            total += math.dist(*crossed)
        else:
            total += sum(math.dist(middle, places.mean(axis=0)) for middle in crossed)
    return total


def test_a_border_becomes_straight() -> None:
    """Teeth between two ends that only one color reaches: the shortest border is straight."""
    rows = [[0] * (9 if y % 4 < 2 else 5) + [1] * (6 if y % 4 < 2 else 10) for y in range(12)]
    drawn = grid(15, 12, rows, c0=(0,), c14=(1,))
    moved = move_borders(drawn)
    assert length_by_hand(drawn) > 25
    assert length_by_hand(moved) == pytest.approx(11, abs=0.5)


def test_a_border_goes_where_colors_cost_the_same() -> None:
    """Color 0 is good on the left, color 1 on the right; the border begins far from there."""
    drawn = grid(21, 8, [[0] * 3 + [1] * 18] * 8)
    way = drawn.surface.vertices[:, 0] / 20
    cost = np.stack([way, 1 - way], axis=1)
    moved = move_borders(drawn, cost=cost)
    assert mean_cost(moved, cost) < mean_cost(drawn, cost)
    # The same cost is at x = 10. Length has no part in it: it is 7 m everywhere.
    border = moved.segment_of.reshape(8, 21).sum(axis=1)
    assert (abs(border - 10.5) <= 1).all()


def test_a_crack_holds_a_segment_together_as_it_is() -> None:
    """Beside a crack of its color a segment hangs together round the crack's end only."""
    columns, rows = 9, 7
    surface = grid(columns, rows, [[0] * columns] * rows).surface
    cracked = tuple(
        Crack(a, b, (0,))
        for a, b in sorted({(min(e), max(e)) for e in surface.left_of})
        if {a % columns, b % columns} == {3, 4} and max(a, b) < columns * (rows - 1)
    )
    # Segment 0 goes round the crack through the last row; segment 1 is a spot above that.
    spot = [[0] * columns for _ in range(rows)]
    for y in range(3, 5):
        spot[y][6] = 1
    moved = move_borders(grid(columns, rows, spot, cracked))
    numbers = moved.segment_of.reshape(rows, columns)
    assert (numbers[rows - 1, 3:5] == 0).all() and moved.segments == 2


@pytest.mark.parametrize("radius", [0.0, -1.0, math.inf, math.nan])
def test_a_radius_is_positive(radius: float) -> None:
    drawn = grid(4, 4, [[0, 0, 1, 1]] * 4)
    with pytest.raises(InputError, match="tool_radius_m: must be a positive number of meters"):
        move_borders(drawn, radius)


def test_a_cost_is_finite_and_given_for_each_vertex_and_color() -> None:
    drawn = grid(4, 4, [[0, 0, 1, 1]] * 4)
    for cost in (np.zeros((16, 3)), np.zeros(16), np.full((16, 2), np.nan)):
        with pytest.raises(InputError, match=r"cost: needs a finite number for each of \(16, 2\)"):
            move_borders(drawn, cost=cost)
