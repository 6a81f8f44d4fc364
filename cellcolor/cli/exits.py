"""What the exit codes mean (docs/formats.md)."""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntEnum


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


class Ended(Exception):
    """A command that cannot go on, though nothing is wrong with its input.

    Attributes:
        code: of the command.
    """

    def __init__(self, message: str, code: Exit = Exit.STOPPED) -> None:
        super().__init__(message)
        self.code = code


def worst(codes: Iterable[Exit]) -> Exit:
    """The exit code for several files: bad input wins over a contradiction, that over a limit."""
    found = set(codes)
    return next((c for c in (Exit.BAD_INPUT, Exit.INVALID, Exit.STOPPED) if c in found), Exit.DONE)
