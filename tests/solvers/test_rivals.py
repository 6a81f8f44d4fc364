"""Solvers from outside: the known minima, the best at the time limit, and what becomes of them."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from itertools import islice
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from library import PAPER
from rooms import four_colors_in_turn

from cellcolor import processes
from cellcolor.cli.solving import Interrupted
from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.solution import count_segments
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition import decompose
from cellcolor.errors import CellcolorError, SolverMissing, TooLarge
from cellcolor.lab.families import hub, hub_grid, hub_minimum, hub_with_loops, planar_graph
from cellcolor.lab.families.registry import SMALL
from cellcolor.processes import Child
from cellcolor.solvers import peers
from cellcolor.solvers.checked import solve
from cellcolor.solvers.choco import solver as choco
from cellcolor.solvers.choco.model import Problem, Ranks
from cellcolor.solvers.dfs import ReferenceSolver
from cellcolor.solvers.interface import Options
from cellcolor.solvers.joined_chains import division_of_chains
from cellcolor.solvers.linear.coloring import Coloring
from cellcolor.solvers.registry import REFERENCE, make_solver, solver_version
from cellcolor.solvers.seamed import Seamed
from examples import examples

pytestmark = pytest.mark.second

RIVALS = ("choco", "clingo", "highs", "scip", "maxsat", "gecode", "chuffed")
FIGURES = sorted(
    path
    for path in PAPER.glob("*.json")
    if not path.name.endswith(".surface.json") and Instance.read(path).most_live_loops < 2
)


def found_or_skip(name: str) -> str:
    try:
        make_solver(name)
    except SolverMissing as error:
        pytest.skip(str(error))
    return name


@pytest.fixture(params=RIVALS)
def name(request: pytest.FixtureRequest) -> str:
    return found_or_skip(request.param)


# --- minima ---------------------------------------------------------------------------------------


def by_choco(instance: Instance) -> int:
    """What the model finds and proves in this process, which is quicker than one of its own."""
    found_or_skip("choco")
    *found, last = Ranks(Problem.of(instance), 0).solutions(60.0)
    assert last == {"proved": True}
    best = found[-1]
    division = division_of_chains(instance, dict(best["colors"]), dict(best["after"]))
    assert count_segments(division) == best["segments"]
    return int(best["segments"])


def by_clingo(instance: Instance) -> int:
    """Of a division that the checker has seen."""
    found_or_skip("clingo")
    solution = solve(instance, Options(deadline=Deadline.after(60.0)), "clingo")
    assert solution.status == "optimal" and solution.segments is not None
    return solution.segments


HERE = pytest.mark.parametrize("minimum", [by_choco, by_clingo])
Minimum = Callable[[Instance], int]


@HERE
@pytest.mark.parametrize("path", FIGURES, ids=lambda path: path.stem)
def test_figures(minimum: Minimum, path: Path) -> None:
    instance = Instance.read(path)
    assert instance.known is not None and instance.known.paper is not None
    assert minimum(instance) == instance.known.paper.segments


@HERE
@examples(20)
@given(seed=st.integers(0, 10**6), cells=st.integers(3, 6), self_edges=st.booleans())
def test_random_graphs(minimum: Minimum, seed: int, cells: int, self_edges: bool) -> None:
    instance = planar_graph(seed, cells, cells + 3, 3, self_edges=self_edges)
    assert minimum(instance) == ReferenceSolver().minimize(instance, Options()).lower_bound


@HERE
@examples(6)
@given(seed=st.integers(0, 10**6), petals=st.integers(4, 9))
def test_hubs(minimum: Minimum, seed: int, petals: int) -> None:
    instance = hub(seed, petals, 4)
    assert minimum(instance) == hub_minimum([cell.colors[0] for cell in instance.cells[1:]])


def test_known_minima(name: str) -> None:
    """By way of a process of its own where a solver has one; progress never goes back."""
    cases = [Instance.read(PAPER / f"{figure}.json") for figure in ("crossing-zeros",)]
    cases += [planar_graph(seed, 5 + seed, 9 + seed, 3, self_edges=seed > 1) for seed in (0, 2)]
    for instance in cases:
        told: list[tuple[int | None, int]] = []
        options = Options(deadline=Deadline.after(60.0))
        solution = solve(instance, options, name, lambda *at, told=told: told.append(at))
        expected = solve(instance, Options(), REFERENCE).segments
        assert (solution.status, solution.segments) == ("optimal", expected), instance.name
        found = [segments for segments, _ in told if segments is not None]
        bounds = [bound for _, bound in told]
        assert found == sorted(found, reverse=True) and bounds == sorted(bounds)
        assert found[-1] == solution.segments
    assert solution.model is not None and solution.model.variables > len(instance.cells)


@pytest.mark.parametrize("solver", ["clingo", "highs", "maxsat"])
@examples(5)
@given(seed=st.integers(0, 10**4))
def test_cells_with_several_loops(solver: str, seed: int) -> None:
    """``dfs-cover`` has seams of its own, elsewhere; the checker sees both divisions."""
    made = SMALL["islands, holes"](seed)
    instance = made if isinstance(made, Instance) else decompose(made)
    assert instance.most_live_loops > 1
    expected = solve(instance, Options(), "dfs-cover")
    found = solve(instance, Options(workers=1), found_or_skip(solver))
    assert (expected.status, found.status) == ("optimal", "optimal")
    assert found.segments == expected.segments


def test_an_instance_without_seams_stays_as_it_is() -> None:
    ring = Instance.read(PAPER / "ring.json")
    assert Seamed(ring).instance is ring


def test_a_hub_is_bounded_before_choco_searches() -> None:
    """The petals less the most links of the hub, which the sum over all cells tells at once."""
    found_or_skip("choco")
    instance = hub(0, 24, 4)
    built = Ranks(Problem.of(instance), 0)
    fewest = hub_minimum([cell.colors[0] for cell in instance.cells[1:]])
    built.model.arithm(built.segments, "<", fewest).post()
    assert [*built.solutions(60.0)] == [{"proved": True}]
    assert built.model.get_solver().get_fail_count() <= 1


# --- limits ---------------------------------------------------------------------------------------


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


def test_too_many_strands() -> None:
    with pytest.raises(TooLarge, match="the seams need"):
        Seamed(hub_with_loops(0, 12, 2, 2))


def test_no_time_is_no_proof(name: str) -> None:
    solution = solve(hub(0, 40, 4), Options(deadline=Deadline.after(0.01)), name)
    assert solution.status != "optimal"


def test_the_best_at_the_time_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """A solver that has every cell alone and a bound, and then goes on for ever."""
    instance = planar_graph(3, 7, 11, 3)
    model = Coloring(instance).model
    alone = [f"x{v}" for v in model.costs if model.names[v][0] == "alone"]
    says = f"echo bound 1.99999; echo solution {' '.join(alone)}; exec sleep 600"
    start = processes.subprocess.Popen
    monkeypatch.setattr(peers, "find_spec", lambda _: True)
    monkeypatch.setattr(
        processes.subprocess,
        "Popen",
        lambda _, **options: start(["/bin/sh", "-c", says], **options),
    )
    solution = solve(instance, Options(deadline=Deadline.after(3.0)), "highs")
    assert (solution.status, solution.lower_bound) == ("feasible", 2)
    assert solution.segments is not None and 4 <= solution.segments <= 7


def test_a_worse_division_does_not_replace_a_better_one() -> None:
    instance = planar_graph(3, 7, 11, 3)
    told: list[tuple[int | None, int]] = []
    search = peers.PeerSearch(instance, NEVER, 0, lambda *at: told.append(at))
    best = solve(instance, Options(), REFERENCE)
    assert best.cells is not None and best.segments is not None
    search.found(best.cells)
    search.found(division_of_chains(instance, {}, {}))
    search.done()
    assert search.best == best.cells
    assert told == [(best.segments, 0)] * 2 + [(best.segments, best.segments)]


# --- signals --------------------------------------------------------------------------------------


def test_a_signal_ends_choco_and_keeps_the_best(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that stands for the end of the time. Choco itself would search on for hours."""
    found_or_skip("choco")
    left: list[Child] = []
    leave = Child.__exit__

    def heard(best: int | None, _: int) -> None:
        if best is not None:
            raise Interrupted("interrupted")

    def leaving(child: Child, *error: object) -> None:
        leave(child, *error)
        left.append(child)

    monkeypatch.setattr(Child, "__exit__", leaving)
    solution = solve(hub_grid(0, 5, 5, 4), Options(), "choco", heard)
    assert solution.status == "feasible"
    assert len(left) == 1  # the process has been waited for, so it is gone


