"""Plans that are not valid are refused with kind and place, valid ones never."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from library import PAPER
from meshes import drawn, surfaces
from planners import SORTS, contradictions, valid_plans
from planted_plans import PLANTERS, Case, caught

import cellcolor
from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families import blobs
from examples import examples

RED, BLUE = 0, 1
ROW = drawn("AAMMBB AAMMBB AAMMBB", {"A": [RED], "M": [RED, BLUE], "B": [RED]})


@pytest.fixture(scope="module")
def cases(tmp_path_factory: pytest.TempPathFactory) -> list[Case]:
    """A surface with unreachable vertices and cracks, one of the library, one without either."""
    folder = tmp_path_factory.mktemp("plans")
    random = blobs(4, 9, 3, cracks=2, holes=1)
    stored = LabelledSurface.read(PAPER / "split-cell.surface.json")
    return [Case(random, stored, folder), Case(stored, random, folder), Case(ROW, random, folder)]


@pytest.mark.parametrize("name", PLANTERS)
def test_every_planted_fault_is_caught(cases: list[Case], name: str) -> None:
    count = 0
    for case in cases:
        for seed in range(8):
            planted = PLANTERS[name](case, np.random.default_rng(seed))
            if planted is not None:
                assert caught(case, planted), planted
                count += 1
    assert count >= 8


@examples(12)
@given(surfaces(), st.integers(0, 2**31))
def test_no_valid_plan_contradicts_its_verdict(surface: LabelledSurface, seed: int) -> None:
    oracle = cellcolor.Oracle(surface, workers=1)
    hurried = cellcolor.Oracle(surface, workers=1, time_limit=1e-9)
    plans = valid_plans(oracle, np.random.default_rng(seed))
    for _, (_, colors) in zip(range(2 * len(SORTS)), plans, strict=False):
        for judge in (oracle, hurried):
            verdict = judge.judge(colors)
            assert contradictions(judge, colors, verdict, oracle.bounds.upper) == []
