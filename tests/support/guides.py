"""A wheel of the repository, as it is uploaded.

Other packages that register something, as an installer leaves them on a path.

Guides followed to the letter: their files written, their commands run.

Following a guide that adds to the front end: its files, an installation, and a run.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

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


def install(folder: Path, name: str, group: str, entries: dict[str, str], **modules: str) -> None:
    """Put a distribution with entry points and the text of its modules into a folder."""
    info = folder / f"{name}-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n", encoding="utf-8"
    )
    lines = [f"[{group}]", *(f"{entry} = {value}" for entry, value in entries.items())]
    (info / "entry_points.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    for module, text in modules.items():
        (folder / f"{module}.py").write_text(text, encoding="utf-8")


ROOT = Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"([^\n]*)\n\n```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Block:
    """One block of code, and the line that introduces it."""

    introduced: str
    language: str
    text: str


def section(guide: str, heading: str = "") -> str:
    """A guide in docs/how-to, or its section under a heading of the second level."""
    page = (ROOT / "docs" / "how-to" / f"{guide}.md").read_text(encoding="utf-8")
    return page.split(f"\n## {heading}\n")[1].partition("\n## ")[0] if heading else page


def blocks(guide: str, heading: str = "") -> list[Block]:
    """The blocks of code of a guide or of a section, in their order."""
    return [Block(*found) for found in BLOCK.findall(section(guide, heading))]


def follow(block: Block, folder: Path) -> None:
    """Write the file that a block is, or put its line where its introduction says."""
    if whole := re.fullmatch(r"`(\S+)`:", block.introduced):
        path = folder / whole[1]
        path.parent.mkdir(exist_ok=True)
        path.write_text(block.text, encoding="utf-8")
    elif inside := re.fullmatch(r"In `(\w+)` of `(\S+)`:", block.introduced):
        path = folder / inside[2]
        text = path.read_text(encoding="utf-8")
        start = re.search(rf"^{inside[1]}\b.*\{{\n", text, re.MULTILINE)
        assert start is not None, f"no {inside[1]} in {inside[2]}"
        changed = text[: start.end()] + block.text + text[start.end() :]
        path.write_text(changed, encoding="utf-8")
    elif top := re.fullmatch(r"At the top of `(\S+)`:", block.introduced):
        path = folder / top[1]
        text = path.read_text(encoding="utf-8")
        first = text.index("\nfrom cellcolor") + 1
        path.write_text(text[:first] + block.text + text[first:], encoding="utf-8")
    else:
        raise AssertionError(f"nobody knows what to do with: {block.introduced}")


def run(command: list[str], folder: Path, path: Path) -> subprocess.CompletedProcess[str]:
    """Run a command in a folder, with another one on Python's path."""
    if command[0] == "cellcolor":
        command = [sys.executable, "-m", *command]
    return subprocess.run(
        command,
        cwd=folder,
        env=os.environ | {"PYTHONPATH": f"{path}{os.pathsep}{ROOT}"},
        capture_output=True,
        encoding="utf-8",
        check=False,
    )


@contextmanager
def followed(
    guide: str, heading: str, folder: Path, *, run: bool = True
) -> Iterator[dict[str, Any]]:
    """Do what a section of a guide in docs/how-to says, in an empty folder beside ``models``.

    A block that a file's name introduces is written to that file; entry points of
    ``pyproject.toml`` are found afterwards as if the distribution had been installed; what is left
    of the Python is run, unless only the files are wanted.

    Yields:
        the names that the run left behind.
    """
    (folder / "models").symlink_to(ROOT / "models")
    code = ""
    for block in blocks(guide, heading):
        if block.introduced.startswith("`"):
            follow(block, folder)
        elif block.language == "python":
            code += block.text
    _install(folder)
    with _in(folder):
        names: dict[str, Any] = {}
        try:
            if run:
                exec(compile(code, f"{guide}.md", "exec"), names)
            yield names
        finally:
            for file in folder.glob("*.py"):
                sys.modules.pop(file.stem, None)


def _install(folder: Path) -> None:
    """What an installation leaves of a project: its metadata."""
    groups = tomllib.loads((folder / "pyproject.toml").read_text())["project"]["entry-points"]
    metadata = folder / "toy-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: toy\nVersion: 1.0\n")
    lines = []
    for group, points in groups.items():
        lines += [f"[{group}]", *(f"{name} = {value}" for name, value in points.items())]
    (metadata / "entry_points.txt").write_text("\n".join(lines) + "\n")


@contextmanager
def _in(folder: Path) -> Iterator[None]:
    """Working directory and module path."""
    before = Path.cwd()
    os.chdir(folder)
    sys.path.insert(0, str(folder))
    try:
        yield
    finally:
        sys.path.remove(str(folder))
        os.chdir(before)
