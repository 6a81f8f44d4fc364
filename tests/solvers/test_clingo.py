"""Another solver, another model of the same problem, the same minimum."""

from __future__ import annotations

from pathlib import Path

import pytest
from library import PAPER
from rooms import four_colors_in_turn

from cellcolor.cli.solving import Interrupted
from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline
from cellcolor.errors import TooLarge
from cellcolor.lab.families import hub, hub_grid, hub_minimum, planar_graph
from cellcolor.solvers.checked import solve
from cellcolor.solvers.clingo import asp_facts
from cellcolor.solvers.cpsat import CpSatSolver
from cellcolor.solvers.interface import Options

pytestmark = pytest.mark.second

FIGURES = sorted(
    path
    for path in PAPER.glob("*.json")
    if not path.name.endswith(".surface.json") and Instance.read(path).most_live_loops < 2
)


def clingo_minimum(instance: Instance) -> int:
    """Of a division that the checker has seen."""
    pytest.importorskip("clingo")
    solution = solve(instance, Options(deadline=Deadline.after(60.0)), "clingo")
    assert solution.status == "optimal" and solution.segments is not None
    return solution.segments


def test_facts_are_the_live_graph() -> None:
    """Cells 0 and 1 share two edges; one of them is dead, the other joinable in color 2 only."""
    instance = Instance.from_document(
        {
            "format": "cellcolor/instance",
            "version": 1,
            "name": "two cells",
            "colors": ["a", "b", "c"],
            "cells": [
                {"id": 0, "colors": [0, 2], "loops": [[1, 7]]},
                {"id": 1, "colors": [0, 2], "loops": [[-1, -7]]},
            ],
            "edges": [
                {"id": 1, "left": 0, "right": 1, "colors": []},
                {"id": 7, "left": 0, "right": 1, "colors": [2]},
            ],
        }
    )
    assert asp_facts(instance).split() == [
        *("cell(0).", "at(0,0,7).", "cell(1).", "at(1,0,-7)."),
        *("side(7,7).", "side(7,-7).", "joinable(7,2)."),
    ]


def test_models_that_would_not_be_written_in_time_are_refused() -> None:
    """200 darts of one cell: 200 choose 4 pairs of chords."""
    with pytest.raises(TooLarge, match="64684950 pairs"):
        solve(four_colors_in_turn(200), Options(), "clingo")


@pytest.mark.parametrize("count", [0, 1])
def test_without_edges(count: int) -> None:
    pytest.importorskip("clingo")
    cells = tuple(Cell(number, (0,), ()) for number in range(count))
    solution = solve(Instance("no edges", ("c",), cells, ()), Options(), "clingo")
    assert (solution.status, solution.segments) == ("optimal", count)


@pytest.mark.parametrize("path", FIGURES, ids=lambda path: path.stem)
def test_figures(path: Path) -> None:
    instance = Instance.read(path)
    assert instance.known is not None and instance.known.paper is not None
    assert clingo_minimum(instance) == instance.known.paper.segments


@pytest.mark.parametrize("first", range(0, 50, 10))
def test_random_graphs(first: int) -> None:
    for seed in range(first, first + 10):
        instance = planar_graph(seed, 4 + seed % 6, 8 + seed % 6, 3, self_edges=seed % 2 == 1)
        answer = CpSatSolver().minimize(instance, Options(workers=1))
        assert clingo_minimum(instance) == answer.lower_bound, seed


def test_hubs() -> None:
    for seed in range(3):
        instance = hub(seed, 12, 4)
        ring = [cell.colors[0] for cell in instance.cells[1:]]
        assert clingo_minimum(instance) == hub_minimum(ring)
    grid = hub_grid(0, 2, 2, 4)
    answer = CpSatSolver().minimize(grid, Options())
    assert clingo_minimum(grid) == answer.lower_bound


def test_no_time_is_no_proof() -> None:
    pytest.importorskip("clingo")
    solution = solve(hub(0, 40, 4), Options(deadline=Deadline.after(0.01)), "clingo")
    assert solution.status != "optimal"


def test_interrupts_end_the_search_with_the_best(monkeypatch: pytest.MonkeyPatch) -> None:
    """A signal that stands for the end of the time, while clingo is waited for."""
    clingo = pytest.importorskip("clingo")
    asked = []
    wait = clingo.SolveHandle.wait

    def interrupted(handle: object, timeout: float) -> bool:
        asked.append(timeout)
        if len(asked) > 5:
            raise Interrupted("interrupted")
        return bool(wait(handle, timeout))

    monkeypatch.setattr(clingo.SolveHandle, "wait", interrupted)
    grid = hub_grid(0, 5, 5, 4)
    solution = solve(grid, Options(), "clingo")
    assert len(asked) == 6
    assert solution.status != "optimal"
