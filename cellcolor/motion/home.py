"""The home position: whether the arm can stand there, what is in the way, what is near and free."""

from __future__ import annotations

from itertools import takewhile

import numpy as np

from cellcolor.arrays import Array
from cellcolor.errors import InputError, naming
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.setup import Motion
from cellcolor.motion.following import joint_space
from cellcolor.motion.free_space import FreeSpace

_TRIED = 256  # configurations at each distance
_FIRST = 0.1  # rad, or units of a slide
_FARTHER = 1.3  # the factor from one distance to the next
_ROOMS = (0.1, 0.03, 0.0)  # m, more than the clearance, that a position that is found keeps
_SHOWN = 3  # contacts
_DIGITS = 2  # of a proposed position, rad or m


def home_of(prepared: PreparedScene, motion: Motion) -> Array | None:
    """Where the arm begins and ends (joints,), rad or m; None if that does not matter.

    Raises:
        InputError: that position is not free, with the bodies that are in each other's way there
            and a free position near it; or ``free`` was asked for, and none was found.
    """
    if motion.home_rad is None:
        return None
    if motion.home is None:
        lower, upper = (np.clip(limit, -np.pi, np.pi) for limit in joint_space(prepared).limits)
        middle, near = np.round((lower + upper) / 2, _DIGITS), None
        for room in _ROOMS:
            near = free_near(FreeSpace(prepared, motion.clearance_m + room), middle)
            if near is not None:
                break
        if near is None:
            with naming(prepared.setup.file):
                raise InputError(None, "motion.home_rad", "no free position was found; give one")
        return np.array(near)
    home, free = np.array(motion.home), FreeSpace(prepared, motion.clearance_m)
    if free(home[None])[0]:
        return home
    how, found = "touch", FreeSpace(prepared, 0.0).touched(home)
    if not found:
        how, found = "are nearer than motion.clearance_m or a margin allows", free.touched(home)
    more = f" and {len(found) - _SHOWN} more" if len(found) > _SHOWN else ""
    shown = ", ".join(found[:_SHOWN]) + more
    near = free_near(free, home)
    proposed = (
        "; no free position was found near it"
        if near is None
        else f"; free is, for example, [{', '.join(f'{angle:g}' for angle in near)}]; "
        'home_rad = "free" finds one as well'
    )
    with naming(prepared.setup.file):
        message = f"the arm cannot stand there: {shown} {how}{proposed}"
        raise InputError(None, "motion.home_rad", message)


def free_near(free: FreeSpace, home: Array) -> list[float] | None:
    """A free configuration, the nearest of many drawn around home at growing distances."""
    drawn = np.random.default_rng(0).uniform(-1.0, 1.0, (_TRIED, len(home)))
    distances = (_FIRST * _FARTHER**step for step in range(100))
    for distance in takewhile(lambda far: far < np.pi, distances):
        tried = np.round(home + distance * free.space.units * drawn, _DIGITS)
        found = np.flatnonzero(free(tried))
        if len(found):
            nearest = np.argmin(free.space.largest(tried[found] - home))
            return [float(angle) for angle in tried[found[nearest]]]
    return None
