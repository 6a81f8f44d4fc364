"""Ctrl-C and SIGTERM: the end of the command, and while a solver works the end of its time."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from cellcolor.deadline import OutOfTime

_SIGNALS = (signal.SIGINT, signal.SIGTERM)
_Handler = Callable[[int, FrameType | None], Any]


class Interrupted(OutOfTime, KeyboardInterrupt):
    """A signal that a solver takes for the time limit; it hands over the best it has."""


class Interrupts:
    """Whether this process was told to end.

    Attributes:
        seen: it was; what is left to do should be left alone.
    """

    def __init__(self) -> None:
        self.seen = False

    @contextmanager
    def end_the_command(self) -> Iterator[None]:
        """Turn signals into ``KeyboardInterrupt``, and forget those of earlier commands."""

        def handle(_number: int, _frame: FrameType | None) -> None:
            self.seen = True
            raise KeyboardInterrupt

        self.seen = False
        # Where nothing can be raised (a finalizer), Python reports what was: not worth a line.
        report = sys.unraisablehook

        def quiet(fault: Any) -> None:
            if not isinstance(fault.exc_value, KeyboardInterrupt):
                report(fault)

        sys.unraisablehook = quiet
        try:
            with _handled_by(handle):
                yield
        finally:
            sys.unraisablehook = report

    @contextmanager
    def end_the_search(self) -> Iterator[None]:
        """Turn signals into :class:`Interrupted` for a while."""

        def handle(_number: int, _frame: FrameType | None) -> None:
            self.seen = True
            raise Interrupted("interrupted")

        with _handled_by(handle):
            yield

    def handle_with(self, handler: _Handler) -> None:
        """Replace the signals' handlers for good."""
        if threading.current_thread() is threading.main_thread():
            for number in _SIGNALS:
                signal.signal(number, handler)

    def check(self) -> None:
        """Raise what a library has swallowed: some catch everything, when imported above all.

        Raises:
            KeyboardInterrupt: a signal has come.
        """
        if self.seen:
            raise KeyboardInterrupt


INTERRUPTS = Interrupts()
"""Those of this process: signals come to no smaller part of it."""


@contextmanager
def _handled_by(handler: _Handler) -> Iterator[None]:
    """Replace the signals' handlers; only the main thread can, and only there they run."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {}
    try:
        for number in _SIGNALS:
            before[number] = signal.signal(number, handler)
        yield
    finally:
        for number, former in before.items():
            signal.signal(number, signal.SIG_DFL if former is None else former)
