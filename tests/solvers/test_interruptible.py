"""CP-SAT solvers as they are made for one worker, a few, and a portfolio."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from ortools.sat.python import cp_model

from cellcolor.deadline import NEVER
from cellcolor.lab.families import hub_grid
from cellcolor.solvers.cpsat import model_runs
from cellcolor.solvers.encodings import solving
from cellcolor.solvers.encodings.pointers import Pointers
from cellcolor.solvers.encodings.problem import Problem
from cellcolor.solvers.interruptible import make_cp_solver, make_portfolio

pytestmark = pytest.mark.second


@pytest.fixture(scope="module")
def model() -> cp_model.CpModel:
    """The pointers of a grid of 2 × 3 hubs."""
    return Pointers(Problem.of(hub_grid(0, 2, 3, 4), NEVER), NEVER).model


@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize("strategies", [model_runs.STRATEGIES, solving.STRATEGIES])
def test_few_workers_search_in_several_ways(
    model: cp_model.CpModel, strategies: Sequence[str], workers: int
) -> None:
    """What one worker in the default strategy does not prove with more effort, they do."""
    single = make_cp_solver(NEVER, 1, 0, effort=0.5)
    few = make_portfolio(NEVER, workers, 0, strategies, effort=0.2)
    assert single.solve(model) == cp_model.FEASIBLE
    assert few.solve(model) == cp_model.OPTIMAL
    assert few.objective_value <= single.objective_value
