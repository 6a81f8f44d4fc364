"""Every file of examples/ runs as it stands, from any directory, and ends well."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from shipped import TOP

pytestmark = pytest.mark.second

FOLDER = TOP / "examples"
FILES = sorted(FOLDER.glob("*.py"))
LONG = ("plan_a_motion", "move_the_part")
RUNS = [
    pytest.param(file, id=file.stem, marks=[pytest.mark.slow] * (file.stem in LONG))
    for file in FILES
]


@pytest.mark.parametrize("file", RUNS)
def test_it_runs(file: Path, tmp_path: Path) -> None:
    pytest_runs_it = file.name.startswith("test_")
    command = [sys.executable, *(["-m", "pytest", "-q", "-p", "no:cacheprovider"] * pytest_runs_it)]
    environment = {**os.environ, "PYTHONPATH": str(TOP)}
    ended = subprocess.run(
        [*command, str(file)], cwd=tmp_path, env=environment, capture_output=True, text=True
    )
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert ended.stdout.strip()


def test_the_page_names_every_file() -> None:
    page = (FOLDER / "README.md").read_text()
    assert [file.name for file in FILES if f"]({file.name})" not in page] == []
