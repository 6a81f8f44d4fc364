"""Programs and functions in processes of their own, which can be ended at any moment.

:class:`Child` reads what a program prints until a deadline. :func:`watch` runs a command, and
:func:`run_alone` a function, within limits of time and memory.

Limits hold whatever the work does: the process is looked at from outside, and what takes too long
or too much memory is killed with its children. If the watching process is killed itself, a shell
beside the work notices that its standard input has ended, and ends the work.

No library does this: pebble's pools kill a worker, not its children, and have no limit of memory;
psutil finds the children of a process and not what its dead children have left behind, which is in
the session. With psutil some ten lines would go and a dependency come.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread
from typing import IO, Any, Literal

from cellcolor.deadline import Deadline
from cellcolor.errors import CellcolorError
from cellcolor.machine import Machine, this_machine

_LOOKED_AFTER = 0.1
"""Seconds between two looks at the deadline. Python handles a signal, such as Ctrl-C, only then."""


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
                process_group=0 if os.name == "posix" else None,
            )
        except OSError as error:
            self._errors.close()
            raise CellcolorError(f"{self._name}: {error.strerror}") from error
        self._lines: SimpleQueue[str | None] = SimpleQueue()
        self._reader = Thread(target=self._read, daemon=True)
        self._reader.start()

    def __enter__(self) -> Child:
        return self

    def __exit__(self, *_: object) -> None:
        if self._process.poll() is None:
            self._kill()
        self._process.wait()
        self._reader.join()
        self._errors.close()

    def lines(self, deadline: Deadline) -> Iterator[str]:
        """What it prints, line by line, until it ends or the deadline comes."""
        while not deadline.over:
            try:
                line = self._lines.get(timeout=min(_LOOKED_AFTER, deadline.left))
            except Empty:
                continue
            if line is None:
                return
            yield line.rstrip("\r\n")

    @property
    def failure(self) -> str | None:
        """Its last complaint if it has ended with an exit code other than 0."""
        if self._process.poll() in (None, 0):
            return None
        said = _last_line(self._errors) or f"exit code {self._process.returncode}"
        return f"{self._name}: {said}"

    def _read(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as output:
            for line in output:
                self._lines.put(line)
        self._process.wait()
        self._lines.put(None)

    def _kill(self) -> None:
        try:
            if os.name == "posix":
                os.killpg(self._process.pid, signal.SIGKILL)
            else:
                self._process.kill()
        except ProcessLookupError:
            pass  # it has just ended by itself


End = Literal["done", "failed", "timeout", "memory", "crashed", "stopped"]
"""How a piece of work ended: it came back; it raised an error; it was killed for its time or for
its memory; it broke down or somebody else killed it; the watcher was told to stop."""

_GUARD = 'exec 3<&0; (read -r _; kill -9 0) <&3 & exec "$@" 3<&- </dev/null'
"""Shell: end the whole process group when standard input ends, and become the command."""

_SHELLS = 10
"""Files with smaller numbers are the shell's own, and those that were put in their place."""

_SHORTEST, _LONGEST = 0.002, 0.05
"""Seconds between two looks at a process, which grow from one to the other."""

_ALL_AFTER = 0.25
"""Seconds between two looks for the children of a process, which means to look at every process."""

_SHOWN = 300
"""Characters of an error that are kept."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What a process may take, its children included.

    Attributes:
        seconds: by the clock, from its start.
        megabytes: of memory at a time (2**20 bytes, resident); held on Linux only.
    """

    seconds: float
    megabytes: float = 4096.0


@dataclass(frozen=True, slots=True)
class Ended:
    """What came of a piece of work.

    Attributes:
        end: how it ended.
        value: what it returned, None unless it came back.
        error: a line about what went wrong, empty if nothing did.
        seconds: from the start of the process to its end.
        cpu_seconds: of all processors, of the process and the children that it waited for.
        peak_mb: the most memory at a time (2**20 bytes, resident); of what lives shorter than a few
            milliseconds it may see less.
        load: the machine's load average over the last minute, at the end.
        machine: where it ran.
    """

    end: End
    value: Any = None
    error: str = ""
    seconds: float = 0.0
    cpu_seconds: float = 0.0
    peak_mb: float = 0.0
    load: float = 0.0
    machine: Machine = field(default_factory=this_machine)


def run_alone(
    function: Callable[..., Any],
    arguments: Sequence[Any],
    limits: Limits,
    stop: Callable[[], bool] = lambda: False,
) -> Ended:
    """Call a function in a new process.

    Args:
        function: of a module that the new process can import.
        arguments: what can be pickled.
        limits: what is beyond them is killed.
        stop: asked again and again; the work is killed once it says so.
    """
    from fcntl import F_DUPFD_CLOEXEC, fcntl  # which Windows does not have

    with tempfile.TemporaryFile() as task, tempfile.TemporaryFile() as result:
        pickle.dump((function, tuple(arguments)), task)
        task.seek(0)
        handles = [fcntl(file, F_DUPFD_CLOEXEC, _SHELLS) for file in (task, result)]
        start = "import sys; sys.path[:] = sys.argv[3:]\n"
        start += "from cellcolor.processes import main; main()"
        command = [sys.executable, "-c", start, *map(str, handles), *sys.path]
        try:
            ended = watch(command, limits, stop, handles)
        finally:
            for handle in handles:
                os.close(handle)
        if ended.end != "done":
            return ended
        result.seek(0)
        return _with_result(ended, result)


