"""Temporary files: none stays after a signal, and those of killed processes are tidied up."""

from __future__ import annotations

import os
import re
import secrets
import signal
import stat
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from cellcolor.signals import handled_by

if sys.platform != "win32":
    import fcntl

_TEMPORARY = re.compile(r"\.cellcolor-[0-9a-f]{16}\.tmp")


def remove_strays(folder: Path) -> None:
    """Remove the temporary files that killed processes have left in a folder."""
    try:
        strays = [path for path in folder.iterdir() if _TEMPORARY.fullmatch(path.name)]
    except OSError:
        return
    for stray in strays:
        _remove_stray(stray)


class Temporary:
    """A file beside the place that it will take, locked as long as its process lives.

    The name is short, whatever the name it will have: names have a greatest length. The lock
    says that somebody is still writing; the system takes it away from a process that was killed.
    """

    def __init__(self, place: Path) -> None:
        self.place = place
        while True:
            self._path = place.with_name(f".cellcolor-{secrets.token_hex(8)}.tmp")
            # As private as the user's mask says, like any other new file.
            handle = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o666)
            self._stream = os.fdopen(handle, "wb")
            _lock(handle, wait=True)
            # Between its making and its locking somebody may have taken it for a stray.
            if os.fstat(handle).st_nlink:
                return
            self._stream.close()

    def fill(self, content: Iterable[bytes]) -> None:
        """Write all of the content."""
        self._stream.writelines(content)
        self._stream.flush()

    def rename(self) -> None:
        """Take the place."""
        self._path.replace(self.place)

    def discard(self) -> None:
        """Close the file, and remove it if it has not taken its place."""
        # What could not be written before cannot be written now; that has been said.
        with suppress(OSError):
            self._path.unlink(missing_ok=True)
        with suppress(OSError):
            self._stream.close()


def _lock(handle: int, wait: bool) -> bool:
    """Take a file's lock; False where somebody has it, or the system knows no locks."""
    if sys.platform == "win32":
        return False
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except OSError:
        return False
    return True


def _remove_stray(path: Path) -> None:
    try:
        handle = os.open(path, os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return
    with suppress(OSError):
        if stat.S_ISREG(os.fstat(handle).st_mode) and _lock(handle, wait=False):
            path.unlink(missing_ok=True)
    os.close(handle)


@contextmanager
def undisturbed() -> Iterator[None]:
    """Let signals wait until the end."""
    waiting: list[int] = []
    try:
        with handled_by(lambda number, _frame: waiting.append(number)):
            yield
    finally:
        if waiting:
            signal.raise_signal(waiting[0])