def test_interrupts_end_clingo_with_the_best(monkeypatch: pytest.MonkeyPatch) -> None:
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
    solution = solve(hub_grid(0, 5, 5, 4), Options(), "clingo")
    assert len(asked) == 6
    assert solution.status != "optimal"


def test_a_signal_ends_the_search_and_the_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """As Ctrl-C does in the command: the best so far is the answer, nothing goes on running."""
    processes = []
    lines = Child.lines

    def interrupted(self: Child, deadline: Deadline) -> object:
        processes.append(self._process)
        yield from islice(lines(self, deadline), 1)
        raise Interrupted("interrupted")

    monkeypatch.setattr(Child, "lines", interrupted)
    found_or_skip("scip")
    solution = solve(hub_grid(0, 4, 4, 5), Options(), "scip")
    assert solution.status != "optimal"
    assert [process.poll() is not None for process in processes] == [True]


# --- programs that misbehave ----------------------------------------------------------------------


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

    monkeypatch.setattr(peers, "find_spec", lambda _: True)
    monkeypatch.setattr(processes.subprocess, "Popen", replaced)
    with pytest.raises(CellcolorError, match=r"highs: .*broken"):
        solve(instance, Options(), "highs")
    solution = solve(instance, Options(), "highs")
    assert (solution.status, solution.lower_bound) == ("unknown", 2)
    assert "ended early" in solution.notes[0]


def test_failures_of_choco_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    found_or_skip("choco")
    monkeypatch.setattr(choco, "__name__", "cellcolor.no_such_module")
    with pytest.raises(CellcolorError, match="No module named cellcolor"):
        make_solver("choco").minimize(Instance.read(PAPER / "ring.json"), Options())


def test_lines_of_choco_itself_are_no_solutions() -> None:
    assert choco._told("before handle (BoolVar 'x' = [0, 1])") == {}
    assert choco._told("3") == {}


def test_missing_ones_say_how_to_get_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(peers, "find_spec", lambda _: None)
    monkeypatch.setenv("PATH", "")
    for module in ("pychoco", "clingo"):
        monkeypatch.setitem(sys.modules, module, None)
    for name in RIVALS:
        with pytest.raises(SolverMissing, match=f"the solver {name} is not installed: "):
            make_solver(name)
