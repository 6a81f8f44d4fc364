"""The wheel without extras in a fresh environment: enough to test another planner with."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
import venv
from pathlib import Path

import pytest
from guides import TOP, build_wheel

pytestmark = pytest.mark.slow

FIRST_COLORS = "[colors[0] if colors else None for colors in surface.vertex_colors]"


class Environment:
    """A virtual environment with the wheel, its dependencies and pytest, and an empty folder."""

    def __init__(self, place: Path) -> None:
        self.folder = place / "empty"
        self._programs = place / "env" / ("Scripts" if sys.platform == "win32" else "bin")

    def run(self, program: str, *arguments: str) -> tuple[int, str, str]:
        """Exit code, standard output and standard error of a program of the environment."""
        kept = {name: text for name, text in os.environ.items() if not name.startswith("PYTHON")}
        command = [str(self._programs / program), *arguments]
        done = subprocess.run(
            command,
            cwd=self.folder,
            env=kept,
            capture_output=True,
            text=True,
            check=False,
        )
        return done.returncode, done.stdout, done.stderr

    def python(self, script: str) -> str:
        """What a script prints; it has to succeed."""
        code, out, err = self.run("python", "-c", script)
        assert code == 0, err
        return out


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> Environment:
    pytest.importorskip("hatchling")
    place = tmp_path_factory.mktemp("base")
    (place / "empty").mkdir()
    wheel = build_wheel(place / "wheels")
    venv.create(place / "env", with_pip=True)
    environment = Environment(place)
    project = tomllib.loads((TOP / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    pip = ("-m", "pip", "-q", "--disable-pip-version-check")
    wanted = [*project["dependencies"], "pytest"]
    code, _, err = environment.run("python", *pip, "install", *wanted)
    if code:
        pytest.skip(f"no package index: {err.strip().splitlines()[-1]}")
    code, _, err = environment.run("python", *pip, "install", "--no-deps", str(wheel))
    assert code == 0, err
    code, out, _ = environment.run("python", *pip, "check")
    assert code == 0, out
    return environment


def test_there_are_no_extras(base: Environment) -> None:
    found = base.python(
        "from importlib.util import find_spec as find\n"
        "import cellcolor\n"
        "extras = 'pinocchio fcl igl trimesh matplotlib clingo pychoco'\n"
        "extras += ' hypothesis'\n"
        "print(cellcolor.__file__, [name for name in extras.split() if find(name)])\n"
    )
    assert found.endswith("[]\n")
    assert str(base.folder.parent) in found


def test_the_plugin(base: Environment) -> None:
    (base.folder / "test_planner.py").write_text(
        "def test_first_colors(cellcolor_oracle):\n"
        "    part = cellcolor_oracle('half_pipe.surface.json')\n"
        "    surface = part.surface\n"
        f"    part.assert_optimal({FIRST_COLORS})\n"
        "def test_better(cellcolor_oracle):\n"
        "    part = cellcolor_oracle('half_pipe.surface.json')\n"
        "    surface = part.surface\n"
        f"    verdict = part.judge({FIRST_COLORS})\n"
        "    part.assert_optimal(verdict.improvement.better.on_mesh)\n",
        encoding="utf-8",
    )
    code, out, _ = base.run("python", "-m", "pytest", "-q", "test_planner.py")
    assert code == 1 and "1 failed, 1 passed" in out, out
    assert re.search(r"\d fewer (is|are) proved to be enough; segments \d+ and \d+", out), out
    assert " picture: " in out and " better: " in out  # which need no extra
