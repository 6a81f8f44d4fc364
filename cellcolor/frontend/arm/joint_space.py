"""The joints of an arm as a space: what a step is, and what is the same position again.

A joint that turns is back in the same position after a full circle, a prismatic one never is.
Limits say which of these positions the arm has: an interval, or all of them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.configurations.matching import CIRCLE, ROUNDING, shorter_way


@dataclass(frozen=True)
class JointSpace:
    """Joints that turn, in rad, and prismatic ones, in m.

    Attributes:
        slides: (joints,) which joints are prismatic.
        lower, upper: (joints,) limits; infinite where there are none.
        reach: of the arm, m: a slide over it counts as 1 rad.
    """

    slides: Mask
    lower: Array
    upper: Array
    reach: float

    @property
    def units(self) -> Array:
        """(joints,) how far each moves for 1 rad, where bounds are the same for all joints."""
        return np.where(self.slides, self.reach, 1.0)

    @property
    def period(self) -> Array:
        """(joints,) after how much a joint is in the same position again; 0 for a slide."""
        return np.where(self.slides, 0.0, CIRCLE)

    @property
    def limits(self) -> tuple[Array, Array]:
        """Both limits (joints,)."""
        return self.lower, self.upper

    def step(self, first: Array, second: Array) -> Array:
        """The shortest way (..., joints) from one configuration to another one."""
        return shorter_way(first, second, np.where(self.slides, np.inf, CIRCLE))

    def unwrap(self, path: Array) -> Array:
        """The same positions (k, joints), each the nearest to the one before it."""
        return np.where(self.slides, path, np.unwrap(path, axis=0))

    def periods(self, way: Array) -> Array:
        """The whole numbers of periods (..., joints) that are nearest to a way; 0 for a slide."""
        return np.where(self.slides, 0.0, np.rint(way / CIRCLE))

    def largest(self, way: Array) -> Array:
        """The largest movement of a joint (...,) on a way (..., joints), in its units."""
        return np.asarray((np.abs(way) / self.units).max(axis=-1))

    def turns(self, path: Array) -> tuple[Index, ...]:
        """By how many periods each joint can be turned so that all of a path is in its limits.

        Args:
            path: (k, joints), unwound.

        Returns:
            For each joint all such numbers, ascending, and none if the path does not fit. A joint
            without limits has the number that brings its middle next to zero. A prismatic one
            has 0 if it fits as it is.
        """
        lowest, highest = path.min(axis=0), path.max(axis=0)
        choices = []
        for joint, (least, most) in enumerate(zip(lowest, highest, strict=True)):
            low, high = self.lower[joint] - ROUNDING, self.upper[joint] + ROUNDING
            if self.slides[joint]:
                choices.append(np.arange(int(low <= least and most <= high)))
                continue
            middle = -np.rint((least + most) / 2 / CIRCLE)
            first = np.ceil((low - least) / CIRCLE) if np.isfinite(low) else middle
            last = np.floor((high - most) / CIRCLE) if np.isfinite(high) else middle
            choices.append(np.arange(int(first), int(last) + 1))
        return tuple(choices)

    def fits(self, path: Array) -> bool:
        """Whether all joints of a path (k, joints) can be turned into their limits."""
        return all(len(choice) for choice in self.turns(path))
