"""How a command ends: exit codes (docs/formats.md), Ctrl-C and SIGTERM.

Imported before everything else, and quickly: until the signals have their handlers they end in
Python's own way, with a traceback or none.
"""

from __future__ import annotations

import sys
from contextlib import contextmanager
from enum import IntEnum

from cellcolor.signals import handled_by

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from types import FrameType
    from typing import Any


class Exit(IntEnum):
    """The exit code of a command."""

    DONE = 0
    INVALID = 1
    BAD_INPUT = 2
    STOPPED = 3

    @classmethod
    def done_if(cls, proved: bool) -> Exit:
        """Done, or stopped before everything was proved."""
        return cls.DONE if proved else cls.STOPPED


def worst(codes: Iterable[Exit]) -> Exit:
    """The exit code for several files: bad input wins over a contradiction, that over a limit."""
    found = set(codes)
    return next((c for c in (Exit.BAD_INPUT, Exit.INVALID, Exit.STOPPED) if c in found), Exit.DONE)


class Stopped(KeyboardInterrupt):
    """A signal that ends the command.

    Not plain ``KeyboardInterrupt``: where that leaves code compiled from a string (``dataclasses``
    runs such code), CPython 3.11 remembers it as unhandled, and ends with exit code 130.
    """


class Interrupts:
    """Whether this process was told to end.

    Attributes:
        seen: it was; what is left to do should be left alone.
    """

    def __init__(self) -> None:
        self.seen = False

    @contextmanager
    def turned_into(self, kind: type[KeyboardInterrupt]) -> Iterator[None]:
        """Raise this where a signal comes."""

        def handle(_number: int, _frame: FrameType | None) -> None:
            self.seen = True
            raise kind

        with handled_by(handle):
            yield

    @contextmanager
    def end_the_command(self) -> Iterator[None]:
        """Turn signals into :class:`Stopped`, and forget those of earlier commands."""
        self.seen = False
        # Where nothing can be raised (a finalizer), Python reports what was: not worth a line.
        report = sys.unraisablehook

        def quiet(fault: Any) -> None:
            if not isinstance(fault.exc_value, KeyboardInterrupt):
                report(fault)

        sys.unraisablehook = quiet
        try:
            with self.turned_into(Stopped):
                yield
        finally:
            sys.unraisablehook = report

    def check(self) -> None:
        """Raise what a library has swallowed: some catch everything, when imported above all.

        Raises:
            Stopped: a signal has come.
        """
        if self.seen:
            raise Stopped


INTERRUPTS = Interrupts()
"""Those of this process: signals come to no smaller part of it."""
