"""Ctrl-C while a solver works: the end of its time, not of the program."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from cellcolor.deadline import OutOfTime


class Interrupted(OutOfTime, KeyboardInterrupt):
    """Ctrl-C; a solver takes it for the time limit and hands over the best it has."""


class Interrupts:
    """Whether Ctrl-C came while a solver worked.

    Attributes:
        seen: it did; what is left to solve should be left alone.
    """

    def __init__(self) -> None:
        self.seen = False

    @contextmanager
    def end_the_search(self) -> Iterator[None]:
        """Turn Ctrl-C into :class:`Interrupted` for a while."""

        def handle(_number: int, _frame: FrameType | None) -> None:
            self.seen = True
            raise Interrupted("interrupted")

        before = signal.signal(signal.SIGINT, handle)
        try:
            yield
        finally:
            signal.signal(signal.SIGINT, before)
