"""Models for solvers from outside: what is written, solved for real, and read back."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from commands import run
from hypothesis import given
from hypothesis import strategies as st
from library import PAPER
from ortools.sat.python import cp_model
from rooms import four_colors_in_turn

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.errors import InputError, TooLarge
from cellcolor.files.writing import shipped_folder
from cellcolor.lab.families import hub, planar_graph
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options
from cellcolor.solvers.linear.coloring import Coloring, estimated_terms
from cellcolor.solvers.linear.model import Model
from cellcolor.solvers.portable import PORTABLE, read_answer
from cellcolor.solvers.registry import REFERENCE
from examples import examples

pytestmark = pytest.mark.second

FIGURES = sorted(
    path
    for path in PAPER.glob("*.json")
    if not path.name.endswith(".surface.json") and Instance.read(path).most_live_loops < 2
)
MODELS = shipped_folder() / "models" / "constraints"


def values_of_an_optimum(model: Model) -> list[bool]:
    """Of every variable, in an optimum that CP-SAT proves."""
    formula = cp_model.CpModel()
    true = [formula.new_bool_var("") for _ in model.names]

    def literals(row: tuple[int, ...]) -> list[cp_model.LiteralT]:
        return [true[v] if v > 0 else true[-v].negated() for v in row]

    for row in model.at_least_one:
        formula.add_bool_or(literals(row))
    for row in model.at_most_one:
        formula.add_at_most_one(literals(row))
    for row in model.exactly_one:
        formula.add_exactly_one(literals(row))
    formula.minimize(sum(true[v] for v in model.costs))
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    solver.parameters.max_time_in_seconds = 60
    assert solver.solve(formula) == cp_model.OPTIMAL
    return [bool(solver.value(v)) for v in true]


def minimum_of_model(instance: Instance) -> int:
    """What the 0-1 model counts; the division read off its values has as many segments."""
    model = Coloring(instance).model
    values = values_of_an_optimum(model)
    counted = sum(values[v] for v in model.costs)
    text = "v " + " ".join(f"{'' if v else '-'}x{n}" for n, v in enumerate(values) if n)
    division = read_answer(instance, f"o {counted}\n{text}\n", "opb").division
    assert len({sub.segment for cell in division for sub in cell.subcells}) == counted
    return counted


def known_minimum(instance: Instance) -> int:
    """By the depth-first search."""
    solution = solve(instance, Options(), REFERENCE)
    assert solution.status == "optimal" and solution.segments is not None
    return solution.segments


@pytest.mark.parametrize("path", FIGURES, ids=lambda path: path.stem)
def test_model_of_figures(path: Path) -> None:
    instance = Instance.read(path)
    assert instance.known is not None and instance.known.paper is not None
    assert minimum_of_model(instance) == instance.known.paper.segments


@given(st.integers(0, 2**20), st.integers(2, 7), st.integers(0, 5), st.booleans())
@examples(20)
def test_model_of_random_graphs(seed: int, cells: int, more: int, self_edges: bool) -> None:
    instance = planar_graph(seed, cells, cells + more, 3, self_edges=self_edges)
    assert minimum_of_model(instance) == known_minimum(instance)


def test_clauses_say_what_the_rows_say() -> None:
    """At most one of n literals, also of more than the pairs of which are written down."""
    for size in range(2, 10):
        model = Model()
        literals = [model.new("v", n) for n in range(size)]
        model.one_at_most(literals)
        top, clauses = model.clauses()
        found = {
            bits & (2**size - 1)
            for bits in range(2**top)
            if all(any((bits >> (abs(x) - 1) & 1) == (x > 0) for x in c) for c in clauses)
        }
        assert found == {0, *(1 << n for n in range(size))}


def test_what_is_too_large_is_refused_before_it_is_made(tmp_path: Path) -> None:
    huge = four_colors_in_turn(400)
    assert estimated_terms(huge) > 5_000_000
    for name in ("opb", "wcnf", "mps", "lp"):
        with pytest.raises(TooLarge):
            PORTABLE[name].write(huge)
    file, target = tmp_path / "huge.json", tmp_path / "huge.opb"
    file.write_text(huge.to_json())
    assert run("export", file, "-o", target) == 2
    assert not target.exists()


def test_files_of_ours_only_are_overwritten(tmp_path: Path) -> None:
    for name in PORTABLE:
        target = tmp_path / f"a.{name}"
        assert run("export", FIGURES[0], "-o", target) == 0
        assert run("export", FIGURES[-1], "-o", target) == 0
        target.write_text("mine\n")
        assert run("export", FIGURES[0], "-o", target) == 2
        assert target.read_text() == "mine\n"


def test_the_ending_says_the_format(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("export", FIGURES[0], "-o", tmp_path / "a.txt") == 2
    assert "not end in any of .pbtxt, .pb, .opb, .wcnf, .mps, .dzn, .lp" in capsys.readouterr().err
    assert run("export", FIGURES[0], "-o", tmp_path / "a.txt", "--format", "opb") == 0


# --- solvers really run on the files -------------------------------------------------------------


def highs(file: Path) -> str:
    """HiGHS cannot be loaded into a process that has loaded OR-Tools."""
    pytest.importorskip("importlib.metadata").version("highspy")
    target = file.with_suffix(".sol")
    script = (
        "import highspy; h = highspy.Highs(); h.silent(); "
        f"h.readModel({str(file)!r}); h.run(); h.writeSolution({str(target)!r}, 0)"
    )
    subprocess.run([sys.executable, "-c", script], check=True)
    return target.read_text()


def scip(file: Path) -> str:
    model = pytest.importorskip("pyscipopt").Model()
    model.hideOutput()
    model.readProblem(str(file))
    model.optimize()
    target = file.with_suffix(".sol")
    model.writeBestSol(str(target), write_zeros=False)
    return "solution status: optimal solution found\n" + target.read_text()


def scip_by_literals(file: Path) -> str:
    """As solvers of pseudo-Boolean constraints answer."""
    shown = scip(file)
    true = {line.split()[0] for line in shown.splitlines() if line.startswith("x")}
    count = int(file.read_text().split()[2])
    values = [f"{'' if f'x{n}' in true else '-'}x{n}" for n in range(1, count + 1)]
    half = len(values) // 2
    lines = ["s OPTIMUM FOUND", f"v {' '.join(values[:half])}", f"v {' '.join(values[half:])}"]
    return "\n".join(lines) + "\n"


def rc2(file: Path) -> list[int]:
    examples = pytest.importorskip("pysat.examples.rc2")
    formula = pytest.importorskip("pysat.formula").WCNF(from_file=str(file))
    with examples.RC2(formula) as solver:
        found: list[int] = solver.compute()
        return [*found, *(-n for n in range(len(found) + 1, formula.nv + 1))]


def rc2_by_literals(file: Path) -> str:
    return f"s OPTIMUM FOUND\nv {' '.join(map(str, rc2(file)))} 0\n"


def rc2_by_bits(file: Path) -> str:
    return f"s OPTIMUM FOUND\nv {''.join(str(int(value > 0)) for value in rc2(file))}\n"


def minizinc(file: Path) -> str:
    if shutil.which("minizinc") is None:
        pytest.skip("minizinc is not installed")
    command = ["minizinc", "--solver", "gecode", str(MODELS / "coloring.mzn"), str(file)]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def clingo(file: Path) -> str:
    pytest.importorskip("clingo")
    command = [sys.executable, "-m", "clingo", str(MODELS / "coloring.lp"), str(file)]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


@pytest.mark.parametrize(
    ("name", "kind", "answer"),
    [
        ("mps", "mps", highs),
        ("mps", "mps", scip),
        ("opb", "mps", scip),
        ("opb", "opb", scip_by_literals),
        ("wcnf", "wcnf", rc2_by_literals),
        ("wcnf", "wcnf", rc2_by_bits),
        ("dzn", "dzn", minizinc),
        ("lp", "lp", clingo),
    ],
    ids=lambda value: getattr(value, "__name__", value),
)
def test_there_and_back(
    name: str,
    kind: str,
    answer: Callable[[Path], str],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    several_loops = Instance.read(PAPER / "annulus.json")
    for number, instance in enumerate((planar_graph(3, 7, 11, 3), hub(1, 8, 3), several_loops)):
        file = tmp_path / f"{number}.json"
        file.write_text(instance.to_json())
        model, given, target = (tmp_path / f"{number}.{end}" for end in (name, "txt", "out.json"))
        assert run("export", file, "-o", model) == 0
        given.write_text(answer(model))
        capsys.readouterr()
        assert run("answer", file, given, "--format", kind, "-o", target) == 0
        assert "this is not a proof" in capsys.readouterr().out
        assert run("check", file, target) == 0
        solution = Solution.read(target)
        assert (solution.status, solution.segments) == ("feasible", known_minimum(instance))
        assert (solution.bounds, len(solution.notes)) == ((), 1)


# --- answers that are none -----------------------------------------------------------------------

TWO = planar_graph(3, 7, 11, 3)
DART = TWO.live_edges[0]


def literals_of(values: list[bool]) -> str:
    return "v " + " ".join(f"{'' if v else '-'}x{n}" for n, v in enumerate(values) if n) + "\n"


def test_values_that_break_a_constraint_are_refused() -> None:
    """Every single value changed: a worse solution, or none; never a better one."""
    model = Coloring(TWO).model
    values = values_of_an_optimum(model)
    best = sum(values[v] for v in model.costs)
    refused = 0
    for changed in range(1, len(values)):
        forged = [v != (n == changed) for n, v in enumerate(values)]
        try:
            division = read_answer(TWO, literals_of(forged), "opb").division
        except InputError:
            refused += 1
            continue
        assert len({sub.segment for cell in division for sub in cell.subcells}) >= best
    assert refused > 0.8 * len(values)


@pytest.mark.parametrize(
    ("kind", "text", "message"),
    [
        ("opb", "s UNSATISFIABLE\n", "has no line 'v …' with values"),
        ("opb", "v x1 y2\n", "'y2' is not a literal"),
        ("opb", "v x1 -x2\n", "x3: has no value"),
        ("wcnf", "v 1 x 0\n", "must be bits, or literals"),
        ("wcnf", "v 0110\n", "x5: has no value"),
        ("mps", "Model status\nInfeasible\n", "has no line with a variable"),
        ("mps", "x1 0.5\n", "x1: 0.5 is neither 0 nor 1"),
        ("mps", "x1 one\n", "x1: 'one' is not a number"),
        ("mps", "x1 nan\n", "x1: nan is neither 0 nor 1"),
        ("mps", "x1 1\n", "is not a solution of the model"),
        ("dzn", "joined 1 0\n", "has no solution that ends with a line of ten"),
        ("dzn", "segments 1\njoined 99 0\n----------\n", "joined 99: color 0 does not continue"),
        ("dzn", "segments 1\n----------\n", "objective: says 1, its division has 7 segments"),
        ("lp", "UNSATISFIABLE\n", "has no line 'Answer: n'"),
        ("lp", f"Answer: 1\nlink({DART},{DART})\n", "is not from a dart to a later one"),
        ("lp", "Answer: 1\nlink(1,77)\n", "link 1 77: is not between live darts"),
    ],
)
def test_what_is_no_answer_is_a_line(
    kind: str, text: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, given, target = (tmp_path / name for name in ("i.json", "answer.txt", "out.json"))
    file.write_text(TWO.to_json())
    given.write_text(text)
    assert run("answer", file, given, "--format", kind, "-o", target) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "answer.txt" in line and message in line
    assert not target.exists()


def test_crossing_sub_cells_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Petals red, blue, red, blue around a hub: both pairs joined through it, as nobody can."""
    instance = Instance.from_document(
        {
            "format": "cellcolor/instance",
            "version": 2,
            "name": "cross",
            "colors": ["red", "blue"],
            "cells": [
                {"id": 0, "colors": [0, 1], "loops": [[1, 2, 3, 4]]},
                *({"id": n, "colors": [(n + 1) % 2], "loops": [[-n]]} for n in (1, 2, 3, 4)),
            ],
            "edges": [{"id": n, "left": 0, "right": n} for n in (1, 2, 3, 4)],
        }
    )
    file, given = tmp_path / "cross.json", tmp_path / "answer.txt"
    file.write_text(instance.to_json())
    joined = " ".join(f"joined({n},{(n + 1) % 2})" for n in (1, 2, 3, 4))
    given.write_text(f"Answer: 1\n{joined} link(1,3) link(2,4)\n")
    assert run("answer", file, given, "--format", "lp", "-o", tmp_path / "out.json") == 2
    assert "is not a legal division: " in capsys.readouterr().err
