"""Ctrl-C and SIGTERM while a solver works: the end of its time, not of the program."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from cellcolor.cli.interrupts import INTERRUPTS, handled_by
from cellcolor.deadline import OutOfTime


class Interrupted(OutOfTime, KeyboardInterrupt):
    """A signal that a solver takes for the time limit; it hands over the best it has."""


@contextmanager
def end_the_search() -> Iterator[None]:
    """Turn signals into :class:`Interrupted` for a while."""

    def handle(_number: int, _frame: FrameType | None) -> None:
        INTERRUPTS.seen = True
        raise Interrupted("interrupted")

    with handled_by(handle):
        yield
