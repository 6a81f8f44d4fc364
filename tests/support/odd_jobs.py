"""Work for processes of their own: most of it does not come back.

Workers that do everything in this process, where a test can change what they use.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

_CHILD = "import os, sys, time; open(sys.argv[1], 'a').write(f'{os.getpid()}\\n'); time.sleep(600)"


def double(number: int) -> int:
    return 2 * number


def fail(message: str) -> None:
    raise ValueError(message)


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def take(megabytes: int) -> int:
    """Have so much memory for a moment."""
    return len(bytearray(b"x" * 2**20) * megabytes)


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


def kill_the_worker_once(mark: str) -> str:
    """The first time, end the process that watches this one; the next time, come back."""
    if not Path(mark).exists():
        Path(mark).touch()
        os.kill(os.getppid(), signal.SIGKILL)
        time.sleep(600)
    return "came back"


def kill_the_worker_once_before(
    mark: str, function: Callable[..., Any], arguments: tuple[Any, ...]
) -> Any:
    """The first time, end the process that watches this one; the next time, do the work."""
    kill_the_worker_once(mark)
    return function(*arguments)


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
