"""Another solver, another model of the same problem, the same minimum."""

from __future__ import annotations

from pathlib import Path

import pytest
from library import PAPER

from cellcolor.data.instance import Instance
from cellcolor.errors import CellcolorError, InputError
from cellcolor.lab.campaign.cases import live_loops
from cellcolor.lab.families import hub, hub_grid, hub_minimum, planar_graph
from cellcolor.lab.peers import asp_facts, measure_clingo
from cellcolor.lab.races import Run
from cellcolor.solvers.cpsat import CpSatSolver
from cellcolor.solvers.interface import Options

MODEL = PAPER.parents[1] / "models" / "constraints" / "coloring.lp"
FIGURES = sorted(
    path
    for path in PAPER.glob("*.json")
    if not path.name.endswith(".surface.json") and live_loops(Instance.read(path)) < 2
)


def clingo_minimum(instance: Instance) -> int:
    pytest.importorskip("clingo")
    run = measure_clingo(instance, MODEL, 60.0)
    assert run.optimal and run.segments is not None
    return run.segments


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


def test_cells_with_several_loops_are_refused() -> None:
    with pytest.raises(InputError, match="one live loop, this one has 2"):
        asp_facts(Instance.read(PAPER / "annulus.json"))


def test_a_failing_process_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(CellcolorError, match="clingo failed"):
        measure_clingo(planar_graph(0, 2, 2, 2), tmp_path / "missing.lp", 5.0)


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
    run = measure_clingo(hub(0, 40, 4), MODEL, 0.01)
    assert isinstance(run, Run) and not run.optimal
