"""The machine that something was measured on."""

from __future__ import annotations

import os
import platform
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from cellcolor.version import __version__

__all__ = ["Machine", "this_machine"]


@dataclass(frozen=True, slots=True)
class Machine:
    """What a measurement depends on.

    Attributes:
        cores: that this process may use.
        memory_mb: of the whole machine, 2**20 bytes; 0 if that is not known.
        cpu: what the processor calls itself.
        python: its version.
        cellcolor: its version.
    """

    cores: int
    memory_mb: int
    cpu: str
    python: str
    cellcolor: str


@cache
def this_machine() -> Machine:
    """The one that this process runs on."""
    available = getattr(os, "sched_getaffinity", None)
    cores = (os.cpu_count() or 1) if available is None else len(available(0))
    memory = 0
    with suppress(OSError, ValueError):
        memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2**20
    return Machine(cores, memory, _cpu(), platform.python_version(), __version__)


def _cpu() -> str:
    with suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return " ".join(line.partition(":")[2].split())
    return platform.processor() or platform.machine()
