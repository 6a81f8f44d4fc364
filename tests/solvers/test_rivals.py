"""Solvers from outside: the known minima, the best at the time limit, and what becomes of them."""

from __future__ import annotations

import sys
import time
from itertools import islice
from pathlib import Path

import pytest
from library import PAPER
from rooms import four_colors_in_turn

from cellcolor import processes
from cellcolor.cli.solving import Interrupted
from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import CellcolorError, SolverMissing, TooLarge
from cellcolor.lab.families import hub, hub_grid, planar_graph
from cellcolor.processes import Child
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options
from cellcolor.solvers.linear import rivals
from cellcolor.solvers.linear.coloring import Coloring
from cellcolor.solvers.registry import REFERENCE, make_solver, solver_version

pytestmark = pytest.mark.second

RIVALS = ("highs", "scip", "maxsat", "gecode", "chuffed")


@pytest.fixture(params=RIVALS)
def name(request: pytest.FixtureRequest) -> str:
    try:
        make_solver(request.param)
    except SolverMissing as error:
        pytest.skip(str(error))
    return str(request.param)


def test_known_minima(name: str) -> None:
    cases = [Instance.read(PAPER / f"{figure}.json") for figure in ("crossing-zeros",)]
    cases += [planar_graph(seed, 5 + seed, 9 + seed, 3, self_edges=seed > 1) for seed in (0, 2)]
    for instance in cases:
        expected = solve(instance, Options(), REFERENCE).segments
        solution = solve(instance, Options(deadline=Deadline.after(60.0)), name)
        assert (solution.status, solution.segments) == ("optimal", expected), instance.name


@pytest.mark.parametrize("count", [0, 1])
def test_without_edges(name: str, count: int) -> None:
    cells = tuple(Cell(number, (0,), ()) for number in range(count))
    solution = solve(Instance("no edges", ("c",), cells, ()), Options(), name)
    assert (solution.status, solution.segments) == ("optimal", count)


def test_versions_have_a_number(name: str) -> None:
    assert any(letter.isdigit() for letter in solver_version(name))


def test_what_is_too_large_is_refused(name: str) -> None:
    with pytest.raises(TooLarge):
        solve(four_colors_in_turn(400), Options(), name)


def test_no_time_is_no_proof(name: str) -> None:
    solution = solve(hub(0, 40, 4), Options(deadline=Deadline.after(0.01)), name)
    assert solution.status != "optimal"


def test_progress_never_goes_back(name: str) -> None:
    told: list[tuple[int | None, int]] = []
    options = Options(deadline=Deadline.after(60.0))
    solution = solve(planar_graph(3, 7, 11, 3), options, name, lambda *at: told.append(at))
    found = [segments for segments, _ in told if segments is not None]
    bounds = [bound for _, bound in told]
    assert found == sorted(found, reverse=True) and bounds == sorted(bounds)
    assert found[-1] == solution.segments


def test_the_best_at_the_time_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """A solver that has every cell alone and a bound, and then goes on for ever."""
    instance = planar_graph(3, 7, 11, 3)
    model = Coloring(instance).model
    alone = [f"x{v}" for v in model.costs if model.names[v][0] == "alone"]
    says = f"echo bound 1.99999; echo solution {' '.join(alone)}; exec sleep 600"
    start = processes.subprocess.Popen
    monkeypatch.setattr(rivals, "find_spec", lambda _: True)
    monkeypatch.setattr(
        processes.subprocess,
        "Popen",
        lambda _, **options: start(["/bin/sh", "-c", says], **options),
    )
    solution = solve(instance, Options(deadline=Deadline.after(3.0)), "highs")
    assert (solution.status, solution.lower_bound) == ("feasible", 2)
    assert solution.segments is not None and 4 <= solution.segments <= 7


def test_a_signal_ends_the_search_and_the_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """As Ctrl-C does in the command: the best so far is the answer, nothing goes on running."""
    processes = []
    lines = Child.lines

    def interrupted(self: Child, deadline: Deadline) -> object:
        processes.append(self._process)
        yield from islice(lines(self, deadline), 1)
        raise Interrupted("interrupted")

    monkeypatch.setattr(Child, "lines", interrupted)
    pytest.importorskip("pyscipopt")
    solution = solve(hub_grid(0, 4, 4, 5), Options(), "scip")
    assert solution.status != "optimal"
    assert [process.poll() is not None for process in processes] == [True]


# --- programs that misbehave ---------------------------------------------------------------------


def test_a_program_that_does_not_end_is_killed_with_its_children(tmp_path: Path) -> None:
    """A grandchild writes on and on; it must not outlive the deadline."""
    mark = tmp_path / "mark"
    grandchild = f"import time\nwhile True: open({str(mark)!r}, 'a').write('.'); time.sleep(0.02)"
    script = (
        "import subprocess, sys, time; print('one', flush=True); "
        f"subprocess.Popen([sys.executable, '-c', {grandchild!r}]); time.sleep(600)"
    )
    with Child([sys.executable, "-c", script], tmp_path) as program:
        assert list(program.lines(Deadline.after(2.0))) == ["one"]
        assert program.failure is None
    size = mark.stat().st_size if mark.exists() else 0
    time.sleep(0.2)
    assert (mark.stat().st_size if mark.exists() else 0) == size


def test_a_program_that_is_killed_leaves_its_files_in_the_folder(tmp_path: Path) -> None:
    """MiniZinc keeps the flattened model in a temporary file, and a killed one cannot remove it."""
    script = (
        "import os, tempfile, time; print(os.getcwd()); "
        "print(tempfile.mkstemp()[1], flush=True); time.sleep(600)"
    )
    with Child([sys.executable, "-c", script], tmp_path) as program:
        where, file = islice(program.lines(NEVER), 2)
    assert Path(where) == Path.cwd()
    assert Path(file).exists() and Path(file).parent == tmp_path


def test_a_program_that_fails_says_why(tmp_path: Path) -> None:
    script = "import sys; print('one'); sys.exit('out of order')"
    with Child([sys.executable, "-c", script], tmp_path) as program:
        assert list(program.lines(NEVER)) == ["one"]
        assert program.failure is not None and "out of order" in program.failure


def test_a_program_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(CellcolorError, match="no-such-program: No such file"):
        Child(["no-such-program"], tmp_path)


def test_a_solver_that_fails_is_an_error_or_a_note(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without any result it is an error; what it had found or proved before is kept."""
    instance = planar_graph(3, 7, 11, 3)
    start = processes.subprocess.Popen
    scripts = iter(("raise SystemExit('broken')", "print('bound 2'); raise SystemExit('broken')"))

    def replaced(_command: object, **options: object) -> object:
        return start([sys.executable, "-c", next(scripts)], **options)

    monkeypatch.setattr(rivals, "find_spec", lambda _: True)
    monkeypatch.setattr(processes.subprocess, "Popen", replaced)
    with pytest.raises(CellcolorError, match=r"highs: .*broken"):
        solve(instance, Options(), "highs")
    solution = solve(instance, Options(), "highs")
    assert (solution.status, solution.lower_bound) == ("unknown", 2)
    assert "ended early" in solution.notes[0]


def test_missing_ones_say_how_to_get_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rivals, "find_spec", lambda _: None)
    monkeypatch.setenv("PATH", "")
    for name in RIVALS:
        with pytest.raises(SolverMissing, match=f"the solver {name} is not installed: "):
            make_solver(name)
