"""Programs and functions in processes of their own, which can be ended at any moment.

:class:`Child` reads what a program prints until a deadline; :func:`run_alone` calls a function
within limits of time and memory, :func:`as_they_end` several, some at a time. Limits hold whatever
the work does: the process is looked at from outside, and killed with its children.

No library does this. The pools of concurrent.futures and pebble kill a worker, not its children,
and psutil does not find what dead children have left behind, which is in the session.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from textwrap import shorten
from threading import TIMEOUT_MAX, Event, Timer
from typing import IO, Any, Literal, TypeVar

from cellcolor.deadline import Deadline
from cellcolor.errors import CellcolorError

_Name = TypeVar("_Name")


class Child:
    """A program that runs once and, on exit from the context, is killed with all its children.

    Used as a context manager. The program cannot overrun the deadline: it is killed, not asked
    to end.
    """

    def __init__(self, command: Sequence[str | Path], folder: Path) -> None:
        """Start it.

        Args:
            command: the program and its arguments.
            folder: for its temporary files, also those that it would have removed had it not been
                killed, and for what it complains of. It works where this process does.

        Raises:
            CellcolorError: it cannot be started.
        """
        self._name = Path(command[0]).name
        self._killed = False
        self._errors = tempfile.TemporaryFile(dir=folder)  # noqa: SIM115, closed in __exit__
        try:
            self._process = subprocess.Popen(
                command,
                env=os.environ | {"TMPDIR": str(folder)},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=self._errors,
                encoding="utf-8",
                errors="replace",
                # Ctrl-C reaches it through this process only. It stays in the session: whoever
                # watches this process kills everything in its session.
                process_group=0,
            )
        except OSError as error:
            self._errors.close()
            raise CellcolorError(f"{self._name}: {error.strerror}") from error

    def __enter__(self) -> Child:
        return self

    def __exit__(self, *_: object) -> None:
        self._kill()
        self._process.communicate()
        self._errors.close()

    def lines(self, deadline: Deadline) -> Iterator[str]:
        """What it prints, line by line, until it ends or the deadline comes."""
        assert self._process.stdout is not None
        timer = Timer(min(deadline.left, TIMEOUT_MAX), self._kill)
        timer.daemon = True
        timer.start()
        try:
            for line in self._process.stdout:
                if deadline.over:
                    return
                yield line.rstrip("\r\n")
            self._process.wait()
        finally:
            timer.cancel()

    @property
    def failure(self) -> str | None:
        """Its last complaint if it has ended by itself, with an exit code other than 0."""
        if self._killed or self._process.poll() in (None, 0):
            return None
        said = _last_line(self._errors) or f"exit code {self._process.returncode}"
        return f"{self._name}: {said}"

    def _kill(self) -> None:
        if self._process.poll() is not None:
            return
        self._killed = True
        with suppress(ProcessLookupError):  # it has just ended by itself
            os.killpg(self._process.pid, signal.SIGKILL)


End = Literal["done", "failed", "timeout", "memory", "crashed", "stopped"]
"""How a piece of work ended: it came back; it raised an error; it was killed for its time or for
its memory; it broke down or somebody else killed it; the watcher was told to stop."""

_GUARD = 'exec 3<&0; (read -r _; kill -9 0) <&3 & exec "$@" 3<&- </dev/null'
"""Shell: become the command, and end all of its process group when standard input ends, which it
does if the watching process is killed."""

_START = "import sys; sys.path[:] = sys.argv[3:]\nfrom cellcolor.processes import main; main()"

_SHORTEST, _LONGEST = 0.002, 0.1
"""Seconds between two looks at a process, which grow from one to the other."""

_SHOWN = 300
"""Characters of an error that are kept."""

MOST_MB = 4096.0
"""What a piece of work may take, 2**20 bytes, unless something else is said."""


@dataclass(frozen=True, slots=True)
class Ended:
    """What came of a piece of work.

    Attributes:
        end: how it ended.
        value: what it returned, None unless it came back.
        error: a line about what went wrong, empty if nothing did.
        seconds: from the start of the process to its end.
        cpu_seconds: of all processors, of the process and the children that it waited for.
        peak_mb: the most memory at a time (2**20 bytes, resident); of children that live shorter
            than a tenth of a second it may see less.
    """

    end: End
    value: Any = None
    error: str = ""
    seconds: float = 0.0
    cpu_seconds: float = 0.0
    peak_mb: float = 0.0


def run_alone(
    function: Callable[..., Any],
    arguments: Sequence[Any],
    most_seconds: float,
    most_mb: float = MOST_MB,
    stop: Callable[[], bool] = lambda: False,
) -> Ended:
    """Call a function in a new process and session, and end all that is left there afterwards.

    Args:
        function: of a module that the new process can import; nobody sees what it prints.
        arguments: what can be pickled.
        most_seconds: by the clock, from its start; what takes more is killed.
        most_mb: of memory at a time (2**20 bytes, resident), its children included, likewise.
        stop: asked again and again; the work is killed once it says so.
    """
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile() as errors:
        task, result = Path(folder, "task"), Path(folder, "result")
        task.write_bytes(pickle.dumps((function, tuple(arguments))))
        command = [sys.executable, "-c", _START, str(task), str(result), *sys.path]
        started = time.monotonic()
        process = subprocess.Popen(
            ["/bin/sh", "-c", _GUARD, "sh", *command],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=errors,
            start_new_session=True,
        )
        assert process.stdin is not None
        end: End | None = None
        peak, pause, error = 0.0, _SHORTEST, ""
        try:
            while not (found := os.wait4(process.pid, os.WNOHANG))[0]:
                memory = sum(map(_megabytes, _members(process.pid)))
                peak = max(peak, memory)
                if stop():
                    end, error = "stopped", "stopped"
                elif memory > most_mb:
                    end, error = "memory", f"killed at more than {most_mb:.0f} MB"
                elif time.monotonic() - started > most_seconds:
                    end, error = "timeout", f"killed after {most_seconds:.0f} s"
                if end is not None:
                    _kill(process.pid)
                    found = os.wait4(process.pid, 0)
                    break
                time.sleep(pause)
                pause = min(1.5 * pause, _LONGEST)
        finally:
            _kill(process.pid)  # its children, and the shell that waits beside it
            process.stdin.close()
        _, status, usage = found
        process.returncode = os.waitstatus_to_exitcode(status)
        cost = time.monotonic() - started, usage.ru_utime + usage.ru_stime
        if end is None and process.returncode == 0:
            end, value, error, own = _result(result)
            return Ended(end, value, shorten(error, _SHOWN), *cost, max(peak, own))
        if end is None:
            error = _complaint(process.returncode, _last_line(errors))
        return Ended(end or "crashed", None, shorten(error, _SHOWN), *cost, peak)


@dataclass(frozen=True, slots=True)
class Task:
    """One piece of work; see :func:`run_alone`."""

    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    most_seconds: float
    most_mb: float = MOST_MB


def as_they_end(slots: int, tasks: Iterable[tuple[_Name, Task]]) -> Iterator[tuple[_Name, Ended]]:
    """What came of each task, by its name of any kind, in the order in which they end.

    A task is taken only when there is a process for it, so that making the next one, which may take
    a while, does not disturb the work where there is one. Whoever leaves the loop early, such as by
    Ctrl-C, ends the work.

    Args:
        slots: how many are done at a time.
    """
    left, stop = iter(tasks), Event()
    names: dict[Future[Ended], _Name] = {}
    watchers = ThreadPoolExecutor(slots)
    try:
        while True:
            for name, task in islice(left, slots - len(names)):
                work = task.function, task.arguments, task.most_seconds, task.most_mb
                names[watchers.submit(run_alone, *work, stop.is_set)] = name
            if not names:
                return
            for future in wait(names, return_when=FIRST_COMPLETED).done:
                yield names.pop(future), future.result()
    finally:
        stop.set()
        watchers.shutdown(cancel_futures=True)


def _result(file: Path) -> tuple[End, Any, str, float]:
    """What the process wrote down before it ended: how, its value, an error, and its most MB."""
    try:
        found: tuple[End, Any, str, float] = pickle.loads(file.read_bytes())
        return found
    except Exception as error:  # whatever was written is no pickle of ours
        return "crashed", None, f"left no result: {error}", 0.0


def _complaint(code: int, said: str) -> str:
    """Why a process did not come back."""
    if code < 0:
        return f"ended by {signal.Signals(-code).name}" + (f": {said}" if said else "")
    return said or f"exit code {code}"


def _last_line(errors: IO[bytes]) -> str:
    """The last line of a process's error output; empty if there is none."""
    errors.seek(0)
    return errors.read().decode(errors="replace").strip().rpartition("\n")[2]


