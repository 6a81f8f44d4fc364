"""Long work in many independent parts, done by one process per core.

Python runs one thread at a time, and fcl's binding does not release it. So the process is forked:
children see the inputs without a copy, and write their results into arrays in shared memory
(:func:`shared`). The parent does whatever a child does not finish, including errors and timeouts,
so the result does not depend on the number of processes.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from mmap import mmap
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

_MOST = 16  # processes
_working = False  # in a child, and while a process does its own share


def shared(shape: tuple[int, ...], kind: DTypeLike) -> NDArray[Any]:
    """An array of zeros that forked processes have in common."""
    kind = np.dtype(kind)
    size = int(np.prod(shape)) * kind.itemsize
    return np.frombuffer(mmap(-1, max(size, 1)), kind, int(np.prod(shape))).reshape(shape)


def share_out(work: Callable[[int], None], parts: int, at_least: int = 1) -> int:
    """Do ``work(k)`` for every k below ``parts``; it writes into :func:`shared` arrays.

    There are several processes only on Linux: elsewhere libraries do not survive a fork. Work
    that is itself part of such work is not shared out again.

    Args:
        at_least: the number of parts that is worth a process.

    Returns:
        How many processes there were.

    Raises:
        Exception: what the first part raises that cannot be done.
    """
    global _working
    count = 1 if _working else max(min(_cores(), parts // at_least, _MOST), 1)
    if count == 1:
        for part in range(parts):
            work(part)
        return count
    done = shared((parts,), np.bool_)
    _working = True
    children: list[multiprocessing.process.BaseProcess] = []
    try:
        with suppress(OSError):  # no room for another process: what it would do is done here
            for first in range(1, count):
                child = _forked(work, range(first, parts, count), done)
                children.append(child)  # if the next one fails this one stands
        _do(work, range(0, parts, count), done)
        for child in children:
            child.join()
        _do(work, np.flatnonzero(~done).tolist(), done)
    finally:
        _working = False
        for child in children:
            child.kill()
            child.join()
    return 1 + len(children)


def _cores() -> int:
    """How many processes there can be at a time."""
    if sys.platform != "linux" or multiprocessing.current_process().daemon:
        return 1  # a daemon must not have children
    return len(os.sched_getaffinity(0))


def _do(work: Callable[[int], None], parts: range | list[int], done: NDArray[np.bool_]) -> None:
    for part in parts:
        work(part)
        done[part] = True


def _forked(
    work: Callable[[int], None], parts: range, done: NDArray[np.bool_]
) -> multiprocessing.process.BaseProcess:
    """A child that does some parts."""
    context, parent = multiprocessing.get_context("fork"), os.getpid()

    def in_child() -> None:
        # A terminal's Ctrl-C reaches the child as well; it is the parent who ends it.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        for part in parts:
            if os.getppid() != parent:
                break
            try:
                work(part)
            except Exception:  # the parent meets it too, and tells
                break
            done[part] = True
        os._exit(0)  # nothing of the parent's is to be ended or written a second time

    child = context.Process(target=in_child, daemon=True)
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        with warnings.catch_warnings():
            # Python warns of forking beside threads: numpy's have no locks that the work needs.
            warnings.simplefilter("ignore", DeprecationWarning)
            child.start()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    return child