def _with_result(ended: Ended, result: IO[bytes]) -> Ended:
    """What the process wrote down before it ended."""
    try:
        end, content, peak_mb = pickle.load(result)
    except Exception as error:
        return replace(ended, end="crashed", error=_line(f"left no result: {error}"))
    peak_mb = max(ended.peak_mb, peak_mb)
    if end == "done":
        return replace(ended, value=content, peak_mb=peak_mb)
    return replace(ended, end=end, error=_line(content), peak_mb=peak_mb)


def watch(
    command: Sequence[str],
    limits: Limits,
    stop: Callable[[], bool] = lambda: False,
    handles: Sequence[int] = (),
) -> Ended:
    """Run a command in a session of its own until it ends or has to be killed.

    Args:
        command: what to run; it gets an empty standard input, and nobody sees what it prints.
        limits: what is beyond them is killed.
        stop: asked again and again; the command is killed once it says so.
        handles: files of this process that it can use, none of them below 10.
    """
    with tempfile.TemporaryFile() as errors:
        started = time.monotonic()
        process = subprocess.Popen(
            ["/bin/sh", "-c", _GUARD, "sh", *command],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=errors,
            pass_fds=handles,
            start_new_session=True,
        )
        end: End | None = None
        memory = _Memory(process.pid)
        pause = _SHORTEST
        try:
            while not (found := os.wait4(process.pid, os.WNOHANG))[0]:
                if stop():
                    end = "stopped"
                elif memory.look() > limits.megabytes:
                    end = "memory"
                elif time.monotonic() - started > limits.seconds:
                    end = "timeout"
                if end is not None:
                    _kill(process.pid)
                    found = os.wait4(process.pid, 0)
                    break
                time.sleep(pause)
                pause = min(1.5 * pause, _LONGEST)
        finally:
            _kill(process.pid)  # its children, and the shell that waits beside it
            assert process.stdin is not None
            process.stdin.close()
        _, status, usage = found
        process.returncode = os.waitstatus_to_exitcode(status)
        error = _complaint(end, process.returncode, limits, _last_line(errors))
        return Ended(
            end or ("done" if process.returncode == 0 else "crashed"),
            error=error,
            seconds=time.monotonic() - started,
            cpu_seconds=usage.ru_utime + usage.ru_stime,
            peak_mb=memory.peak,
            load=os.getloadavg()[0],
        )


def _complaint(end: End | None, code: int, limits: Limits, said: str) -> str:
    """Why a process did not come back, in a line."""
    if end == "timeout":
        return f"killed after {limits.seconds:.0f} s"
    if end == "memory":
        return f"killed at more than {limits.megabytes:.0f} MB"
    if code == 0:
        return ""
    if code < 0:
        name = signal.Signals(-code).name
        return _line(f"ended by {name}" + (f": {said}" if said else ""))
    return _line(said or f"exit code {code}")


def _last_line(errors: IO[bytes]) -> str:
    """The last line of a process's error output; empty if there is none."""
    errors.seek(0)
    return errors.read().decode(errors="replace").strip().rpartition("\n")[2]


def _line(text: object) -> str:
    """A text in one line that is not too long for a table."""
    line = " ".join(str(text).split())
    return line if len(line) <= _SHOWN else f"{line[:_SHOWN]} …"


class _Memory:
    """The memory of a session, looked at from outside.

    Attributes:
        peak: the most that was seen, megabytes.
    """

    def __init__(self, session: int) -> None:
        self.peak = 0.0
        self._session = session
        self._members = [session]
        self._looked = time.monotonic()

    def look(self) -> float:
        """What all of its processes have now, megabytes; 0 where that cannot be known."""
        if time.monotonic() - self._looked > _ALL_AFTER:
            self._members = _members(self._session)
            self._looked = time.monotonic()
        now = sum(map(_megabytes, self._members))
        self.peak = max(self.peak, now)
        return now


def _megabytes(pid: int) -> float:
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except (OSError, IndexError):  # it has just ended, or the system has no such file
        return 0.0
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def _members(session: int) -> list[int]:
    """The processes of a session."""
    found = []
    for place in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if os.getsid(int(place.name)) == session:
                found.append(int(place.name))
    return found


def _kill(session: int) -> None:
    """End every process of a session, also those that made a process group of their own."""
    with suppress(ProcessLookupError):
        os.killpg(session, signal.SIGKILL)
    for pid in _members(session):
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


def main() -> None:
    """What the process of :func:`run_alone` does: read the task, and write what came of it.

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
