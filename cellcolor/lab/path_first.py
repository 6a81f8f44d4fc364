"""What planners pay that choose the path first and the branches of the arm along it.

The path is a raster (:mod:`cellcolor.lab.raster`). Two counts of lift-offs are made along it. The
optimistic one takes going from one sample to the next in the same branch for continuous, and
passing what is out of reach for free; no planner that follows this path pays less. The other one
holds every step to what an arm can do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.lab.raster import Raster

_FULL = 2 * np.pi


@dataclass(frozen=True)
class Stroke:
    """A stretch of a path in one branch without a lift-off.

    Attributes:
        first, after: its first sample, and the one after its last.
        branch: the branch's number.
        joints: (after - first, joints) in rad, unwound, inside the limits.
    """

    first: int
    after: int
    branch: int
    joints: Array


def fewest_lift_offs(valid: Mask) -> int:
    """The fewest changes of branch along a path.

    Staying in a branch for as long as any lasts is best: whoever changes earlier is not further on
    at the next change.

    Args:
        valid: (n, branches) which branches reach each point of the path, one at least.
    """
    lift_offs = 0
    left = valid[0]
    for here in valid:
        left = left & here
        if not left.any():
            lift_offs += 1
            left = here
    return lift_offs


def fewest_strokes(
    path: Raster, configurations: Array, valid: Mask, lower: Array, upper: Array, jump: float
) -> list[Stroke]:
    """The fewest strokes along a path that an arm can follow.

    In a stroke the branch is valid at every sample, no joint moves by more than ``jump`` from one
    sample to the next, and the angles, unwound, fit into the limits with some start. What holds
    for a stroke holds for each part of it, so staying as long as any branch lasts is best
    here too. Samples that no branch reaches are passed over in the air.

    Args:
        path: its samples, n of them.
        configurations: (n, branches, joints) in rad, modulo full circles; NaN without a solution.
        valid: (n, branches).
        lower, upper: (joints,) limits, rad.
        jump: rad.
    """
    found: list[Stroke] = []
    begins = np.zeros(len(valid), dtype=bool)
    begins[path.starts] = True
    sample = 0
    while sample < len(valid):
        if not valid[sample].any():
            sample += 1
            continue
        after, branch = _longest(sample, begins, configurations, valid, lower, upper, jump)
        joints = np.unwrap(configurations[sample:after, branch], axis=0)
        turns = np.ceil((lower - joints.min(axis=0)) / _FULL)
        found.append(Stroke(sample, after, branch, joints + _FULL * turns))
        sample = after
    return found


def _longest(
    first: int,
    begins: Mask,
    configurations: Array,
    valid: Mask,
    lower: Array,
    upper: Array,
    jump: float,
) -> tuple[int, int]:
    """The sample after the longest stroke from one on, and its branch."""
    alive = valid[first]
    here = np.nan_to_num(configurations[first])
    least, most = here.copy(), here.copy()
    after = first + 1
    while after < len(valid) and not begins[after]:
        step = configurations[after] - configurations[after - 1]
        step = np.nan_to_num(step - _FULL * np.round(step / _FULL), nan=np.inf)
        still = alive & valid[after] & (np.abs(step) <= jump).all(axis=1)
        here = here + np.where(still[:, None], step, 0.0)
        least, most = np.minimum(least, here), np.maximum(most, here)
        turned = _FULL * np.ceil((lower - least) / _FULL)
        still &= (most + turned <= upper).all(axis=1)
        if not still.any():
            break
        alive = still
        after += 1
    return after, int(np.flatnonzero(alive)[0])
