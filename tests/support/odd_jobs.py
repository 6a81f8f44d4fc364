"""Work for processes of their own: most of it does not come back."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

_CHILD = "import os, sys, time; open(sys.argv[1], 'a').write(f'{os.getpid()}\\n'); time.sleep(600)"


def double(number: int) -> int:
    return 2 * number


def fail(message: str) -> None:
    raise ValueError(message)


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def swell() -> None:
    """Take more and more memory, 50 MB at a time."""
    taken = []
    while True:
        taken.append(bytearray(b"x" * 50_000_000))
        time.sleep(0.01)


def hang(pids: str, apart: bool = False) -> None:
    """Note this process and a child of its own in a file, and never end.

    Args:
        pids: the file.
        apart: whether the child makes a process group of its own.
    """
    group = 0 if apart else None
    with subprocess.Popen([sys.executable, "-c", _CHILD, pids], process_group=group):
        note(pids)
        time.sleep(600)


def note(pids: str) -> None:
    with Path(pids).open("a") as file:
        file.write(f"{os.getpid()}\n")


def leave_behind(pids: str) -> None:
    """Note a child of its own in a file, and come back without it."""
    child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
    Path(pids).write_text(str(child.pid))


def running(pids: Path) -> list[int]:
    """Those of the noted processes that have not ended."""
    found = []
    for pid in map(int, pids.read_text().split()):
        try:
            state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            continue
        if state != "Z":
            found.append(pid)
    return found


def wait_until_noted(pids: Path, count: int) -> None:
    """Wait until so many processes have noted themselves."""
    _wait(lambda: pids.exists() and len(pids.read_text().splitlines()) >= count)


def wait_until_ended(pids: Path) -> None:
    """Wait until none of the noted processes is running."""
    _wait(lambda: not running(pids))


def _wait(until: Callable[[], bool]) -> None:
    given_up = time.monotonic() + 60
    while not until():
        assert time.monotonic() < given_up
        time.sleep(0.01)