def _megabytes(pid: int) -> float:
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except (OSError, IndexError):  # it has just ended, or the system has no such file
        return 0.0
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def _members(session: int) -> Iterator[int]:
    """The processes of a session."""
    for place in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if os.getsid(int(place.name)) == session:
                yield int(place.name)


def _kill(session: int) -> None:
    """End every process of a session, also those that made a process group of their own."""
    with suppress(ProcessLookupError):
        os.killpg(session, signal.SIGKILL)
    for pid in _members(session):
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


def main() -> None:
    """The process of :func:`run_alone`: read the task, and write what came of it.

    Both files are the first two arguments of the command.
    """
    task, result = map(Path, sys.argv[1:3])
    try:
        function, arguments = pickle.loads(task.read_bytes())
        value = function(*arguments)
        outcome = pickle.dumps(("done", value, "", _peak_mb()))
    except MemoryError:
        outcome = pickle.dumps(("memory", None, "out of memory", _peak_mb()))
    except Exception as error:
        text = f"{type(error).__name__}: {error}"
        outcome = pickle.dumps(("failed", None, text, _peak_mb()))
    result.write_bytes(outcome)


def _peak_mb() -> float:
    """The most memory that this process has had, megabytes; 0 where that cannot be known."""
    with suppress(OSError):
        for line in Path("/proc/self/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) / 1024
    return 0.0
