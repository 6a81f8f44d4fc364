"""The checker: every rule is broken once, by hand, on small instances whose answer is known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
from library import PAPER

from cellcolor.checker.claimed_numbers import claims
from cellcolor.checker.division import check_division, check_solution
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.bound import Bound
from cellcolor.data.coverage import Coverage
from cellcolor.data.instance import Cell, Edge, Instance
from cellcolor.data.plan import Plan
from cellcolor.data.solution import (
    CellDivision,
    DartName,
    Division,
    InstanceReference,
    Seam,
    Solution,
    SubCell,
)
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

RED, BLUE = 0, 1
SPLIT = Instance.read(PAPER / "split-cell.json")
CROSSING = Instance.read(PAPER / "crossing-zeros.json")
ANNULUS = Instance.read(PAPER / "annulus.json")
CRACK = Instance.read(PAPER / "crack-partial.json")


def divide(*cells: list[tuple[int, list[DartName], int]]) -> Division:
    """A division from (color, darts, segment) of the sub-cells of each cell."""
    return tuple(
        CellDivision(number, tuple(SubCell(c, tuple(darts), s) for c, darts, s in subs))
        for number, subs in enumerate(cells)
    )


def split_solution() -> Solution:
    """The cell that must be split: its blue neighbours joined through one half, red the other."""
    return Solution(
        instance=InstanceReference(SPLIT.name, SPLIT.sha256),
        search_space="paper",
        strands=1,
        solver="by hand",
        status="optimal",
        segments=2,
        lift_offs=1,
        lower_bound=2,
        surface_lower_bound=2,
        proved_for_surface=True,
        seams=(),
        cells=divide(
            [(BLUE, [3], 0)],
            [(BLUE, [6], 0)],
            [(BLUE, [-3, -6], 0), (RED, [11, 8], 1)],
            [(RED, [-8], 1)],
            [(RED, [-11], 1)],
        ),
        seconds=0.0,
    )


def test_a_right_solution_is_valid() -> None:
    report = check_solution(SPLIT, split_solution())
    assert report.valid and report.is_scheme and report.segments == 2, report


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"instance": InstanceReference("split-cell", "0" * 64)}, "instance.sha256"),
        ({"strands": 2}, "strands: must be 1"),
        ({"segments": 3}, "segments: says 3, the division has 2"),
        ({"lift_offs": 2}, "lift_offs: says 2, must be 1"),
        ({"lower_bound": 3, "status": "feasible"}, "lower_bound: 3 cannot be above"),
        ({"surface_lower_bound": 3, "proved_for_surface": False}, "surface_lower_bound: 3"),
        ({"proved_for_surface": False}, "proved_for_surface: must be true"),
        ({"surface_lower_bound": 1}, "proved_for_surface: must be false"),
        ({"lower_bound": 1}, "status: 2 segments are not proved optimal"),
        (
            {"search_space": "surface", "surface_lower_bound": 1, "proved_for_surface": False},
            "status: 2 segments are not proved optimal by a lower bound of 1",
        ),
    ],
)
def test_numbers_are_checked(change: dict[str, object], expected: str) -> None:
    report = check_solution(SPLIT, replace(split_solution(), **change))  # type: ignore[arg-type]
    assert any(problem.startswith(expected) for problem in report.problems), report.problems


UNKNOWN: dict[str, object] = {
    "status": "unknown",
    "segments": None,
    "lift_offs": None,
    "cells": None,
    "proved_for_surface": False,
}


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"lower_bound": 1, "status": "feasible"}, "lower_bound: 1 cannot be below"),
        ({"bounds": ()}, "lower_bound: says 2, the greatest of bounds is 0"),
        (
            {"bounds": (Bound("cover", 2, "surface"), Bound("model", 3, "strands"))},
            "lower_bound: says 2, the greatest of bounds is 3",
        ),
        ({"bounds": (Bound("model", 2, "strands"),)}, "surface_lower_bound: says 2"),
        ({"cutting_paths": 7, "cutting_paths_lower_bound": 0}, "cutting_paths: says 7"),
        (
            {"cutting_paths": 1, "cutting_paths_lower_bound": 2},
            "cutting_paths_lower_bound: 2 cannot be above the 1 found",
        ),
        ({"cutting_paths": 1}, "cutting_paths: goes with"),
        ({"cutting_paths_lower_bound": 1}, "cutting_paths: goes with"),
        ({"schemes": 1}, "schemes: goes with complete"),
        ({"complete": True}, "schemes: goes with complete"),
        ({"schemes": 0, "complete": True}, "schemes: cannot be 0 and complete"),
        (
            {"schemes": 1, "complete": True, "search_space": "surface", "strands": 2},
            "schemes: are defined in search space 'paper' only",
        ),
        (
            {"schemes": 1, "complete": False, "status": "feasible"},
            "schemes: cannot be known to be optimal",
        ),
        ({"strands": 10**6, "search_space": "surface"}, "strands: would make 8000000 darts"),
        ({"seams": (Seam(99, 0, 1, 3, 10**9),)}, "strands: would make 2000000008 darts"),
        (UNKNOWN | {"proved_for_surface": True}, "proved_for_surface: must be false"),
        (
            # Blue in the cells 0, 1, 2 and red in 3 and 4 apart from each other.
            UNKNOWN | {"lower_bound": 4, "surface_lower_bound": 4},
            "lower_bound: 4 cannot be above the 3 segments whole cells can be painted in",
        ),
        (UNKNOWN | {"surface_lower_bound": 10**9}, "surface_lower_bound: 1000000000 cannot"),
        (UNKNOWN | {"seams": (Seam(99, 0, 1, 3, 1),)}, "seams: there are none"),
        (UNKNOWN | {"cutting_paths": 0}, "cutting_paths: cannot be known"),
        (UNKNOWN | {"cutting_paths_lower_bound": 1}, "cutting_paths: cannot be known"),
    ],
)
def test_contradictions_are_refused(change: dict[str, object], expected: str) -> None:
    report = check_solution(SPLIT, replace(split_solution(), **change))  # type: ignore[arg-type]
    assert any(problem.startswith(expected) for problem in report.problems), report.problems


def test_numbers_that_are_right() -> None:
    right = replace(
        split_solution(),
        cutting_paths=1,
        cutting_paths_lower_bound=1,
        schemes=1,
        complete=True,
        bounds=(Bound("cover", 2, "surface"),),
    )
    assert check_solution(SPLIT, right).problems == ()
    nothing = replace(right, **UNKNOWN, cutting_paths=None, cutting_paths_lower_bound=0)  # type: ignore[arg-type]
    nothing = replace(nothing, schemes=0, complete=False)
    assert check_solution(SPLIT, nothing).problems == ()


def test_coverage_is_the_instance_s() -> None:
    coverage = Coverage(1.0, 0.25, 0.125)
    covered = replace(SPLIT, coverage=coverage)
    assert check_solution(covered, replace(split_solution(), coverage=coverage)).valid
    other = replace(split_solution(), coverage=Coverage(1.0, 0.125, 0.25))
    assert check_solution(covered, other).problems == ("coverage: is not that of the instance",)
    # An instance that says nothing of it cannot contradict; the number is a claim.
    assert check_solution(SPLIT, other).valid and "coverage" in claims(SPLIT, other)
    assert "coverage" not in claims(covered, replace(split_solution(), coverage=coverage))


def test_what_nobody_has_verified_is_named() -> None:
    assert claims(SPLIT, split_solution()) == {
        "lower_bound": 2,
        "surface_lower_bound": 2,
        "status": "optimal",
        "proved_for_surface": True,
    }
    # One segment is needed for a cell, so this proof is complete.
    one = Instance("one", ("red",), (Cell(0, (RED,), ()),), ())
    solution = solve(one, Options())
    assert (solution.status, claims(one, solution)) == ("optimal", {})


def test_a_weaker_status_than_the_proof_is_no_fault() -> None:
    assert check_solution(SPLIT, replace(split_solution(), status="feasible")).valid


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
        (with_cell(0), "cells[0].subcells: needs one sub-cell"),
        (with_cell(0, (RED, [3], 0)), "cells[0].subcells[0].color: cell 0 cannot be painted"),
        (with_cell(0, (BLUE, [1, 3], 0)), "cells[0].subcells[0].darts: 1 is no live dart"),
        (with_cell(0, (BLUE, [3, -3], 0)), "cells[0].subcells[0].darts: -3 is no live dart"),
        (with_cell(0, (BLUE, [3, 3], 0)), "cells[0].subcells[0].darts: 3 stands twice"),
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
    petals = [RED, BLUE, RED, BLUE]
    hub = Instance(
        "hub",
        ("red", "blue"),
        (
            Cell(0, (RED, BLUE), ((1, 2, 3, 4),)),
            *(Cell(i, (color,), ((-i,),)) for i, color in enumerate(petals, start=1)),
        ),
        tuple(Edge(i, 0, i) for i in range(1, 5)),
    )
    outer = [[(color, [-i], color)] for i, color in enumerate(petals, start=1)]
    crossed = divide([(RED, [1, 3], 0), (BLUE, [2, 4], 1)], *outer)  # type: ignore[arg-type]
    assert check_division(hub, crossed).problems == ("cells[0].subcells: 0 and 1 cross",)
    blue_apart = [[(RED, [-1], 0)], [(BLUE, [], 1)], [(RED, [-3], 0)], [(BLUE, [], 2)]]
    legal = divide([(RED, [1, 3], 0)], *blue_apart)  # type: ignore[arg-type]
    assert check_division(hub, legal).segments == 3


def test_a_color_that_cannot_continue_does_not_join() -> None:
    # Both cells have red, but the crack along edge 1 lets it through on edge 2 only.
    right = divide([(RED, [2], 0)], [(RED, [-2], 0)])
    assert check_division(CRACK, right).segments == 1
    dead = divide([(RED, [1, 2], 0)], [(RED, [-1, -2], 0)])
    assert "1 is no live dart" in check_division(CRACK, dead).problems[0]
    partly = Instance(
        "partly",
        ("red", "blue"),
        (Cell(0, (RED, BLUE), ((1,),)), Cell(1, (RED, BLUE), ((-1,),))),
        (Edge(1, 0, 1, (RED,)),),
    )
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
    pair = Instance(
        "pair",
        ("red", "blue"),
        (Cell(0, (RED, BLUE), ((1,),)), Cell(1, (RED, BLUE), ((-1,),))),
        (Edge(1, 0, 1),),
    )
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
    ring = Instance(
        "four red petals",
        ("red",),
        (
            Cell(0, (RED,), ((1, 2, 3, 4),)),
            *(Cell(i, (RED,), ((-i,),)) for i in range(1, 5)),
        ),
        tuple(Edge(i, 0, i) for i in range(1, 5)),
    )
    division = divide(
        [(RED, [1, 2], 0), (RED, [3, 4], 1)], *([(RED, [-i], (i - 1) // 2)] for i in range(1, 5))
    )
    report = check_division(ring, division)
    assert report.valid and report.segments == 2
    assert report.not_canonical == ("cells[0]: a cut between 2 and 3 separates equal colors",)


SEAM = Seam(20, 1, -3, -9, 2)


def annulus_division(seam_darts: list[DartName]) -> Division:
    """The annulus painted red all over: one segment with all red cells, two blue cells left."""
    return divide(
        [(RED, [3], 0)],
        [(RED, [-3, -9, -12, *seam_darts], 0)],
        [(BLUE, [], 1)],
        [(BLUE, [], 2)],
        [(RED, [9], 0)],
        [(RED, [12], 0)],
    )


def test_seams_are_checked() -> None:
    joined = annulus_division([(20, 1), (20, 2), (-20, 1), (-20, 2)])
    report = check_division(ANNULUS, joined, (SEAM,))
    assert report.valid and report.segments == 3, report.problems

    def problem(*seams: Seam) -> str:
        return check_division(ANNULUS, joined, seams).problems[0]

    assert "2 loops with live darts are not connected" in problem()
    assert "its id must be above 13" in problem(replace(SEAM, id=13))
    assert "there is no cell 9" in problem(replace(SEAM, cell=9))
    assert "dart 3 is not in the loops of cell 1" in problem(replace(SEAM, from_=3))
    assert "are in one loop already" in problem(replace(SEAM, to=-12))
    assert "20 strand 2 is no live dart" in problem(replace(SEAM, strands=1))


def test_a_seam_in_state_0_parts_nothing() -> None:
    """It is no border: the sub-cell on both sides of it is one, as with the seam in state 1."""
    report = check_division(ANNULUS, annulus_division([]), (SEAM,))
    assert report.valid and report.segments == 3


def test_zeros_on_loops_are_read_without_seams() -> None:
    """An edge in state 0 of a loop without darts in state 1 shows what some sub-cell shows.

    A cell is cut into a red part and a blue one. A red island that is not joined lies in the blue
    part; in a cell that is red all over there is no place for it.
    """
    instance = Instance(
        "island",
        ("red", "blue"),
        (
            Cell(0, (RED, BLUE), ((1, 2, 3, 4), (5,))),
            *(Cell(i, (RED if i < 3 else BLUE,), ((-i,),)) for i in range(1, 5)),
            Cell(5, (RED, BLUE), ((-5,),)),
        ),
        tuple(Edge(i, 0, i) for i in range(1, 6)),
    )
    # The seam leaves between the two red darts, so that in the cyclic list red is all around it.
    seam = Seam(6, 0, 1, 5, 1)
    petals = [[(RED, [-1], 0)], [(RED, [-2], 0)], [(BLUE, [-3], 1)], [(BLUE, [-4], 1)]]
    divided: list[tuple[int, list[DartName], int]] = [(RED, [1, 2], 0), (BLUE, [3, 4], 1)]
    report = check_division(instance, divide(divided, *petals, [(RED, [], 2)]), (seam,))
    assert report.valid and report.segments == 3, report.problems
    whole: list[tuple[int, list[DartName], int]] = [(RED, [1, 2], 0)]
    petals[2:] = [[(BLUE, [], 1)], [(BLUE, [], 2)]]
    report = check_division(instance, divide(whole, *petals, [(RED, [], 3)]), (seam,))
    assert report.problems == ("edge 5: shows one joinable color on both sides in state 0",)


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


def surface() -> LabelledSurface:
    """A strip of four vertices a side; red everywhere, blue on the right half."""
    return LabelledSurface.from_document(
        {
            "format": "cellcolor/labelled-surface",
            "version": 1,
            "name": "strip",
            "colors": ["red", "blue"],
            "vertices": [[x, y, 0] for x in range(4) for y in range(2)],
            "faces": [
                f
                for x in range(3)
                for f in ([2 * x, 2 * x + 2, 2 * x + 3], [2 * x, 2 * x + 3, 2 * x + 1])
            ],
            "vertex_colors": [[0], [0], [0], [0], [0, 1], [0, 1], [0, 1], []],
        }
    )


@pytest.mark.parametrize(
    ("colors", "expected"),
    [
        ((0, 0, 0, 0, 1, 1, 1), "vertex_colors: 7 entries for 8 vertices"),
        ((0, 0, 0, 0, 1, 1, None, None), "vertex_colors[6]: null, but colors [0, 1]"),
        ((0, 0, 0, 0, 1, 1, 1, 1), "vertex_colors[7]: color 1 does not reach"),
        ((0, 1, 0, 0, 1, 1, 1, None), "vertex_colors[1]: color 1 does not reach"),
    ],
)
def test_plans_are_checked(colors: tuple[int | None, ...], expected: str) -> None:
    report = check_plan(surface(), Plan(colors))
    assert report.problems[0].startswith(expected) and report.segments is None


def test_segments_of_a_plan_are_counted_on_the_mesh() -> None:
    assert check_plan(surface(), Plan((0, 0, 0, 0, 0, 0, 0, None))).segments == 1
    assert check_plan(surface(), Plan((0, 0, 0, 0, 1, 1, 1, None))).segments == 2
    # Vertices 4 and 5 are neighbours, 4 and 6 too; painting 4 red leaves 6 and 5 apart.
    assert check_plan(surface(), Plan((0, 0, 0, 0, 0, 1, 1, None))).segments == 3


def test_cracks_separate_segments_of_a_plan() -> None:
    cracks = (Crack(2, 4, (0,)), Crack(2, 5, (0,)), Crack(3, 5, (0,)))
    plan = Plan((0, 0, 0, 0, 0, 0, 0, None))
    assert check_plan(replace(surface(), cracks=cracks), plan).segments == 2
    assert check_plan(replace(surface(), cracks=cracks[:2]), plan).segments == 1
