"""CP-SAT solvers as they are made for one worker, a few, and a portfolio."""

from __future__ import annotations

import pytest
from ortools.sat.python import cp_model

from cellcolor.errors import CellcolorError
from cellcolor.lab.families import hub
from cellcolor.solvers.cpsat import CompleteModel
from cellcolor.solvers.interface import Options
from cellcolor.solvers.interruptible import Runner, solve_interruptibly


@pytest.mark.parametrize("workers", [1, 2, 3, None])
def test_the_installed_ortools_knows_the_strategies(workers: int | None) -> None:
    """Their names are those of OR-Tools, and change between its minor versions."""
    solver = Runner(Options(workers=workers)).portfolio()
    status, interrupt = solve_interruptibly(solver, CompleteModel(hub(0, 8, 3)).model)
    assert (status, interrupt) == (cp_model.OPTIMAL, None)


def test_a_strategy_that_there_is_not() -> None:
    solver = Runner(Options(workers=1)).portfolio()
    solver.parameters.subsolvers.append("astrology")
    with pytest.raises(CellcolorError, match="OR-Tools"):
        solve_interruptibly(solver, CompleteModel(hub(0, 8, 3)).model)
