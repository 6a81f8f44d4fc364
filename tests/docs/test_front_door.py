"""What README and reference say about the front door holds."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import cellcolor

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "docs"))

from front_door import front_door  # noqa: E402

README = (ROOT / "README.md").read_text(encoding="utf-8")
ORACLE, FIRST = re.findall(r"^```python\n(.*?)^```", README, re.MULTILINE | re.DOTALL)


def run(script: str, folder: Path) -> str:
    """What a script prints that is run in a folder."""
    done = subprocess.run(
        [sys.executable, "-c", script],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("example", [ORACLE, FIRST], ids=["oracle", "first"])
def test_an_example_has_one_import(example: str) -> None:
    assert re.findall(r"^(?:import|from) .*", example, re.MULTILINE) == ["import cellcolor"]


@pytest.mark.second
def test_the_first_example_runs_anywhere(tmp_path: Path) -> None:
    printed = run(FIRST, tmp_path)
    (promised,) = re.findall(r"print\(result\)  # (.*)…", FIRST)
    assert printed.startswith(promised)
    assert [file.name for file in tmp_path.iterdir()] == ["wok.html"]


@pytest.mark.second
def test_the_oracle_example_runs(tmp_path: Path) -> None:
    planner = """
def my_planner(surface):
    return [next((c for c in (1, 0) if c in own), None) for own in surface.vertex_colors]

test_my_planner()
"""
    assert "half_pipe" in ORACLE
    run(ORACLE.replace("half_pipe", "ring") + planner, tmp_path)


def test_the_reference_has_every_public_name() -> None:
    """In the list that the site is built with, each with a sentence; all but two numbers."""
    listed = dict(re.findall(r"^- \{py:\w+\}`cellcolor\.(\w+) <.*>`: (\S.*)$", front_door(), re.M))
    assert set(listed) == set(cellcolor.__all__) - {"OUTSIDE", "__version__"}
