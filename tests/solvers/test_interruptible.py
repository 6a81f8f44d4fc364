"""CP-SAT solvers as they are made for one worker, a few, and a portfolio."""

from __future__ import annotations

import pytest
from dart_graphs import graph_of
from ortools.sat.python import cp_model

from cellcolor.deadline import NEVER
from cellcolor.lab.families import hub_grid
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.model.full import full_model
from cellcolor.solvers.cpsat.model_runs import STRATEGIES
from cellcolor.solvers.interruptible import make_cp_solver, make_portfolio

pytestmark = pytest.mark.second


@pytest.fixture(scope="module")
def model() -> cp_model.CpModel:
    """The full model of a grid of 2 × 3 hubs."""
    instance = hub_grid(0, 2, 3, 4)
    return full_model(graph_of(instance), color_regions(instance)).model


@pytest.mark.parametrize("workers", [1, 2])
def test_few_workers_search_in_several_ways(model: cp_model.CpModel, workers: int) -> None:
    """What one worker in the default strategy does not prove with more effort, they do."""
    single = make_cp_solver(NEVER, 1, 0, effort=0.5)
    few = make_portfolio(NEVER, workers, 0, STRATEGIES, effort=0.2)
    assert single.solve(model) == cp_model.FEASIBLE
    assert few.solve(model) == cp_model.OPTIMAL
    assert few.objective_value <= single.objective_value
