"""How much memory a step may take: long arrays are worked on in parts of a size in bytes.

Who works on many things says what one of them takes, as an upper bound that the tests hold against
what numpy really holds. What cannot be done in parts is estimated, and refused before it is begun.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from cellcolor.errors import TooLarge

MEMORY = 16_000_000
"""Bytes that the temporaries of one step may take at a time, in each process: so few that they stay
near the processor. Steps that call others have theirs beside those of the others."""


def at_once(bytes_each: int) -> int:
    """How many things of a size fit into ``MEMORY``; one at least."""
    return max(1, MEMORY // max(1, bytes_each))


def chunks(count: int, bytes_each: int) -> Iterator[slice]:
    """Parts of a list of ``count`` things, each of which fits into ``MEMORY``."""
    most = at_once(bytes_each)
    return (slice(first, min(first + most, count)) for first in range(0, count, most))


def batches(sizes: NDArray[np.int64], bytes_each: int) -> Iterator[slice]:
    """Parts of a list of groups (k,) of things: the things of a part fit into ``MEMORY``.

    A group that is larger is a part of its own.
    """
    total, first, most = np.cumsum(sizes), 0, at_once(bytes_each)
    while first < len(total):
        before = int(total[first - 1]) if first else 0
        last = max(first + 1, int(np.searchsorted(total, before + most, side="right")))
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
