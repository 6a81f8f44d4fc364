"""A solution gives the size of the complete model where one was built, and nothing elsewhere."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES, PAPER

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.lab.families import planar_graph
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat import CompleteModel
from cellcolor.solvers.interface import Options
from examples import examples

CORRIDORS = Instance.read(PAPER / "parallel-corridors.json")


def test_that_of_the_complete_model_and_of_none() -> None:
    assert solve(CORRIDORS, Options(), "cp-sat-model").model == CompleteModel(CORRIDORS).size
    assert solve(CORRIDORS, Options(), "dfs").model is None


def no_bound_says_model_where_none_was_built(solution: Solution) -> bool:
    by_a_model = any(bound.kind in ("model", "crossings") for bound in solution.bounds or ())
    return not by_a_model if solution.model is None else solution.model.constraints > 0


@examples(20)
@given(seed=st.integers(0, 10**6), cells=st.integers(4, 9), colors=st.integers(2, 4))
def test_solutions(seed: int, cells: int, colors: int) -> None:
    instance = planar_graph(seed, cells, 2 * cells, colors)
    assert no_bound_says_model_where_none_was_built(solve(instance, Options(workers=1)))


def test_stored_solutions() -> None:
    for path in (INSTANCES / "solutions").glob("*.json"):
        assert no_bound_says_model_where_none_was_built(Solution.read(path)), path.name
