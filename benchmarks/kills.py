"""Kill commands at random moments and look at what they leave: ``python benchmarks/kills.py [N]``.

Each command is started N times (100) and gets SIGINT, SIGTERM and SIGKILL in turn, at moments drawn
evenly from the time that it takes when left alone. Before each start the files that it is about to
write are there in an older version. Afterwards every file has to be whole, old or new; after SIGINT
and SIGTERM there is no temporary file, and the exit code is 3 with one line (or what the command
itself says, where it came to its end before); after SIGKILL the same command is run to its end,
which leaves all files new and no temporary file.

Prints a Markdown table, and ends with exit code 1 if anything was otherwise.
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
from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import chdir, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

from cellcolor.cli import main as main_of_cellcolor

ROOT = Path(__file__).resolve().parents[1]
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
) -> list[str]:
    """Kill a command once, in a copy of a prepared folder.

    Returns:
        What happened, for the table.
    """
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
        counted = []
        if number != signal.SIGKILL:
            counted.append(ending(code, lines, changed, fault))
            if strays(folder):
                fault(f"strays {strays(folder)}")
        elif strays(folder):
            counted.append("strays of a kill")
        for output, content in new.items():
            if content != old.get(output) and not whole(output, content):
                fault(f"{output} is not whole")
        if command.arguments[0] == "build" and changed:
            counted.append(together(folder, command, changed, number, fault))
        elif command.outputs:
            counted.append("new" if changed else "old")
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
        return counted


def ending(code: int, lines: list[str], changed: set[str], fault: Say) -> str:
    """What SIGINT or SIGTERM made of a command."""
    if code == 0:
        return "came to its end"
    if code in (-signal.SIGINT, -signal.SIGTERM):
        if changed:
            fault(f"exit code {code} after files were written")
        return "not yet begun"  # Python itself was starting
    if code != 3:
        fault(f"exit code {code}: {lines[-1:]}")
    if len(lines) > 1 or (lines and "interrupted" not in lines[0]):
        fault(f"exit code {code} with {lines}")
    return "exit code 3"


def together(
    folder: Path, command: Command, changed: set[str], number: signal.Signals, fault: Say
) -> str:
    """What became of the files of a build, some of which are new."""
    if len(changed) == len(command.outputs):
        return "new"
    if number != signal.SIGKILL:
        fault(f"of the files of a build only {sorted(changed)} are new")
    show = ["show", "w.json", "--reason", "-o", "reason.svg"]
    with chdir(folder), redirect_stderr(io.StringIO()) as errors:
        code = main_of_cellcolor(show)
    if code != 2 or "surface" not in errors.getvalue() or (folder / "reason.svg").exists():
        fault(f"a mixture is shown: {code} {errors.getvalue()}")
    return "mixed, refused"


def trial(
    command: Command, count: int, seed: int, fault: Say
) -> tuple[float, Mapping[str, Counter[str]]]:
    """Kill a command ``count`` times.

    Returns:
        How long it takes when left alone, and what happened how often after each signal.
    """
    chance = random.Random(seed)
    counts: dict[str, Counter[str]] = {number.name: Counter() for number in SIGNALS}
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

            counts[number.name]["runs"] += 1
            counts[number.name].update(kill_once(command, number, delay, model, named))
    return seconds, counts


COLUMNS = (
    "runs",
    "not yet begun",
    "exit code 3",
    "came to its end",
    "old",
    "new",
    "mixed, refused",
    "strays of a kill",
)


def main() -> int:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    faults: list[str] = []
    print(f"| command | seconds | signal | {' | '.join(COLUMNS)} | faults |")
    print("|" + "---|" * (len(COLUMNS) + 4))
    for name, command in COMMANDS.items():
        own: list[str] = []
        seconds, counts = trial(command, count, 1, own.append)
        for number, counted in counts.items():
            shown = " | ".join(str(counted[column]) for column in COLUMNS)
            wrong = sum(fault.startswith(number) for fault in own)
            print(f"| {name} | {seconds:.1f} | {number} | {shown} | {wrong} |", flush=True)
        faults += [f"{name}: {fault}" for fault in own]
    for fault in faults:
        print(fault)
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
