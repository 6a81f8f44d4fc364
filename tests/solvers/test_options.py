"""Options of a search: what cannot be asked for is refused where it is asked, with a sentence."""

from __future__ import annotations

import math
from typing import Any

import pytest
from library import PAPER
from meshes import drawn

import cellcolor
from cellcolor.data.instance import Instance
from cellcolor.errors import InputError, RefusedResult
from cellcolor.solvers.checked import enumerate_schemes, solve
from cellcolor.solvers.interface import Options

RING = Instance.read(PAPER / "ring.json")
CORRIDORS = Instance.read(PAPER / "parallel-corridors.json")


@pytest.mark.parametrize(
    ("options", "field", "message"),
    [
        ({"search_space": "foo"}, "search_space", "'paper' or 'surface'"),
        ({"search_space": None}, "search_space", "'paper' or 'surface'"),
        ({"strands": 2}, "strands", "must be 1 in search space 'paper', is 2"),
        ({"strands": 0}, "strands", "greater than or equal to 1"),
        ({"search_space": "surface", "strands": 0}, "strands", "greater than or equal to 1"),
        ({"search_space": "surface", "strands": 2.0}, "strands", "valid integer"),
        ({"search_space": "surface", "strands": True}, "strands", "valid integer"),
        ({"workers": -3}, "workers", "greater than or equal to 1"),
        ({"workers": 0}, "workers", "greater than or equal to 1"),
        ({"workers": 10**14}, "workers", "less than or equal to 1000"),
        ({"workers": math.nan}, "workers", "valid integer"),
        ({"seed": -1}, "seed", "greater than or equal to 0"),
        ({"seed": 2**31}, "seed", "less than or equal to 2147483647"),
        ({"seed": None}, "seed", "valid integer"),
        ({"deadline": 10.0}, "deadline", "Deadline"),
        ({"start": "solution.json"}, "start", "Start"),
    ],
)
def test_refused(options: dict[str, Any], field: str, message: str) -> None:
    with pytest.raises(InputError) as refusal:
        Options(**options)
    assert refusal.value.field == field
    assert message in refusal.value.message


@pytest.mark.parametrize("options", [{"workers": 0}, {"seed": -1}])
def test_the_oracle_refuses_before_it_searches(options: dict[str, int]) -> None:
    # One cell: its range is known before the search space `surface` is come to.
    with pytest.raises(InputError) as refusal:
        cellcolor.proven_range(drawn("aa aa", {"a": [0]}), **options)
    assert refusal.value.field == next(iter(options))


def test_what_a_solver_cannot_do_is_not_done_silently() -> None:
    for solver in ("cp-sat", "dfs"):
        with pytest.raises(InputError, match="search_space"):
            list(enumerate_schemes(CORRIDORS, Options("surface", 2), solver, 2))


def test_no_scheme_at_all_contradicts_the_minimum() -> None:
    with pytest.raises(RefusedResult, match="no scheme with 1 segments"):
        list(enumerate_schemes(RING, Options(), "cp-sat", 1))


@pytest.mark.parametrize("solver", ["cp-sat", "dfs"])
def test_more_strands_than_fit_into_memory_are_refused(solver: str) -> None:
    with pytest.raises(InputError, match=r"strands: .* are too many"):
        solve(CORRIDORS, Options("surface", 10**20), solver)
