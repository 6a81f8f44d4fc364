"""What is measured says with which commit, if there is one."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import cellcolor
from cellcolor.version import __version__

PRINT = "from cellcolor.machine import this_version; print(this_version())"


def version_of(clone: Path) -> str:
    """What a process says that runs the package of a folder."""
    command = [sys.executable, "-c", PRINT]
    return subprocess.run(
        command, cwd=clone, capture_output=True, check=True, encoding="utf-8"
    ).stdout.strip()


def git(clone: Path, *arguments: str) -> str:
    identity = ["-c", "user.name=nobody", "-c", "user.email=nobody@example.org"]
    command = ["git", "-C", str(clone), *identity, *arguments]
    return subprocess.run(command, capture_output=True, check=True, encoding="utf-8").stdout.strip()


@pytest.mark.skipif(shutil.which("git") is None, reason="git is not installed")
def test_the_commit_of_a_clone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only where the package itself is tracked: not where it is installed inside a clone."""
    monkeypatch.delenv("PYTHONPATH", raising=False)
    own = Path(cellcolor.__file__).parent
    package = shutil.copytree(own, tmp_path / "cellcolor", ignore=shutil.ignore_patterns("shipped"))
    git(tmp_path, "init", "-q")
    assert version_of(tmp_path) == __version__
    git(tmp_path, "add", "cellcolor")
    git(tmp_path, "commit", "-q", "-m", "all")
    commit = git(tmp_path, "rev-parse", "HEAD")[:7]
    assert version_of(tmp_path) == f"{__version__}+g{commit}"
    (package / "version.py").write_text('__version__ = "9.9.9"\n', encoding="utf-8")
    assert version_of(tmp_path) == f"9.9.9+g{commit}.dirty"
