"""Solvers that know cells with one live loop, on cells with several: the minimum is the same."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from library import PAPER

import cellcolor
from cellcolor.data.instance import Instance
from cellcolor.errors import SolverMissing, TooLarge
from cellcolor.lab.families import hub_with_loops
from cellcolor.lab.families.registry import SMALL
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options
from cellcolor.solvers.registry import make_solver
from cellcolor.solvers.seamed import Seamed
from examples import examples

RIVALS = (
    pytest.param("clingo", marks=pytest.mark.second),
    "highs",
    "maxsat",
)


@pytest.mark.second
@pytest.mark.parametrize("solver", RIVALS)
@examples(5)
@given(seed=st.integers(0, 10**4))
def test_a_rival_finds_what_the_depth_first_search_finds(solver: str, seed: int) -> None:
    """``dfs-cover`` has seams of its own, elsewhere; the checker sees both divisions."""
    try:
        make_solver(solver)
    except SolverMissing:
        pytest.skip(f"{solver} is not installed")
    made = SMALL["islands, holes"](seed)
    instance = made if isinstance(made, Instance) else cellcolor.decompose(made)
    assert instance.most_live_loops > 1
    expected = solve(instance, Options(), "dfs-cover")
    found = solve(instance, Options(workers=1), solver)
    assert (expected.status, found.status) == ("optimal", "optimal")
    assert found.segments == expected.segments


def test_too_many_strands() -> None:
    with pytest.raises(TooLarge, match="the seams need"):
        Seamed(hub_with_loops(0, 150, 2, 2))


def test_an_instance_without_seams_stays_as_it_is() -> None:
    ring = Instance.read(PAPER / "ring.json")
    assert Seamed(ring).instance is ring
