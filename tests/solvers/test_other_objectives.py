"""What costs least among divisions with as few segments, against all optimal schemes."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from cellcolor.arrays import Array
from cellcolor.checker.division import check_solution
from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose
from cellcolor.lab.families import SMALL
from cellcolor.solvers.checked import enumerate_schemes, solve
from cellcolor.solvers.interface import Options
from cellcolor.solvers.other_objectives import cost_of, preferred
from examples import examples

MOST_SCHEMES = 3000
"""Larger sets of schemes are not compared."""


def small(family: str, seed: int) -> tuple[Instance, Array, Options]:
    """An instance, costs drawn for it in hundredths, and how to solve it."""
    made = SMALL[family](seed)
    instance = made if isinstance(made, Instance) else decompose(made)
    shape = len(instance.cells), len(instance.colors)
    costs = np.random.default_rng(seed).integers(0, 100, shape) / 100
    return instance, costs, Options(deadline=Deadline.after(120.0), workers=1)


@pytest.mark.parametrize("family", SMALL)
@examples(12)
@given(seed=st.integers(0, 2**31 - 1))
@example(seed=471)  # of the graphs: a better color meets itself across an edge, which is joined
def test_no_optimal_scheme_costs_less(family: str, seed: int) -> None:
    instance, costs, options = small(family, seed)
    solution = solve(instance, options)
    listed = enumerate_schemes(instance, options, "cp-sat", solution.segments)
    schemes = list(islice(listed, MOST_SCHEMES + 1))
    assume(len(schemes) <= MOST_SCHEMES)
    found, reason = preferred(instance, solution, costs, options)
    assert reason is None
    assert cost_of(found.cells, costs) == pytest.approx(
        min(cost_of(scheme, costs) for scheme in schemes), abs=1e-9
    )
    assert replace(found, cells=solution.cells, seams=solution.seams) == solution
    assert check_solution(instance, found).valid


def test_without_time_segments_get_their_best_colors_and_it_is_said() -> None:
    """Costs are such that some segment has a better color, and some cell an even better one."""
    instance, costs, options = small("graphs", 2)
    solution = solve(instance, options)
    late = replace(options, deadline=Deadline.after(0.0))
    found, reason = preferred(instance, solution, costs, late)
    assert cost_of(found.cells, costs) < cost_of(solution.cells, costs)
    assert found.segments == solution.segments and check_solution(instance, found).valid
    assert reason == "the time ended first"


def test_a_number_that_is_not_proved_is_no_base_for_a_proof() -> None:
    instance, costs, options = small("graphs", 2)
    solution = replace(solve(instance, options), status="feasible")
    _, reason = preferred(instance, solution, costs, options)
    assert reason == "nor is the number of segments proved to be the fewest"
