"""CP-SAT solvers as they are made for one worker, a few, and a portfolio."""

from __future__ import annotations

import pytest
from ortools.sat.python import cp_model

from cellcolor.deadline import NEVER
from cellcolor.errors import CellcolorError
from cellcolor.lab.families import hub
from cellcolor.solvers.cpsat import CompleteModel
from cellcolor.solvers.cpsat.runner import STRATEGIES
from cellcolor.solvers.interruptible import make_portfolio, solve_interruptibly


@pytest.mark.parametrize("workers", [1, 2, 3, None])
def test_the_installed_ortools_knows_the_strategies(workers: int | None) -> None:
    """Their names are those of OR-Tools, and change between its minor versions."""
    built = CompleteModel(hub(0, 8, 3))
    solver = make_portfolio(NEVER, workers, 0, STRATEGIES)
    status, interrupt = solve_interruptibly(solver, built.model)
    assert (status, interrupt) == (cp_model.OPTIMAL, None)


def test_a_strategy_that_there_is_not() -> None:
    solver = make_portfolio(NEVER, 1, 0, ("no_lp", "astrology"))
    with pytest.raises(CellcolorError, match="OR-Tools"):
        solve_interruptibly(solver, CompleteModel(hub(0, 8, 3)).model)
