"""Which configurations are valid, and the first reason why the others are not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.tip import tracked_points, tracked_steps
from cellcolor.frontend.reach.validity_tests import (
    STANDARD_TESTS,
    Postures,
    StandardTest,
    ValidityTest,
    Workplace,
)
from cellcolor.memory import check_memory, chunks

NO_SOLUTION = 1
"""The code where a branch does not reach the pose, so that there is nothing to test."""
STANDARD_REASONS = ("valid", "no solution", *(test.name for test in STANDARD_TESTS))
"""What the first codes mean."""


@dataclass(frozen=True, eq=False)
class Verdicts:
    """What became of configurations (k,), or of all branches at all vertices (n, branches).

    Attributes:
        configurations: (..., joints) in rad, turned into the limits where possible; NaN without
            solution.
        reasons: (...) uint8 codes, which index ``reason_names``.
        determinants: (...) task determinant in m^3, NaN without solution.
        tracked: (points, ..., 3) of the bodies that can move, in the world, m, see
            :func:`~cellcolor.frontend.contact.tip.tracked_points`; NaN as above.
        reason_names: valid, no solution, and the tests in the order of testing.
    """

    configurations: Array
    reasons: NDArray[np.uint8]
    determinants: Array
    tracked: Array
    reason_names: tuple[str, ...]

    @property
    def valid(self) -> Mask:
        """(...)."""
        return np.asarray(self.reasons == VALID)


def turned_into_limits(robot: Robot, configurations: Array) -> Array:
    """Turn joints by full circles into their limits; prismatic ones stay where they are.

    An angle inside its limits stays as it is; another one takes the smallest equivalent that is not
    below them, which is beyond them if none is inside.
    """
    circle = 2 * np.pi
    turned = configurations + circle * np.ceil((robot.lower - configurations) / circle)
    inside = (configurations >= robot.lower) & (configurations <= robot.upper)
    return np.where(inside | robot.slides, configurations, turned)


class Judge:
    """The tests of one workplace: the standard ones, then those that the scene adds.

    Attributes:
        reason_names: of the codes of verdicts: valid, no solution, and the tests in the order of
            testing, whether the setup leaves them out or not.
        tracked_steps: (points,) how far those of :attr:`Verdicts.tracked` may move between two
            tests, m.
    """

    def __init__(
        self,
        workplace: Workplace,
        added: tuple[ValidityTest, ...] = (),
        left_out: frozenset[str] = frozenset(),
    ) -> None:
        """The tests of a workplace."""
        self._workplace = workplace
        # Two tests of one kind, with other keys, are one reason.
        self.reason_names = tuple(dict.fromkeys([*STANDARD_REASONS, *(t.name for t in added)]))
        on = workplace.setup.constraints
        tests: list[StandardTest | ValidityTest] = [
            test for test in STANDARD_TESTS if getattr(on, test.constraint)
        ]
        self._tests = tuple(test for test in [*tests, *added] if test.name not in left_out)
        margins = workplace.setup.margins
        least = min(margins.to_object_m, margins.to_obstacles_m, margins.to_ground_m)
        self.tracked_steps = tracked_steps(workplace.robot, least, margins.between_links_m)

    def __call__(self, configurations: Array, deadline: Deadline = NEVER) -> Verdicts:
        """Test configurations (..., joints) in rad, NaN where there is none.

        Raises:
            TooLarge: the verdicts would not fit into the machine's memory.
        """
        *shape, joints = configurations.shape
        asked = configurations.reshape(-1, joints)
        count, points = len(asked), len(self.tracked_steps)
        # Of millions the ends of all bodies are a gigabyte: there is to be no second copy.
        # Solids have many points, which single precision makes up for: a tenth of a micrometer does
        # not matter to how far bodies move.
        place = np.float32 if self._workplace.robot.has_solids else np.float64
        kept = 8 * joints + 9 + 24 * points
        check_memory(count * kept, f"judging {count:,} configurations of the arm")
        moved = asked.copy()
        reasons = np.full(count, NO_SOLUTION, np.uint8)
        determinants, tracked = np.full(count, np.nan), np.full((points, count, 3), np.nan, place)
        robot = self._workplace.robot
        for part in chunks(count):
            deadline.check()
            rows = part.start + np.flatnonzero(~np.isnan(asked[part, 0]))
            moved[rows] = turned_into_limits(robot, asked[rows])
            postures = Postures.of(self._workplace, moved[rows])
            determinants[rows] = postures.determinant
            tracked[:, rows] = tracked_points(robot, postures.ends, postures.poses)
            reasons[rows] = self._first_failures(postures)
        return Verdicts(
            moved.reshape(configurations.shape),
            reasons.reshape(shape),
            determinants.reshape(shape),
            tracked.reshape(points, *shape, 3),
            self.reason_names,
        )

    def _first_failures(self, postures: Postures) -> NDArray[np.uint8]:
        """The code (k,) of the first test that each posture fails."""
        reasons = np.full(len(postures), VALID, dtype=np.uint8)
        left = np.arange(len(postures))
        for test in self._tests:
            failed = test.failed(postures)
            reasons[left[failed]] = self.reason_names.index(test.name)
            left, postures = left[~failed], postures.without(failed)
        return reasons
