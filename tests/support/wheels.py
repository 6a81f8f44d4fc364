"""A wheel of the repository, as it is uploaded."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

import cellcolor

TOP = Path(__file__).parents[2]


def build_wheel(folder: Path) -> Path:
    """Build one into an empty folder; hatchling is needed."""
    command = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation"]
    subprocess.run([*command, "-q", "-w", str(folder), str(TOP)], check=True)
    (wheel,) = folder.iterdir()
    project = tomllib.loads((TOP / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert wheel.name.startswith(f"{project['name'].replace('-', '_')}-{cellcolor.__version__}-")
    return wheel
