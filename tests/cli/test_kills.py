"""Commands killed at random moments and at chosen ones: each file whole, all or none, no traces.

At random, each command gets SIGINT, SIGTERM and SIGKILL in turn, at moments drawn evenly from the
time that it takes when left alone. Before each start the files that it is about to write are there
in an older version. Afterwards every file has to be whole, old or new.
"""

from __future__ import annotations

import io
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
import zipfile
from contextlib import chdir, redirect_stderr
from dataclasses import dataclass
from pathlib import Path

import pytest
from commands import run
from library import INSTANCES, PAPER

pytestmark = pytest.mark.second

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)

SLOW = """
import sys, time
from pathlib import Path
rename = Path.replace
def slowly(path, target):
    time.sleep(0.2)
    return rename(path, target)
Path.replace = slowly
from cellcolor.cli import main
sys.exit(main())
"""
"""Renaming that takes long enough to be hit."""

AT_RENAME = """
import os, signal, sys
from pathlib import Path
rename, left = Path.replace, [int(sys.argv.pop(1))]
def killed(path, target):
    if not left[0]:
        os.kill(os.getpid(), signal.SIGKILL)
    left[0] -= 1
    return rename(path, target)
Path.replace = killed
from cellcolor.cli import main
sys.exit(main())
"""


@dataclass(frozen=True)
class Command:
    """Arguments of ``cellcolor``, the files that they write, what runs instead of it."""

    arguments: tuple[str, ...]
    outputs: tuple[str, ...]
    script: tuple[str, ...] = ("-m", "cellcolor")

    def start(self, folder: Path) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [sys.executable, *self.script, *self.arguments],
            cwd=folder,
            env=os.environ | {"PYTHONPATH": str(INSTANCES.parent)},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )

    def contents(self, folder: Path) -> dict[str, bytes]:
        present = [name for name in self.outputs if (folder / name).exists()]
        return {name: (folder / name).read_bytes() for name in present}


OUTPUTS = ("w.reasons.npz", "w.surface.json", "w.json")
BUILD = Command(("build", "scene/wok.toml", "-o", "w.json"), OUTPUTS)
COMMANDS = {
    "build": BUILD,
    "build, slow renames": Command(BUILD.arguments, BUILD.outputs, script=("-c", SLOW)),
    "solve -o": Command(("solve", "hub.json", "-o", "s.json"), ("s.json",)),
    "solve --all -o": Command(("solve", "many.json", "--all", "-o", "s.jsonl"), ("s.jsonl",)),
    "show": Command(("show", "r.json", "-o", "p.html"), ("p.html",)),
    "check": Command(("check", "r.surface.json", "plan.json"), ()),
}


def prepare(folder: Path, command: Command) -> None:
    """Inputs, and outputs of an earlier run on other inputs."""
    text = (INSTANCES / "scenes/wok.toml").read_text(encoding="utf-8")
    text = text.replace("../../models", (INSTANCES.parent / "models").as_posix())
    scene, name = folder / "scene/wok.toml", command.arguments[0]
    scene.parent.mkdir(parents=True)
    shutil.copy(PAPER / "ring.surface.json", folder / "r.surface.json")
    shutil.copy(INSTANCES / "random/hub_44.json", folder / "hub.json")
    shutil.copy(PAPER / "figeasycell4.json", folder / "many.json")
    surface = json.loads((folder / "r.surface.json").read_text(encoding="utf-8"))
    colors = [own[0] if own else None for own in surface["vertex_colors"]]
    plan = {"format": "cellcolor/plan", "version": 1, "vertex_colors": colors}
    (folder / "plan.json").write_text(json.dumps(plan), encoding="utf-8")
    earlier = {
        "build": command.arguments,
        "solve": ("solve", "r.json", *command.arguments[2:]),
        "show": ("show", "r.surface.json", "--color", "0", *command.arguments[2:]),
        "check": command.arguments,
    }
    scene.write_text(re.sub(r"target_vertices = \d+", "target_vertices = 60", text))
    with chdir(folder):
        assert run("build", "r.surface.json", "-o", "r.json") == run(*earlier[name]) == 0
    scene.write_text(re.sub(r"target_vertices = \d+", "target_vertices = 200", text))


def whole(name: str, content: bytes) -> bool:
    """Whether a file is one that reads from its beginning to its end."""
    match Path(name).suffix:
        case ".npz":
            return zipfile.ZipFile(io.BytesIO(content)).testzip() is None
        case ".jsonl":
            first, *rest = [json.loads(line) for line in content.splitlines()]
            return len(rest) == int(first["schemes"])
        case ".html":
            return content.endswith(b"</html>")
        case _:
            return bool(json.loads(content))


def strays(folder: Path) -> list[str]:
    return [str(path.relative_to(folder)) for path in folder.rglob(".*")]


