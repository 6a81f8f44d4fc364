"""Solvers by name: what each declares it does, nothing else is asked of it; others' solvers."""

from __future__ import annotations

import pickle
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from commands import run
from guides import install
from library import PAPER

from cellcolor.data.instance import Instance
from cellcolor.errors import InputError, SolverMissing
from cellcolor.solvers.checked import enumerate_schemes, solve
from cellcolor.solvers.interface import Options, SchemeSolver, Start
from cellcolor.solvers.registry import (
    GROUP,
    OWN_NAMES,
    REFERENCE,
    make_solver,
    solver_names,
    solver_version,
)
from cellcolor.version import __version__

Capture = pytest.CaptureFixture[str]
RING = PAPER / "ring.json"
INSTANCE = Instance.read(RING)
ANNULUS = Instance.read(PAPER / "annulus.json")  # a cell with two live loops

ECHO = """
from cellcolor.solvers.dfs import ReferenceSolver

class Echo(ReferenceSolver):
    pass
"""


@pytest.fixture
def others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder on the path; what is imported from there is forgotten afterwards."""
    monkeypatch.syspath_prepend(str(tmp_path))
    before = set(sys.modules)
    yield tmp_path
    for name in set(sys.modules) - before:
        file = getattr(sys.modules[name], "__file__", None) or ""
        if file.startswith(str(tmp_path)):
            del sys.modules[name]


@pytest.fixture(params=OWN_NAMES)
def name(request: pytest.FixtureRequest) -> str:
    try:
        make_solver(request.param)
    except SolverMissing as error:
        pytest.skip(str(error))
    return str(request.param)


class TestAbilities:
    """Each is refused in one line where it is not declared, and used where it is."""

    def found(self, name: str, options: Options, instance: Instance = INSTANCE) -> int | None:
        return solve(instance, options, name).segments

    def test_search_space_surface(self, name: str) -> None:
        options = Options("surface")
        if "surface" in make_solver(name).abilities.search_spaces:
            assert self.found(name, options) == 2
            return
        with pytest.raises(InputError, match=f"search_space: is surface, the solver {name}"):
            self.found(name, options)

    def test_several_loops(self, name: str) -> None:
        expected = solve(ANNULUS, Options(), REFERENCE).segments
        assert self.found(name, Options(), ANNULUS) == expected

    def test_start(self, name: str) -> None:
        best = solve(INSTANCE, Options(), REFERENCE)
        options = Options(start=Start(best.cells or (), best.seams))
        if make_solver(name).abilities.start:
            assert self.found(name, options) == 2
            return
        with pytest.raises(InputError, match=f"start: is more than the solver {name} can do"):
            self.found(name, options)

    def test_optimal_schemes(self, name: str) -> None:
        known = INSTANCE.known
        assert known is not None and known.paper is not None
        able = make_solver(name).abilities.optimal_schemes
        assert able == isinstance(make_solver(name), SchemeSolver)
        if able:
            found = list(enumerate_schemes(INSTANCE, Options(), name, 2))
            assert len(found) == known.paper.schemes
            return
        with pytest.raises(InputError, match=f"schemes: is more than the solver {name} can do"):
            list(enumerate_schemes(INSTANCE, Options(), name, 2))

    def test_schemes_of_several_loops(self, name: str) -> None:
        able = make_solver(name).abilities
        minimum = solve(ANNULUS, Options(), REFERENCE).segments or 0
        if able.schemes_of_several_loops:
            assert list(enumerate_schemes(ANNULUS, Options(), name, minimum))
        elif able.optimal_schemes:
            with pytest.raises(InputError, match=f"the solver {name} lists optimal schemes"):
                list(enumerate_schemes(ANNULUS, Options(), name, minimum))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--solver", "nobody"], "'nobody' is not one of cp-sat, cp-sat-model, dfs"),
        (["--solver", "clingo", "--all"], "schemes: is more than the solver clingo"),
        (["--solver", "clingo", "--search-space", "surface"], "search_space: is surface"),
    ],
    ids=lambda value: "-".join(map(str, value[1:4:2])) if isinstance(value, list) else "",
)
def test_the_command_refuses_in_one_line(
    arguments: list[object], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "out.json"
    assert run("solve", RING, "-o", target, *arguments) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert message in lines[0]
    assert not target.exists()


def test_a_missing_extra_is_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "clingo", None)
    assert run("solve", RING, "--solver", "clingo") == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "the solver clingo is not installed: pip install 'fewest-lift-offs[peers]'" in line
    with pytest.raises(SolverMissing) as caught:
        make_solver("clingo")
    again = pickle.loads(pickle.dumps(caught.value))  # as from a process of its own
    assert (again.name, str(again)) == ("clingo", str(caught.value))


class TestOthers:
    """Solvers that other packages register as entry points."""

    def test_are_imported_when_they_are_asked_for(self, others: Path) -> None:
        install(others, "echoes", GROUP, {"echo": "echo_solver:Echo"}, echo_solver=ECHO)
        assert solver_names() == (*OWN_NAMES, "echo")
        assert solve(INSTANCE, Options()).segments == 2
        assert "echo_solver" not in sys.modules
        solution = solve(INSTANCE, Options(), "echo")
        assert (solution.solver, solution.segments) == ("echo", 2)
        assert "echo_solver" in sys.modules

    def test_the_command_takes_them(self, others: Path, capsys: pytest.CaptureFixture[str]) -> None:
        install(others, "echoes", GROUP, {"echo": "echo_solver:Echo"}, echo_solver=ECHO)
        assert run("solve", RING, "--solver", "echo", "--json") == 0
        assert '"solver": "echo"' in capsys.readouterr().out

    def test_versions_are_their_own_word_or_that_of_their_package(self, others: Path) -> None:
        install(others, "echoes", GROUP, {"echo": "echo_solver:Echo"}, echo_solver=ECHO)
        assert solver_version("echo") == "1.0"
        spoken = ECHO.replace("pass", "version = 'Echo 7'")
        install(others, "spoken", GROUP, {"told": "told_solver:Echo"}, told_solver=spoken)
        assert solver_version("told") == "Echo 7"
        assert solver_version(REFERENCE) == __version__
        assert solver_version("cp-sat").startswith("OR-Tools 9.")

    def test_say_that_they_are_missing(self, others: Path) -> None:
        text = "from cellcolor.errors import SolverMissing\n\ndef Echo():\n"
        text += "    raise SolverMissing('echo', 'apt install echo')\n"
        install(others, "lack", GROUP, {"echo": "echo_solver:Echo"}, echo_solver=text)
        with pytest.raises(SolverMissing, match="echo is not installed: apt install echo"):
            make_solver("echo")

    def test_what_declares_nothing_is_no_solver(self, others: Path, capsys: Capture) -> None:
        text = "class Echo: pass"
        install(others, "faulty", GROUP, {"echo": "echo_solver:Echo"}, echo_solver=text)
        assert run("solve", RING, "--solver", "echo") == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert "solver: 'echo', registered as echo_solver:Echo, is not a solver: it decl" in line
