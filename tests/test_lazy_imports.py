"""What a command does not need it does not import."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from library import PAPER

pytestmark = pytest.mark.second

FRONTEND = {"cellcolor.frontend", "pinocchio", "trimesh", "fcl", "coal", "igl"}
HEAVY = FRONTEND | {"ortools", "networkx", "numpy", "pydantic"}

RUN = """
import json, sys
from cellcolor.cli import main
code = main(sys.argv[1:])
print(json.dumps({"code": code, "modules": sorted(sys.modules)}), file=sys.stderr)
"""


def run(*arguments: str) -> tuple[int, set[str]]:
    """The exit code and the modules imported by one command in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", RUN, *arguments], capture_output=True, text=True, check=True
    )
    report = json.loads(done.stderr.splitlines()[-1])
    return report["code"], set(report["modules"])


@pytest.mark.parametrize("solver", ["cp-sat", "dfs"])
def test_solving_an_instance_needs_no_kinematics(solver: str) -> None:
    code, modules = run("solve", str(PAPER / "ring.json"), "--solver", solver)
    assert code == 0
    assert not modules & FRONTEND


def test_building_and_solving_a_surface_needs_no_kinematics() -> None:
    code, modules = run("solve", str(PAPER / "ring.surface.json"))
    assert code == 0
    assert "cellcolor.decomposition" in modules
    assert not modules & FRONTEND


def test_solving_and_checking_an_instance_import_no_networkx(tmp_path: Path) -> None:
    # It takes a tenth of a second and more, at every start.
    ring, solution = str(PAPER / "ring.json"), str(tmp_path / "ring.solution.json")
    for arguments in (["solve", ring, "-o", solution], ["check", ring, solution]):
        code, modules = run(*arguments)
        assert code == 0
        assert "networkx" not in modules


@pytest.mark.parametrize(
    "arguments",
    [
        ["--help"],
        ["--version"],
        ["solve", "--help"],
        ["bench", "--help"],
        ["bench", "run", "--help"],
    ],
    ids=" ".join,
)
def test_help_imports_nothing_heavy(arguments: list[str]) -> None:
    code, modules = run(*arguments)
    assert code == 0
    assert not modules & HEAVY


@pytest.mark.parametrize(
    "arguments",
    [
        ["solve", "no-such-file.json"],
        ["solve", "x.json", "--strands", "3"],
        ["build", "no-such-file.json", "-o", "x.json"],
        ["check", "no-such-file.json", "no-such-file.json"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_bad_input_imports_no_solver(arguments: list[str]) -> None:
    code, modules = run(*arguments)
    assert code == 2
    assert not modules & (FRONTEND | {"ortools"})
