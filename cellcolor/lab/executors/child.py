"""What happens in a process of its own: a function is read, called, and its result written."""

from __future__ import annotations

import os
import pickle
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any


def main() -> None:
    """Read a function and its arguments from one file and write what came of it to another one.

    The numbers of both files are the first two arguments of the command.
    """
    with os.fdopen(int(sys.argv[1]), "rb") as task:
        outcome = _outcome(task.read())
    with os.fdopen(int(sys.argv[2]), "wb") as result:
        result.write(outcome)


def _outcome(task: bytes) -> bytes:
    """How the call ended, what it returned or complained of, and the most memory, pickled."""
    end, content = "failed", ""
    try:
        function, arguments = pickle.loads(task)
        value: Any = function(*arguments)
        return pickle.dumps(("done", value, _peak_mb()))
    except MemoryError:
        end, content = "memory", "out of memory"
    except Exception as error:
        content = f"{type(error).__name__}: {error}"
    return pickle.dumps((end, content, _peak_mb()))


def _peak_mb() -> float:
    """The most memory that this process has had, megabytes; 0 where that cannot be known."""
    with suppress(OSError):
        for line in Path("/proc/self/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) / 1024
    return 0.0
