"""Commands killed at random moments, and what they leave.

Each command gets SIGINT, SIGTERM and SIGKILL in turn, at moments drawn evenly from the time that it
takes when left alone. Before each start the files that it is about to write are there in an older
version. Afterwards every file has to be whole, old or new; after SIGINT and SIGTERM there is no
temporary file, and the exit code is 3 with one line (or what the command itself says, where it came
to its end before); after SIGKILL the same command is run to its end, which leaves all files new and
no temporary file.
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
import tempfile
import time
import zipfile
from collections.abc import Callable
from contextlib import chdir, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

from cellcolor.cli import main as main_of_cellcolor

ROOT = Path(__file__).resolve().parents[2]
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


@dataclass(frozen=True)
class Command:
    """A command to be killed.

    Attributes:
        arguments: of ``cellcolor``, in a folder with the files that :func:`prepare` makes.
        outputs: the files that it writes, and which belong together.
        script: what to run instead of ``cellcolor``, and its first arguments.
    """

    arguments: tuple[str, ...]
    outputs: tuple[str, ...]
    script: tuple[str, ...] = ("-m", "cellcolor")


BUILD = Command(
    ("build", "scene/wok.toml", "-o", "w.json"), ("w.reasons.npz", "w.surface.json", "w.json")
)
COMMANDS = {
    "build": BUILD,
    "build, slow renames": Command(BUILD.arguments, BUILD.outputs, script=("-c", SLOW)),
    "solve -o": Command(("solve", "hub.json", "-o", "s.json"), ("s.json",)),
    "solve --all -o": Command(("solve", "many.json", "--all", "-o", "s.jsonl"), ("s.jsonl",)),
    "show": Command(("show", "r.json", "-o", "p.html"), ("p.html",)),
    "check": Command(("check", "r.surface.json", "plan.json"), ()),
}


def environment() -> dict[str, str]:
    return os.environ | {"PYTHONPATH": str(ROOT)}


def cellcolor(folder: Path, *arguments: str) -> None:
    with chdir(folder), redirect_stdout(io.StringIO()):
        if main_of_cellcolor(arguments) != 0:
            raise RuntimeError(f"cellcolor {' '.join(arguments)} failed")


def prepare(folder: Path, command: Command) -> None:
    """Inputs, and outputs of an earlier run on other inputs."""
    paper = ROOT / "instances/paper"
    text = (ROOT / "instances/scenes/wok.toml").read_text(encoding="utf-8")
    text = text.replace("../../models", (ROOT / "models").as_posix())
    scene = folder / "scene/wok.toml"
    scene.parent.mkdir()
    shutil.copy(paper / "ring.surface.json", folder / "r.surface.json")
    cellcolor(folder, "build", "r.surface.json", "-o", "r.json")
    shutil.copy(ROOT / "instances/random/hub_44.json", folder / "hub.json")
    shutil.copy(paper / "figeasycell4.json", folder / "many.json")
    surface = json.loads((folder / "r.surface.json").read_text(encoding="utf-8"))
    colors = [own[0] if own else None for own in surface["vertex_colors"]]
    plan = {"format": "cellcolor/plan", "version": 1, "vertex_colors": colors}
    (folder / "plan.json").write_text(json.dumps(plan), encoding="utf-8")
    if command.arguments[0] == "build":
        scene.write_text(re.sub(r"target_vertices = \d+", "target_vertices = 60", text))
        cellcolor(folder, *command.arguments)
    scene.write_text(re.sub(r"target_vertices = \d+", "target_vertices = 200", text))
    if command.arguments[0] == "solve":
        cellcolor(folder, "solve", "r.json", *command.arguments[2:])
    if command.arguments[0] == "show":
        cellcolor(folder, "show", "r.surface.json", "--color", "0", *command.arguments[2:])


def start(folder: Path, command: Command) -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [sys.executable, *command.script, *command.arguments],
        cwd=folder,
        env=environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )


def whole(name: str, content: bytes) -> bool:
    """Whether a file is one that reads from its beginning to its end."""
    try:
        match Path(name).suffix:
            case ".npz":
                return zipfile.ZipFile(io.BytesIO(content)).testzip() is None
            case ".jsonl":
                first, *rest = [json.loads(line) for line in content.splitlines()]
                return len(rest) == first["schemes"]
            case ".html":
                return content.endswith(b"</html>")
            case _:
                return bool(json.loads(content))
    except (ValueError, zipfile.BadZipFile):
        return False


def strays(folder: Path) -> list[str]:
    return [str(path.relative_to(folder)) for path in folder.rglob(".*")]


def contents(folder: Path, command: Command) -> dict[str, bytes]:
    present = [name for name in command.outputs if (folder / name).exists()]
    return {name: (folder / name).read_bytes() for name in present}


Say = Callable[[str], None]


def kill_once(
    command: Command, number: signal.Signals, delay: float, model: Path, fault: Say
) -> None:
    """Kill a command once, in a copy of a prepared folder."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "run"
        shutil.copytree(model, folder)
        old = contents(folder, command)
        process = start(folder, command)
        time.sleep(delay)
        process.send_signal(number)
        _, errors = process.communicate(timeout=120)
        code, lines = process.returncode, errors.decode().splitlines()
        new = contents(folder, command)
        changed = {output for output in command.outputs if new.get(output) != old.get(output)}
        if number != signal.SIGKILL:
            ending(code, lines, changed, fault)
            if strays(folder):
                fault(f"strays {strays(folder)}")
        for output, content in new.items():
            if content != old.get(output) and not whole(output, content):
                fault(f"{output} is not whole")
        if command.arguments[0] == "build" and changed:
            together(folder, command, changed, number, fault)
        if number == signal.SIGKILL:
            process = start(folder, command)
            process.communicate(timeout=300)
            if process.returncode != 0:
                fault(f"exit code {process.returncode} of the run after a kill")
            if strays(folder):
                fault(f"strays {strays(folder)} after the run that followed a kill")
            after = contents(folder, command)
            if any(after.get(output) == old.get(output) for output in command.outputs):
                fault("old files after the run that followed a kill")


