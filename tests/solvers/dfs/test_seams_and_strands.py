"""Strands and seams in the reference solver."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
from library import PAPER
from reference import SOLVER, SURFACE, segments
from relabelled import turned_loop

from cellcolor.data.instance import Instance
from cellcolor.solvers.dfs.graph import Graphs
from cellcolor.solvers.interface import Options


def test_strands_reach_divisions_of_the_surface() -> None:
    """Red and blue pass side by side through one edge: below the paper's minimum."""
    instance = Instance.read(PAPER / "parallel-corridors.json")
    assert segments(instance, SOLVER.minimize(instance, Options())) == 3
    answer = SOLVER.minimize(instance, SURFACE)
    assert segments(instance, answer, strands=2) == answer.lower_bound == 2


def test_bound_in_surface_is_not_the_minimum_of_two_strands() -> None:
    """The minimum with k strands is proved for k strands only: the bound stays what covers say."""
    instance = Instance.read(PAPER / "annulus.json")
    answer = SOLVER.minimize(instance, SURFACE)
    assert segments(instance, answer, strands=2) == 3
    assert answer.lower_bound == 2


def test_seams_have_enough_strands() -> None:
    annulus = Instance.read(PAPER / "annulus.json")  # 4 live darts around, 1 inside
    assert Graphs(annulus, 1).sufficient_seam_strands(1) == [5 // 2 - 1]
    assert Graphs(annulus, 2).sufficient_seam_strands(1) == [10 // 2 - 1]
    three = Instance.read(PAPER / "three-loops.json")  # 8 live darts, then 8 + 2 * 4
    assert Graphs(three, 1).sufficient_seam_strands(0) == [4, 8]


@pytest.mark.second
@pytest.mark.parametrize(("name", "cell", "minimum"), [("annulus", 1, 3), ("three-loops", 0, 4)])
def test_order_of_loops_does_not_matter(name: str, cell: int, minimum: int) -> None:
    instance = Instance.read(PAPER / f"{name}.json")
    for seed in range(4):
        rng = random.Random(seed)
        loops = list(instance.cells[cell].loops)
        rng.shuffle(loops)
        cells = list(instance.cells)
        cells[cell] = replace(cells[cell], loops=tuple(turned_loop(loop, rng) for loop in loops))
        other = replace(instance, cells=tuple(cells))
        assert segments(other, SOLVER.minimize(other, Options())) == minimum


def test_seams_carry_what_must_pass() -> None:
    """Strands are added one by one, so seams that have some could not do without."""
    instance = Instance.read(PAPER / "three-loops.json")
    answer = SOLVER.minimize(instance, Options())
    assert segments(instance, answer) == 4
    assert len(answer.seams) == 2 and all(seam.strands > 0 for seam in answer.seams)
    assert {seam.id for seam in answer.seams} == {9, 10}  # above its 8 edges
