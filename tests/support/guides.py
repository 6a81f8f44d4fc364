"""Guides followed to the letter: their files written, their commands run."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"([^\n]*)\n\n```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Block:
    """One block of code, and the line that introduces it."""

    introduced: str
    language: str
    text: str


def blocks(guide: str) -> list[Block]:
    """The blocks of code of a guide in docs/how-to, in their order."""
    page = (ROOT / "docs" / "how-to" / f"{guide}.md").read_text(encoding="utf-8")
    return [Block(*found) for found in BLOCK.findall(page)]


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