def ending(code: int, lines: list[str], changed: set[str], fault: Say) -> None:
    """Look at what SIGINT or SIGTERM made of a command."""
    if code == 0:
        return
    if code in (-signal.SIGINT, -signal.SIGTERM):  # Python itself was starting
        if changed:
            fault(f"exit code {code} after files were written")
        return
    if code != 3:
        fault(f"exit code {code}: {lines[-1:]}")
    if len(lines) > 1 or (lines and "interrupted" not in lines[0]):
        fault(f"exit code {code} with {lines}")


def together(
    folder: Path, command: Command, changed: set[str], number: signal.Signals, fault: Say
) -> None:
    """Look at the files of a build, some of which are new: a mixture of two builds is refused."""
    if len(changed) == len(command.outputs):
        return
    if number != signal.SIGKILL:
        fault(f"of the files of a build only {sorted(changed)} are new")
    show = ["show", "w.json", "--reason", "-o", "reason.svg"]
    with chdir(folder), redirect_stderr(io.StringIO()) as errors:
        code = main_of_cellcolor(show)
    if code != 2 or "surface" not in errors.getvalue() or (folder / "reason.svg").exists():
        fault(f"a mixture is shown: {code} {errors.getvalue()}")


def trial(command: Command, count: int, seed: int, fault: Say) -> None:
    """Kill a command ``count`` times."""
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory() as name:
        model = Path(name) / "model"
        model.mkdir()
        prepare(model, command)
        alone = Path(name) / "alone"
        shutil.copytree(model, alone)
        begun = time.monotonic()
        process = start(alone, command)
        process.communicate()
        seconds = time.monotonic() - begun
        if process.returncode != 0:
            fault(f"exit code {process.returncode} when left alone")
        for run in range(count):
            number = SIGNALS[run % len(SIGNALS)]
            delay = chance.uniform(0.0, seconds)

            def named(text: str, number: signal.Signals = number, delay: float = delay) -> None:
                fault(f"{number.name} after {delay:.3f} s: {text}")

            kill_once(command, number, delay, model, named)
