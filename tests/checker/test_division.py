"""Is a division legal? Each fault alone, and what is legal although it is superfluous."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from divisions import BLUE, RED, SPLIT, divide, split_solution
from library import PAPER
from rooms import graph, hub, petal_cells

from cellcolor.checker.division import check_division, check_solution
from cellcolor.data.cells_and_edges import DartName
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division

CROSSING = Instance.read(PAPER / "crossing-zeros.json")

CRACK = Instance.read(PAPER / "crack-partial.json")


def test_a_right_solution_is_valid() -> None:
    report = check_solution(SPLIT, split_solution())
    assert report.valid and report.is_scheme and report.segments == 2, report


def with_cell(number: int, *subs: tuple[int, list[DartName], int]) -> Callable[[], Division]:
    """The right division of split-cell with another division of one cell."""

    def change() -> Division:
        cells = list(split_solution().cells or ())
        cells[number] = divide(*[[]] * number, list(subs))[number]
        return tuple(cells)

    return change


@pytest.mark.parametrize(
    ("division", "expected"),
    [
        (with_cell(0), "cells[0].subcells: needs at least one sub-cell"),
        (with_cell(0, (RED, [3], 0)), "cells[0].subcells[0].color: cell 0 cannot be painted"),
        (with_cell(0, (BLUE, [1, 3], 0)), "cells[0].subcells[0].darts: 1 is not a live dart"),
        (with_cell(0, (BLUE, [3, -3], 0)), "cells[0].subcells[0].darts: -3 is not a live dart"),
        (with_cell(0, (BLUE, [3, 3], 0)), "cells[0].subcells[0].darts: 3 appears twice"),
        (with_cell(0, (BLUE, [], 0)), "edge 3: in state 1 on one side only"),
        (
            with_cell(2, (RED, [-3, -6], 0), (RED, [11, 8], 1)),
            "edge 3: joins two different colors",
        ),
        (with_cell(0, (BLUE, [3], 1)), "one segment has numbers [0, 1]"),
        (
            lambda: divide(
                [(BLUE, [3], 0)],
                [(BLUE, [6], 0)],
                [(BLUE, [-3, -6], 0), (RED, [11, 8], 0)],
                [(RED, [-8], 0)],
                [(RED, [-11], 0)],
            ),
            "segment 0: stands for 2 separate segments",
        ),
        (
            lambda: divide(
                [(BLUE, [3], 1)],
                [(BLUE, [6], 1)],
                [(BLUE, [-3, -6], 1), (RED, [11, 8], 2)],
                [(RED, [-8], 2)],
                [(RED, [-11], 2)],
            ),
            "segment numbers must be 0 to 1",
        ),
        (lambda: (split_solution().cells or ())[1:], "cells: must be cells 0 to 4"),
    ],
)
def test_divisions_are_checked(division: Callable[[], Division], expected: str) -> None:
    report = check_division(SPLIT, division())
    assert any(expected in problem for problem in report.problems), report.problems
    assert not report.valid


def test_cuts_may_not_cross() -> None:
    around = hub(RED, BLUE, RED, BLUE)
    outer = [[(color, [-i], color)] for i, color in enumerate((RED, BLUE, RED, BLUE), start=1)]
    crossed = divide([(RED, [1, 3], 0), (BLUE, [2, 4], 1)], *outer)  # type: ignore[arg-type]
    assert check_division(around, crossed).problems == ("cells[0].subcells: 0 and 1 cross",)
    blue_apart = [[(RED, [-1], 0)], [(BLUE, [], 1)], [(RED, [-3], 0)], [(BLUE, [], 2)]]
    legal = divide([(RED, [1, 3], 0)], *blue_apart)  # type: ignore[arg-type]
    assert check_division(around, legal).segments == 3


def test_a_color_that_cannot_continue_does_not_join() -> None:
    # Both cells have red, but the crack along edge 1 lets it through on edge 2 only.
    right = divide([(RED, [2], 0)], [(RED, [-2], 0)])
    assert check_division(CRACK, right).segments == 1
    dead = divide([(RED, [1, 2], 0)], [(RED, [-1, -2], 0)])
    assert "1 is not a live dart" in check_division(CRACK, dead).problems[0]
    partly = graph(((RED, BLUE), (1,)), ((RED, BLUE), (-1,)), cracks={1: (RED,)})
    blue = divide([(BLUE, [1], 0)], [(BLUE, [-1], 0)])
    assert "edge 1: color 1 cannot continue across it" in check_division(partly, blue).problems


def crossing_zeros(joined: list[int]) -> Division:
    """The hub with red darts 1, 2, 3 and blue ones 4, 5, 6, of which some are left in state 0."""
    red = [d for d in joined if d <= 3]
    blue = [d for d in joined if d > 3]
    return divide(
        [(RED, list(red), 0), (BLUE, list(blue), 1)],
        [(RED, [-d for d in red if d in (2, 3)], 0)],
        [(BLUE, [-d for d in blue if d in (4, 5)], 1)],
        [(RED, [-1], 0)],
        [(BLUE, [-6], 1)],
    )


@pytest.mark.parametrize(
    ("joined", "valid"),
    [
        ([1, 2, 3, 4, 5, 6], True),
        ([1, 2, 4, 5, 6], True),  # dart 3 can show blue, as dart 4 does
        ([1, 2, 3, 5, 6], True),  # dart 4 can show red, as dart 3 does
        ([1, 2, 5, 6], False),  # 3 would have to show blue before 4 shows red
        ([1, 3, 4, 5, 6], False),  # 2 lies between two red darts and shows red to a red cell
    ],
)
def test_zeros_must_be_able_to_differ(joined: list[int], valid: bool) -> None:
    report = check_division(CROSSING, crossing_zeros(joined))
    assert report.valid == valid, report.problems
    assert valid or "shows one joinable color on both sides" in report.problems[0]


def test_an_edge_between_two_cells_of_one_color_has_to_be_joined() -> None:
    apart = divide([(RED, [], 0)], [(RED, [], 1)])
    assert "edge 2: shows one joinable color" in check_division(CRACK, apart).problems[0]


@pytest.mark.parametrize("colors", [(RED, BLUE), (BLUE, RED)])
def test_sub_cells_without_darts_are_alone(colors: tuple[int, int]) -> None:
    """Which of the two would the edge show? Once that hung on their order."""
    pair = graph(((RED, BLUE), (1,)), ((RED, BLUE), (-1,)))
    both = divide([(colors[0], [], 0), (colors[1], [], 1)], [(RED, [], 2)])
    assert check_division(pair, both).problems == (
        "cells[0].subcells[0].darts: empty, though the cell has other sub-cells",
        "cells[0].subcells[1].darts: empty, though the cell has other sub-cells",
    )
    assert check_division(pair, divide([(BLUE, [], 0)], [(RED, [], 1)])).segments == 2


def test_superfluous_sub_cells_are_legal_but_no_scheme() -> None:
    single = divide(
        [(BLUE, [3], 0)],
        [(BLUE, [6], 0)],
        [(BLUE, [-3, -6], 0), (RED, [11], 1)],
        [(RED, [], 2)],
        [(RED, [-11], 1)],
    )
    report = check_division(SPLIT, single)
    # Dart 8 may show blue to its red cell, so this is a legal division into three segments.
    assert report.valid and report.segments == 3
    assert report.not_canonical == ("cells[2].subcells[1]: fewer than two darts in state 1",)


def test_a_cut_between_equal_colors_is_legal_but_no_scheme() -> None:
    ring = graph(((RED,), (1, 2, 3, 4)), *petal_cells(RED, RED, RED, RED))
    division = divide(
        [(RED, [1, 2], 0), (RED, [3, 4], 1)], *([(RED, [-i], (i - 1) // 2)] for i in range(1, 5))
    )
    report = check_division(ring, division)
    assert report.valid and report.segments == 2
    assert report.not_canonical == ("cells[0]: a cut between 2 and 3 separates equal colors",)


def test_strands_are_crossed_side_by_side() -> None:
    """The parallel corridors: both upper halves red, both lower halves blue, two segments."""
    corridors = Instance.read(PAPER / "parallel-corridors.json")
    # X = cell 1 walks [-2] after its red side (5) and before its blue one (1); Y = cell 2.
    order = corridors.cells[1].loops[0]
    assert order == (1, 9, -2, 14, 5)
    # Edge 2 runs with cell 2 on its left; cell 1 meets its strands in falling order.
    division = divide(
        [(BLUE, [(-1, 1), (-1, 2)], 0)],
        [(BLUE, [(1, 1), (1, 2), (-2, 2)], 0), (RED, [(-2, 1), (5, 1), (5, 2)], 1)],
        [(BLUE, [(2, 2), (-3, 1), (-3, 2)], 0), (RED, [(2, 1), (-7, 1), (-7, 2)], 1)],
        [(BLUE, [(3, 1), (3, 2)], 0)],
        [(RED, [(-5, 1), (-5, 2)], 1)],
        [(RED, [(7, 1), (7, 2)], 1)],
    )
    report = check_division(corridors, division, (), 2)
    assert report.valid and report.segments == 2, report.problems
    # With a single strand the two corridors cannot both cross edge 2.
    assert not check_division(corridors, division, (), 1).valid
