"""What a walk leaves uncovered is reached by spurs."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from painted import flat_grid
from scipy.spatial import cKDTree

from cellcolor.deadline import NEVER
from cellcolor.tool_paths.registry import Laid
from cellcolor.tool_paths.spurs import with_spurs
from examples import examples

SPACING = 0.1
SIZE = 101  # vertices on a side of the square; they are a tenth of the spacing apart


SHEET = flat_grid(SIZE, SIZE, 1 / (SIZE - 1))


def back_and_forth(rows: list[int]) -> list[int]:
    """A walk along whole rows of vertices, and up at their ends, half a spacing from the border."""
    walk: list[int] = []
    for number, row in enumerate(rows):
        columns = range(5, SIZE - 5) if number % 2 == 0 else range(SIZE - 6, 4, -1)
        line = [row * SIZE + column for column in columns]
        if walk:
            low, column = divmod(walk[-1], SIZE)
            walk += [height * SIZE + column for height in range(low + 1, row)]
        walk += line
    return walk


def reversals(walk: list[int]) -> int:
    return sum(before == after for before, after in zip(walk, walk[2:], strict=False))


def uncovered(walk: list[int]) -> np.ndarray:
    """Which vertices are farther than 0.75 spacings from the walk's: the sheet is flat."""
    far = cKDTree(SHEET.points[np.unique(walk)]).query(SHEET.points)[0]
    return np.asarray(far > 0.76 * SPACING)


def test_a_strip_that_is_too_wide_is_reached_by_spurs_from_the_walk() -> None:
    """Rows are 14 steps apart, and 22 once. The walk stays, with ways there and back."""
    walk = back_and_forth([5, 19, 33, 55, 69, 83, 94])
    reached = with_spurs(Laid(SHEET, walk), SPACING, NEVER).walk
    assert reversals(reached) > 0
    assert set(walk) <= set(reached)
    assert uncovered(reached).sum() < 0.1 * uncovered(walk).sum()


@given(st.lists(st.integers(8, 24), min_size=12, max_size=12))
@examples(6)
def test_nothing_of_some_size_is_left(gaps: list[int]) -> None:
    rows = [row for row in np.cumsum([5, *gaps]).tolist() if row < SIZE - 4]  # up to the border
    walk = back_and_forth(rows)
    reached = with_spurs(Laid(SHEET, walk), SPACING, NEVER).walk
    assert (reached[0], reached[-1]) == (walk[0], walk[-1])
    steps = np.sort(np.array([reached[:-1], reached[1:]]).T, axis=1)
    assert (SHEET.edges[SHEET.find(steps)] == steps).all()
    # A small place may stay: a tenth of the spacing squared is 10 vertices.
    left = uncovered(reached).reshape(SIZE, SIZE)
    for row in range(SIZE - 3):
        for column in range(SIZE - 3):
            assert not left[row : row + 4, column : column + 4].all()