def assert_no_mixture_is_shown(folder: Path) -> None:
    show = ("show", "w.json", "--view", "reasons", "-o", "reason.svg")
    with chdir(folder), redirect_stderr(io.StringIO()) as errors:
        assert run(*show) == 2
    assert "surface" in errors.getvalue() and not (folder / "reason.svg").exists()


def kill_once(command: Command, number: signal.Signals, delay: float, folder: Path) -> None:
    """Kill a command in a prepared folder and look at what it leaves."""
    old, process = command.contents(folder), command.start(folder)
    time.sleep(delay)
    process.send_signal(number)
    lines = process.communicate(timeout=120)[1].decode().splitlines()
    new = command.contents(folder)
    changed = {output for output in command.outputs if new.get(output) != old.get(output)}
    assert all(whole(output, new[output]) for output in changed if output in new)
    if number != signal.SIGKILL:
        if process.returncode in (-signal.SIGINT, -signal.SIGTERM):  # Python itself was starting
            assert not changed
        elif process.returncode:
            assert process.returncode == 3, lines
            assert len(lines) < 2 and all("interrupted" in line for line in lines)
        assert strays(folder) == []
    if command.arguments[0] == "build" and 0 < len(changed) < len(command.outputs):
        assert number == signal.SIGKILL
        assert_no_mixture_is_shown(folder)
    if number == signal.SIGKILL:
        process = command.start(folder)
        process.communicate(timeout=300)
        after = command.contents(folder)
        assert process.returncode == 0
        assert all(after.get(output) != old.get(output) for output in command.outputs)


@pytest.mark.slow
@pytest.mark.parametrize("name", COMMANDS)
def test_at_a_hundred_random_moments(name: str, tmp_path: Path) -> None:
    command, chance = COMMANDS[name], random.Random(1)
    prepare(tmp_path / "model", command)
    alone = shutil.copytree(tmp_path / "model", tmp_path / "alone")
    begun, process = time.monotonic(), command.start(alone)
    process.communicate()
    seconds = time.monotonic() - begun
    assert process.returncode == 0
    for number in range(100):
        folder = shutil.copytree(tmp_path / "model", tmp_path / "run")
        kill_once(command, SIGNALS[number % 3], chance.uniform(0.0, seconds), folder)
        shutil.rmtree(folder)


@pytest.mark.slow
def test_between_two_renames(tmp_path: Path) -> None:
    """What can happen only then: files of two builds, which are not shown together."""
    prepare(tmp_path / "run", BUILD)
    folder = tmp_path / "run"
    old = BUILD.contents(folder)
    for done in range(3):
        process = Command(BUILD.arguments, (), ("-c", AT_RENAME, str(done))).start(folder)
        process.communicate()
        assert process.returncode == -signal.SIGKILL
        new = BUILD.contents(folder)
        # The renames done so far, the side file before the surface before the instance.
        assert {name for name in old if old[name] != new[name]} == set(BUILD.outputs[:done])
        assert len(strays(folder)) == 3 - done
        if done:
            assert_no_mixture_is_shown(folder)
    process = BUILD.start(folder)
    process.communicate()
    assert process.returncode == 0
    assert run("show", folder / "w.json", "--view", "reasons", "-o", folder / "x.svg") == 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_that_a_library_swallows(number: signal.Signals, tmp_path: Path) -> None:
    """Whoever catches everything (trimesh does, when imported) catches Ctrl-C as well."""
    script = (
        "import signal, sys\n"
        "import cellcolor.cli.inputs as inputs\n"
        "import cellcolor.door.subject\n"
        "try:\n    import cellcolor.frontend\nexcept ModuleNotFoundError:\n    sys.exit(3)\n"
        "import cellcolor.frontend as frontend\n"
        "build = frontend.build_surface\n"
        "def swallowed(*arguments):\n"
        "    try:\n"
        f"        signal.raise_signal({int(number)})\n"
        "    except BaseException:\n        pass\n"
        "    return build(*arguments)\n"
        "frontend.build_surface = swallowed\n"
        "from cellcolor.cli import main\nsys.exit(main())\n"
    )
    scene = INSTANCES / "scenes" / "wok.toml"
    command = [sys.executable, "-c", script, "build", str(scene), "-o", str(tmp_path / "w.json")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 3
    assert list(tmp_path.iterdir()) == []


def test_a_signal_at_the_very_end_changes_nothing() -> None:
    """The answer is out; how Python then takes itself down is nobody's business."""
    command = [sys.executable, "-m", "cellcolor", "solve", str(PAPER / "ring.json"), "--json"]
    for number in (signal.SIGINT, signal.SIGTERM):
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        assert process.stdout is not None
        assert process.stdout.readline()
        process.send_signal(number)
        _, errors = process.communicate()
        assert (process.returncode, errors) in ((0, b""), (3, b"cellcolor: interrupted\n"))
