"""Corners of a motion, between which every joint moves in proportion to time."""

from __future__ import annotations

from operator import le

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.trajectory_checker.tolerances import ANGLE_ROUNDING


def corners(times: Array, joints: Array) -> Index:
    """The samples (c,) between which all joints move in proportion to time, up to rounding.

    A sample is left out if the line from the last corner to some later sample passes it, and all
    that lie between, within a rounding of angles: many samples of a slow bend keep some of them.
    """
    kept = [0]
    # For rows of a few numbers, plain floats are many times faster than arrays.
    at, rows = times.tolist(), joints.tolist()
    low, high = [-np.inf] * joints.shape[1], [np.inf] * joints.shape[1]
    for k, row in enumerate(rows[1:], 1):
        begin = kept[-1]
        passed = at[k] - at[begin]
        slopes = [(there - here) / passed for here, there in zip(rows[begin], row, strict=True)]
        fits = all(map(le, low, slopes)) and all(map(le, slopes, high))
        if k > begin + 1 and not fits:
            kept.append(k - 1)
            passed = at[k] - at[k - 1]
            slopes = [(there - here) / passed for here, there in zip(rows[k - 1], row, strict=True)]
            low, high = [-np.inf] * len(row), [np.inf] * len(row)
        rounding = ANGLE_ROUNDING / passed
        low = [max(least, slope - rounding) for least, slope in zip(low, slopes, strict=True)]
        high = [min(most, slope + rounding) for most, slope in zip(high, slopes, strict=True)]
    kept.append(len(at) - 1)
    return np.array(kept)
