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


def worst(codes: Iterable[Exit]) -> Exit:
    """The exit code for several files: bad input wins over a contradiction, that over a limit."""
    found = set(codes)
    return next((c for c in (Exit.BAD_INPUT, Exit.INVALID, Exit.STOPPED) if c in found), Exit.DONE)
