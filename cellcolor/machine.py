"""The machine and the version that something was measured with."""

from __future__ import annotations

import os
import platform
import subprocess
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from cellcolor.memory import machine_memory
from cellcolor.version import __version__


@dataclass(frozen=True, slots=True)
class Machine:
    """The machine and versions behind a measurement.

    Attributes:
        cores: how many this process may use.
        memory_mb: of the whole machine, in units of 2**20 bytes; 0 if unknown.
        cpu: the processor's own name.
        python: its version.
        cellcolor: its version, as :func:`this_version` tells it.
    """

    cores: int
    memory_mb: int
    cpu: str
    python: str
    cellcolor: str


@cache
def this_machine() -> Machine:
    """The machine that this process runs on."""
    available = getattr(os, "sched_getaffinity", None)
    cores = (os.cpu_count() or 1) if available is None else len(available(0))
    return Machine(
        cores, machine_memory() // 2**20, _cpu(), platform.python_version(), this_version()
    )


@cache
def this_version() -> str:
    """The package's version, and the commit if it is run from a clone: ``0.1.0+g382b955``.

    It ends in ``.dirty`` if a file was changed after the commit. The form is a local version
    identifier (PEP 440).
    """
    package = Path(__file__).parent
    tracked = _git(package, "ls-files", "version.py")
    if not tracked:
        return __version__
    commit = _git(package, "rev-parse", "--short=7", "HEAD")
    changed = _git(package, "status", "--porcelain", "--untracked-files=no", ".")
    return f"{__version__}+g{commit}{'.dirty' if changed else ''}"


def _git(folder: Path, *arguments: str) -> str:
    """What git prints in a folder; empty without git or outside a repository."""
    command = ["git", "-C", str(folder), *arguments]
    try:
        ended = subprocess.run(command, capture_output=True, check=True, timeout=10)
    except (OSError, subprocess.SubprocessError):
        return ""
    return ended.stdout.decode().strip()


def _cpu() -> str:
    with suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return " ".join(line.partition(":")[2].split())
    return platform.processor() or platform.machine()
