"""How far joints are apart: modulo full circles where they turn, as they are where they slide.

The planner has a space of joints for that (:mod:`cellcolor.frontend.arm.joint_space`). The judge
keeps these lines to itself on purpose: with the planner's it would not find the planner's faults.
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Mask


def joint_steps(slides: Mask, first: Array, second: Array) -> Array:
    """How far each joint (..., joints) has to move, rad or m, from 0 on."""
    way = second - first
    around = np.remainder(way + np.pi, 2 * np.pi) - np.pi
    return np.abs(np.where(slides, way, around))
