"""No false number in a solution is accepted: one number at a time is changed in right solutions.

What makes a number false is decided here by brute force, by counting, or by its own text.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import pytest
from divisions import SPLIT, split_solution
from exhaustive_minima import minimum
from hypothesis import assume, given
from hypothesis import strategies as st
from library import PAPER
from meshes import surfaces

from cellcolor.checker.claimed_numbers import claims, segments_of_whole_cells
from cellcolor.checker.division import check_solution
from cellcolor.data.bounds import Bound
from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Coverage, Instance
from cellcolor.data.solution import (
    InstanceReference,
    Seam,
    Solution,
)
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

NUMBERS = ("segments", "lift_offs", "lower_bound", "surface_lower_bound")


FIGURES = ("annulus", "parallel-corridors", "ring", "split-cell")


@cache
def solved(case: int | str, paper: bool) -> tuple[Instance, Solution]:
    """A random graph by its seed or one of the library by its name, solved."""
    if isinstance(case, int):
        instance = decompose(blobs(case, 10, 4, cracks=2))
    else:
        instance = Instance.read(PAPER / f"{case}.json")
    if not paper:
        return instance, solve(instance, Options("surface", 2, workers=1))
    return instance, solve(instance, Options(workers=1))


SOLVED = st.builds(solved, st.integers(0, 5) | st.sampled_from(FIGURES), st.booleans())
OTHER = st.integers(-3, 3).filter(bool)


@given(SOLVED, st.sampled_from(NUMBERS), OTHER)
def test_a_changed_number_is_refused(case: tuple[Instance, Solution], name: str, step: int) -> None:
    """Every number stands in two places or can be counted, so none can be changed alone."""
    instance, solution = case
    value = (getattr(solution, name) or 0) + step
    assume(value >= 0)
    assert check_solution(instance, solution).valid
    assert not check_solution(instance, replace(solution, **{name: value})).valid


@given(SOLVED, st.integers(0, 9), st.booleans())
def test_bounds_and_proofs_are_no_better_than_the_division(
    case: tuple[Instance, Solution], bound: int, general: bool
) -> None:
    """Bounds changed together with all that says the same: what contradicts the division goes."""
    instance, solution = case
    assert solution.segments is not None
    extent = "surface" if general else "strands"
    changed = replace(
        solution,
        status="feasible",
        lower_bound=bound,
        surface_lower_bound=bound if general else 0,
        proved_for_surface=general and bound == solution.segments,
        bounds=(Bound("cover", bound, extent),),
    )
    assert check_solution(instance, changed).valid == (bound <= solution.segments)
    proved = general or solution.search_space == "paper"
    optimal = check_solution(instance, replace(changed, status="optimal"))
    assert optimal.valid == (proved and bound == solution.segments)


@given(SOLVED, st.integers(0, 12), st.booleans())
def test_nothing_found_claims_little(
    case: tuple[Instance, Solution], bound: int, proved: bool
) -> None:
    instance, solution = case
    nothing = replace(
        solution,
        status="unknown",
        segments=None,
        lift_offs=None,
        cells=None,
        seams=(),
        lower_bound=bound,
        surface_lower_bound=bound,
        bounds=(Bound("cover", bound, "surface"),),
        proved_for_surface=proved,
    )
    report = check_solution(instance, nothing)
    assert report.valid == (not proved and bound <= segments_of_whole_cells(instance))
    # A division of whole cells exists, so no bound that is refused was true.
    assert solution.segments is not None and segments_of_whole_cells(instance) >= solution.segments


@given(surfaces())
def test_whole_cells_are_a_division(mesh: Any) -> None:
    """What refutes a bound has to exist: it is never below the minimum, nor above the cells."""
    instance = decompose(mesh)
    whole = segments_of_whole_cells(instance)
    assert whole <= len(instance.cells)
    loops = [
        sum(any(map(instance.joinable, loop)) for loop in cell.loops) for cell in instance.cells
    ]
    darts = [sum(map(len, cell.loops)) for cell in instance.cells]
    assume(max(loops, default=0) < 2 and max(darts, default=0) < 7 and len(darts) < 8)
    assert minimum(instance) <= whole if instance.cells else whole == 0


@given(SOLVED, st.randoms(use_true_random=False))
def test_the_order_of_sub_cells_means_nothing(case: tuple[Instance, Solution], random: Any) -> None:
    """Nor that of darts; whether the division is right or has a color exchanged."""
    instance, solution = case
    cells = list(solution.cells or ())
    if random.random() < 0.5:
        number = random.randrange(len(cells))
        subcells = list(cells[number].subcells)
        place = random.randrange(len(subcells))
        color = random.choice(instance.cells[number].colors)
        subcells[place] = replace(subcells[place], color=color, darts=())
        cells[number] = replace(cells[number], subcells=tuple(subcells))
    mixed = []
    for cell in cells:
        subcells = [
            replace(sub, darts=tuple(random.sample(sub.darts, len(sub.darts))))
            for sub in cell.subcells
        ]
        mixed.append(replace(cell, subcells=tuple(random.sample(subcells, len(subcells)))))
    one = check_solution(instance, replace(solution, cells=tuple(cells)))
    other = check_solution(instance, replace(solution, cells=tuple(mixed)))
    assert (one.valid, one.segments) == (other.valid, other.segments)


RED, BLUE = 0, 1


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
        ({"instance": InstanceReference("split-cell", "0" * 64)}, "instance.sha256"),
        ({"strands": 2}, "strands: must be 1"),
        ({"segments": 3}, "segments: says 3, the division has 2"),
        ({"lift_offs": 2}, "lift_offs: says 2, must be 1"),
        ({"lower_bound": 3, "status": "feasible"}, "lower_bound: 3 cannot be above"),
        ({"surface_lower_bound": 3, "proved_for_surface": False}, "surface_lower_bound: 3"),
        ({"proved_for_surface": False}, "proved_for_surface: must be true"),
        ({"surface_lower_bound": 1}, "proved_for_surface: must be false"),
        ({"lower_bound": 1}, "status: a division with 2 segments is not proved optimal"),
        (
            {"search_space": "surface", "surface_lower_bound": 1, "proved_for_surface": False},
            "status: a division with 2 segments is not proved optimal by a lower bound of 1",
        ),
        ({"lower_bound": 1, "status": "feasible"}, "lower_bound: 1 cannot be below"),
        ({"bounds": ()}, "lower_bound: says 2, the greatest of bounds is 0"),
        (
            {"bounds": (Bound("cover", 2, "surface"), Bound("model", 3, "strands"))},
            "lower_bound: says 2, the greatest of bounds is 3",
        ),
        ({"bounds": (Bound("model", 2, "strands"),)}, "surface_lower_bound: says 2"),
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
    ],
)
def test_false_numbers_are_named(change: dict[str, object], expected: str) -> None:
    report = check_solution(SPLIT, replace(split_solution(), **change))  # type: ignore[arg-type]
    assert any(problem.startswith(expected) for problem in report.problems), report.problems


def test_numbers_that_are_right() -> None:
    right = replace(
        split_solution(),
        schemes=1,
        complete=True,
        bounds=(Bound("cover", 2, "surface"),),
    )
    assert check_solution(SPLIT, right).problems == ()
    nothing = replace(right, **UNKNOWN)  # type: ignore[arg-type]
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
    older = replace(split_solution(), cutting_paths=1, cutting_paths_lower_bound=1)
    assert claims(SPLIT, older) == {
        "cutting_paths": 1,
        "cutting_paths_lower_bound": 1,
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
