"""Cells with several loops: seams, and what the rules say without them."""

from __future__ import annotations

from dataclasses import replace

from divisions import BLUE, RED, divide
from library import PAPER
from rooms import graph, petal_cells

from cellcolor.checker.division import check_division
from cellcolor.data.cells_and_edges import DartName
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Seam

ANNULUS = Instance.read(PAPER / "annulus.json")


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
    assert "20 strand 2 is not a live dart" in problem(replace(SEAM, strands=1))


def test_a_seam_in_state_0_parts_nothing() -> None:
    """It is no border: the sub-cell on both sides of it is one, as with the seam in state 1."""
    report = check_division(ANNULUS, annulus_division([]), (SEAM,))
    assert report.valid and report.segments == 3


def test_zeros_on_loops_are_read_without_seams() -> None:
    """An edge in state 0 of a loop without darts in state 1 shows what some sub-cell shows.

    A cell is cut into a red part and a blue one. A red island that is not joined lies in the blue
    part; in a cell that is red all over there is no place for it.
    """
    instance = graph(
        ((RED, BLUE), (1, 2, 3, 4), (5,)), *petal_cells(RED, RED, BLUE, BLUE, (RED, BLUE))
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
    (problem,) = report.problems
    assert problem.startswith("edge 5: shows one joinable color on both sides in state 0; join it")
