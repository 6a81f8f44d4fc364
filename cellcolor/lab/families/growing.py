"""Families whose instances grow with the seed, to see where solvers reach their limits."""

from __future__ import annotations

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError
from cellcolor.lab.families.blobs import blobs
from cellcolor.lab.families.hubs import hub, hub_grid

_COLORS = 4
_OF_A_SIZE = 3
"""Hubs with the same number of petals."""

_GRIDS = (
    (2, 2, 3),
    (3, 3, 2),
    (3, 3, 3),
    (4, 4, 2),
    (5, 5, 2),
    (4, 4, 3),
    (6, 6, 2),
    (5, 5, 3),
    (8, 8, 2),
    (10, 10, 2),
)
"""Rows, columns, and petals at each side of a hub, from 40 to 540 cells."""


def growing_blobs(seed: int) -> LabelledSurface:
    """Blobs of 2 to 10 colors with more and more waves: 3 cells at seed 0, 1120 at seed 39."""
    size = min(24 + 2 * seed, 110)
    return blobs(seed, size, 2 + min(seed // 4, 8), waves=0.4 + 0.1 * seed)


def growing_hub(seed: int) -> Instance:
    """A hub of 6 petals for seeds 0 to 2, of 9 petals for the next three, …"""
    return hub(seed, 6 + 3 * (seed // _OF_A_SIZE), _COLORS)


def growing_hub_grid(seed: int) -> Instance:
    """A grid of hubs of 40 to 540 cells.

    Raises:
        InputError: there are no more sizes.
    """
    if seed >= len(_GRIDS):
        raise InputError(None, None, f"grids of hubs have seeds 0 to {len(_GRIDS) - 1}")
    return hub_grid(0, *_GRIDS[seed][:2], _COLORS, _GRIDS[seed][2])
