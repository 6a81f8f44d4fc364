"""A solution gives the size of the complete model where one was built, and nothing elsewhere."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from library import PAPER

from cellcolor.data.instance import Instance
from cellcolor.data.solution import ModelSize
from cellcolor.errors import SolverMissing
from cellcolor.lab.families import planar_graph
from cellcolor.solvers.checked import solve
from cellcolor.solvers.choco.model import Ranks
from cellcolor.solvers.choco.problem import Problem
from cellcolor.solvers.cpsat import CompleteModel
from cellcolor.solvers.interface import Options
from cellcolor.solvers.linear.coloring import Coloring
from cellcolor.solvers.registry import make_solver
from examples import examples

CORRIDORS = Instance.read(PAPER / "parallel-corridors.json")
OF_MODELS = "model", "crossings"


def size_by(solver: str) -> ModelSize | None:
    try:
        make_solver(solver)
    except SolverMissing as error:
        pytest.skip(str(error))
    solution = solve(CORRIDORS, Options(workers=1), solver)
    assert (solution.status, solution.segments) == ("optimal", 3)
    return solution.model


def test_the_depth_first_search_has_no_model() -> None:
    assert size_by("dfs") is None


def test_that_of_the_complete_model() -> None:
    assert size_by("cp-sat-model") == CompleteModel(CORRIDORS).size


@pytest.mark.second
@pytest.mark.parametrize("solver", ["highs", "scip", "maxsat"])
def test_that_of_the_linear_model(solver: str) -> None:
    model = Coloring(CORRIDORS).model
    assert size_by(solver) == ModelSize(model.variables, len([*model.rows()]))


@pytest.mark.second
def test_that_of_choco() -> None:
    pytest.importorskip("pychoco")
    built = Ranks(Problem.of(CORRIDORS), 0)
    assert size_by("choco") == ModelSize(built.variables, built.constraints)
    assert built.variables > len(built.joined) and built.constraints > 2 * len(built.counted)


@pytest.mark.second
def test_that_of_a_ground_program() -> None:
    size = size_by("clingo")
    assert size is not None
    assert size.variables > len(CORRIDORS.cells) and size.constraints > len(CORRIDORS.edges)


@examples(20)
@given(seed=st.integers(0, 10**6), cells=st.integers(4, 9), colors=st.integers(2, 4))
def test_no_bound_says_model_where_none_was_built(seed: int, cells: int, colors: int) -> None:
    instance = planar_graph(seed, cells, 2 * cells, colors)
    solution = solve(instance, Options(workers=1))
    by_a_model = any(bound.kind in OF_MODELS for bound in solution.bounds or ())
    assert solution.model is not None or not by_a_model
    assert solution.model is None or solution.model.constraints > 0
