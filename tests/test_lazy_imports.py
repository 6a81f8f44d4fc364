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
@pytest.mark.parametrize("name", ["ring.json", "ring.surface.json"])
def test_solving_and_checking_need_no_kinematics(name: str, solver: str, tmp_path: Path) -> None:
    """Nor pictures; nor networkx, which takes a tenth of a second and more, for a graph."""
    file, solution = str(PAPER / name), str(tmp_path / "solution.json")
    for arguments in (
        ["solve", file, "--solver", solver, "-o", solution],
        ["check", file, solution],
    ):
        code, modules = run(*arguments)
        assert code == 0
        assert not modules & (FRONTEND | {"matplotlib"})
        assert name != "ring.json" or "networkx" not in modules


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
