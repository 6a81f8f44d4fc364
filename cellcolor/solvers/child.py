"""An external solver in its own process; its output is read until the deadline."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread

from cellcolor.deadline import Deadline
from cellcolor.errors import CellcolorError

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
                # Ctrl-C reaches it by way of us only. It stays in the session, by which who watches
                # this process finds and kills all that belongs to it.
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
        self._errors.seek(0)
        said = self._errors.read().decode(errors="replace").strip().splitlines()
        return f"{self._name}: {said[-1] if said else f'exit code {self._process.returncode}'}"

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
