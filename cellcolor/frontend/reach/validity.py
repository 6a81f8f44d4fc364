"""Which configurations are valid, and the first reason why the others are not."""

from __future__ import annotations

import time
from copy import copy
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.movement import tracked_points, tracked_steps
from cellcolor.frontend.reach.validity_tests import (
    STANDARD_TESTS,
    Postures,
    ValidityTest,
    Workplace,
)
from cellcolor.memory import check_memory, chunks

NO_SOLUTION = 1
"""The code where a branch does not reach the pose, so that there is nothing to test."""
_NAMES = ("valid", "no solution")  # of the codes that no test stands for


@dataclass(frozen=True)
class Candidates:
    """All branches on all vertices.

    Attributes:
        configurations: (n, branches, joints) in rad, inside the limits where possible; NaN
            without solution.
        reasons: (n, branches) uint8 codes, which index ``reason_names``.
        determinants: (n, branches) task determinant in m^3, NaN without solution.
        reason_names: valid, no solution, and the tests in the order of testing.
    """

    configurations: Array
    reasons: NDArray[np.uint8]
    determinants: Array
    reason_names: tuple[str, ...]

    @property
    def valid(self) -> Mask:
        """(n, branches)."""
        valid: Mask = self.reasons == VALID
        return valid


@dataclass(frozen=True)
class Verdicts:
    """What became of configurations.

    Attributes:
        configurations: (k, joints) in rad, turned into the limits where possible.
        reasons: (k,) uint8 codes, which index :attr:`Judge.reason_names`.
        determinants: (k,) task determinant in m^3, NaN without solution.
        tracked: (points, k, 3) of the bodies that can move, in the world, m, see
            :func:`~cellcolor.frontend.contact.movement.tracked_points`; NaN as above.
        seconds: of forward kinematics and of each test.
    """

    configurations: Array
    reasons: NDArray[np.uint8]
    determinants: Array
    tracked: Array
    seconds: dict[str, float]

    def followed_by(self, others: Verdicts) -> Verdicts:
        """These verdicts, and then those on other configurations."""
        both = np.concatenate
        return Verdicts(
            both([self.configurations, others.configurations]),
            both([self.reasons, others.reasons]),
            both([self.determinants, others.determinants]),
            both([self.tracked, others.tracked], axis=1),
            {name: self.seconds[name] + others.seconds[name] for name in self.seconds},
        )


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
        left_out: names of tests that are not made.
        tracked_steps: (points,) how far those of :attr:`Verdicts.tracked` may move between two
            tests, m.
    """

    def __init__(
        self,
        workplace: Workplace,
        added: tuple[ValidityTest, ...] = (),
        left_out: frozenset[str] = frozenset(),
    ) -> None:
        """The tests of a workplace.

        Args:
            added: tests that the scene has besides.
            left_out: names of tests that are not made.

        Raises:
            InputError: an added test has the name of a standard one.
        """
        self._workplace, self.left_out = workplace, left_out
        standard_names = (*_NAMES, *(test.name for test in STANDARD_TESTS))
        for number, test in enumerate(added):
            if test.name in standard_names:
                message = f"there is a reason {test.name!r} already"
                raise InputError(None, f"validity_test[{number}]", message)
        # Two tests of one kind, with other keys, are one reason.
        self.reason_names = tuple(dict.fromkeys([*standard_names, *(t.name for t in added)]))
        on = workplace.setup.constraints
        standard = (test for test in STANDARD_TESTS if getattr(on, test.constraint))
        self._tests = tuple(test for test in (*standard, *added) if test.name not in self.left_out)
        margins = workplace.setup.margins
        least = min(margins.to_object_m, margins.to_obstacles_m, margins.to_ground_m)
        self.tracked_steps = tracked_steps(workplace.robot, least, margins.between_links_m)

    def __call__(self, configurations: Array, deadline: Deadline = NEVER) -> Verdicts:
        """Test configurations (k, joints) in rad, NaN where there is none.

        Raises:
            TooLarge: the verdicts would not fit into the machine's memory.
        """
        count = len(configurations)
        points, joints = len(self.tracked_steps), configurations.shape[1]
        # Of millions the ends of all bodies are a gigabyte: there is to be no second copy.
        # A solid has four times the points of a capsule, which single precision makes up for: a
        # tenth of a micrometer does not matter to how far bodies move.
        place = np.float32 if self._workplace.robot.has_solids else np.float64
        kept = 8 * joints + 9 + 24 * points
        check_memory(count * kept, f"judging {count:,} configurations of the arm")
        whole = Verdicts(
            np.zeros(configurations.shape),
            np.zeros(count, np.uint8),
            np.zeros(count),
            np.zeros((points, count, 3), place),
            dict.fromkeys(("forward kinematics", *(test.name for test in self._tests)), 0.0),
        )
        for rows in chunks(count):
            deadline.check()
            part = self._judged(configurations[rows])
            whole.configurations[rows], whole.reasons[rows] = part.configurations, part.reasons
            whole.determinants[rows], whole.tracked[:, rows] = part.determinants, part.tracked
            for name, seconds in part.seconds.items():
                whole.seconds[name] += seconds
        return whole

    def only(self, names: frozenset[str]) -> Judge:
        """The same judge, with the tests of these names only."""
        judge = copy(self)
        judge._tests = tuple(test for test in self._tests if test.name in names)
        return judge

    def all_failures(self, configurations: Array) -> dict[str, Mask]:
        """Which configurations (k, joints) fail each test, also where they fail another one."""
        postures = Postures.of(
            self._workplace, turned_into_limits(self._workplace.robot, configurations)
        )
        failed: dict[str, Mask] = {}
        for test in self._tests:
            before = failed.get(test.name, np.zeros(len(configurations), dtype=bool))
            failed[test.name] = before | test.failed(postures)
        return failed

    def _judged(self, configurations: Array) -> Verdicts:
        count = len(configurations)
        moved, reasons = configurations.copy(), np.full(count, NO_SOLUTION, dtype=np.uint8)
        solved = np.flatnonzero(~np.isnan(configurations[:, 0]))
        started = time.perf_counter()
        moved[solved] = turned_into_limits(self._workplace.robot, moved[solved])
        postures = Postures.of(self._workplace, moved[solved])
        determinants, places = (
            np.full(count, np.nan),
            np.full((len(self.tracked_steps), count, 3), np.nan),
        )
        determinants[solved] = postures.determinant
        robot = self._workplace.robot
        places[:, solved] = tracked_points(robot, postures.ends, postures.poses)
        seconds = {"forward kinematics": time.perf_counter() - started}
        reasons[solved] = self._first_failures(postures, seconds)
        return Verdicts(moved, reasons, determinants, places, seconds)

    def _first_failures(self, postures: Postures, seconds: dict[str, float]) -> NDArray[np.uint8]:
        """The code (k,) of the first test that each posture fails; notes the time of each test."""
        reasons = np.full(len(postures), VALID, dtype=np.uint8)
        left = np.arange(len(postures))
        for test in self._tests:
            started = time.perf_counter()
            failed = test.failed(postures)
            reasons[left[failed]] = self.reason_names.index(test.name)
            left, postures = left[~failed], postures.without(failed)
            seconds[test.name] = time.perf_counter() - started
        return reasons
