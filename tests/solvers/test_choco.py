"""Choco: known answers, other solvers, limits, what ends it."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from library import PAPER
from rooms import four_colors_in_turn

from cellcolor.cli.solving import Interrupted
from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.solution import count_segments
from cellcolor.deadline import Deadline
from cellcolor.errors import CellcolorError, SolverMissing, TooLarge
from cellcolor.lab.families import hub, hub_grid, hub_minimum, planar_graph
from cellcolor.processes import Child
from cellcolor.solvers.checked import solve
from cellcolor.solvers.choco import solver as choco
from cellcolor.solvers.choco.model import Ranks
from cellcolor.solvers.choco.problem import Problem
from cellcolor.solvers.dfs import ReferenceSolver
from cellcolor.solvers.interface import Options
from cellcolor.solvers.joined_chains import division_of_chains
from cellcolor.solvers.registry import make_solver, solver_version
from examples import examples

pytestmark = pytest.mark.second

FIGURES = sorted(
    path
    for path in PAPER.glob("*.json")
    if not path.name.endswith(".surface.json") and Instance.read(path).most_live_loops < 2
)
pytest.importorskip("pychoco")


def minimum(instance: Instance) -> int:
    """What the model finds and proves in this process, which is quicker than one of its own."""
    *found, last = Ranks(Problem.of(instance), 0).solutions(60.0)
    assert last == {"proved": True}
    best = found[-1]
    division = division_of_chains(instance, dict(best["colors"]), dict(best["after"]))
    assert count_segments(division) == best["segments"]
    return int(best["segments"])


@pytest.mark.parametrize("path", FIGURES, ids=lambda path: path.stem)
def test_figures(path: Path) -> None:
    instance = Instance.read(path)
    assert instance.known is not None and instance.known.paper is not None
    assert minimum(instance) == instance.known.paper.segments


@examples(12)
@given(seed=st.integers(0, 10**6), cells=st.integers(3, 5), self_edges=st.booleans())
def test_reference_solver(seed: int, cells: int, self_edges: bool) -> None:
    instance = planar_graph(seed, cells, cells + 3, 3, self_edges=self_edges)
    assert minimum(instance) == ReferenceSolver().minimize(instance, Options()).lower_bound


@examples(6)
@given(seed=st.integers(0, 10**6), petals=st.integers(4, 9))
def test_hubs(seed: int, petals: int) -> None:
    instance = hub(seed, petals, 4)
    assert minimum(instance) == hub_minimum([cell.colors[0] for cell in instance.cells[1:]])


def test_a_hub_is_bounded_before_the_search() -> None:
    """The petals less the most links of the hub, which the sum over all cells tells at once."""
    instance = hub(0, 24, 4)
    built = Ranks(Problem.of(instance), 0)
    fewest = hub_minimum([cell.colors[0] for cell in instance.cells[1:]])
    built.model.arithm(built.segments, "<", fewest).post()
    assert [*built.solutions(60.0)] == [{"proved": True}]
    assert built.model.get_solver().get_fail_count() <= 1


def test_in_a_process_of_its_own() -> None:
    """The whole way, and the checker has seen the division."""
    heard: list[int | None] = []
    instance = Instance.read(PAPER / "split-cell.json")
    solution = solve(instance, Options(), "choco", lambda best, _: heard.append(best))
    assert instance.known is not None and instance.known.paper is not None
    assert (solution.status, solution.segments) == ("optimal", instance.known.paper.segments)
    assert heard[-1] == solution.segments


@pytest.mark.parametrize("count", [0, 1])
def test_without_edges(count: int) -> None:
    cells = tuple(Cell(number, (0,), ()) for number in range(count))
    solution = solve(Instance("no edges", ("c",), cells, ()), Options(), "choco")
    assert (solution.status, solution.segments) == ("optimal", count)


def test_models_that_would_not_fit_are_refused() -> None:
    with pytest.raises(TooLarge, match="terms is not built"):
        solve(four_colors_in_turn(220), Options(), "choco")


def test_at_the_deadline_the_best_and_a_bound() -> None:
    """It finds a division of this grid within a second, and would take hours for a proof.

    On a machine so busy that it finds none, there is none.
    """
    solution = solve(hub_grid(0, 10, 10, 4, 3), Options(deadline=Deadline.after(6.0)), "choco")
    assert solution.status in ("feasible", "unknown")
    assert solution.lower_bound >= 4  # of four colors there is a petal each


def test_no_time_is_no_proof() -> None:
    solution = solve(hub(0, 40, 4), Options(deadline=Deadline.after(-1.0)), "choco")
    assert solution.status == "unknown"


def test_a_signal_ends_the_process_and_keeps_the_best(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that stands for the end of the time. Choco itself would search on for hours."""
    left: list[float] = []
    leave = Child.__exit__

    def heard(best: int | None, _: int) -> None:
        if best is not None:
            raise Interrupted("interrupted")

    def leaving(child: Child, *error: object) -> None:
        begun = time.monotonic()
        leave(child, *error)
        left.append(time.monotonic() - begun)

    monkeypatch.setattr(Child, "__exit__", leaving)
    solution = solve(hub_grid(0, 5, 5, 4), Options(), "choco", heard)
    assert solution.status == "feasible"
    assert len(left) == 1  # the process has been waited for, so it is gone


def test_failures_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(choco, "__name__", "cellcolor.no_such_module")
    with pytest.raises(CellcolorError, match="No module named cellcolor"):
        make_solver("choco").minimize(Instance.read(PAPER / "ring.json"), Options())


def test_lines_of_choco_itself_are_no_solutions() -> None:
    assert choco._told("before handle (BoolVar 'x' = [0, 1])") == {}
    assert choco._told("3") == {}


def test_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pychoco", None)
    with pytest.raises(SolverMissing, match="choco is not installed: pip install 'fewest"):
        make_solver("choco")


def test_version() -> None:
    assert solver_version("choco").startswith("pychoco 0.")
