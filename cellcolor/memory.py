"""Long arrays are worked on in parts of one size, whose temporaries stay near the processor.

What cannot be done in parts is estimated, and refused before it is begun.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from cellcolor.errors import TooLarge

CHUNK = 2_500
"""Configurations that a step works on at a time; its temporaries take some ten megabytes then."""


def chunks(count: int, each: int = 1) -> Iterator[slice]:
    """Parts of a list of ``count`` things with ``each`` configurations, or what is as large."""
    most = max(1, CHUNK // max(1, each))
    return (slice(first, min(first + most, count)) for first in range(0, count, most))


def batches(sizes: NDArray[np.int64]) -> Iterator[slice]:
    """Parts of a list of groups (k,) of things, with as many things as are worked on at a time.

    A group that is larger is a part of its own.
    """
    total, first = np.cumsum(sizes), 0
    while first < len(total):
        before = int(total[first - 1]) if first else 0
        last = max(first + 1, int(np.searchsorted(total, before + CHUNK, side="right")))
        yield slice(first, last)
        first = last


def check_memory(needed: int, what: str) -> None:
    """Refuse what needs more memory than the machine has; ``what`` begins the sentence.

    Raises:
        TooLarge: names both numbers.
    """
    there = machine_memory()
    if there and needed > there:
        raise TooLarge(
            f"{what} would take {needed / 1e9:,.1f} GB, the machine has {there / 1e9:,.1f} GB"
        )


def machine_memory() -> int:
    """Of the whole machine, in bytes; 0 if that is not known."""
    with suppress(OSError, ValueError, AttributeError):
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return 0
