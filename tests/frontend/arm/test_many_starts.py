"""The calibrated arm's solutions against Newton's method from many starts, and that held, too."""

from __future__ import annotations

import numpy as np
import pytest
from independent import set_distance
from shipped import ROBOTS
from solution_sets import JOINTS, KINDS, Arm, Compared, Ssik, from_many_starts, near_singular

from cellcolor.arrays import Array
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.setup import Setup

pytestmark = pytest.mark.second


def arm(name: str = "ur5e_calibrated") -> Arm:
    return Arm.of(Setup.read(ROBOTS / f"{name}_polishing.toml"))


def random_joints(count: int, seed: int) -> Array:
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (count, 6))


def compared(one: Arm, q: Array, starts: int) -> Compared:
    poses = forward(one.robot, q)
    found = from_many_starts(one.robot, poses.tip, poses.tool_axis, starts, 8)
    return one.held_against(found, q)


@pytest.mark.parametrize("name", ["ur5e", "irb120"])
def test_many_starts_find_all_that_ssik_does(name: str) -> None:
    """Of arms with a closed form, of which there is another solver to say what all are."""
    one = arm(name)
    ssik, poses = Ssik(one.robot), forward(one.robot, random_joints(25, 2))
    found = from_many_starts(one.robot, poses.tip, poses.tool_axis, 120, 3)
    for each, point, direction in zip(found, poses.tip, poses.tool_axis, strict=True):
        theirs = one.regular(ssik.solutions(point, direction, 0.3))
        assert set_distance(one.regular(each), theirs) < 1e-5


@pytest.mark.parametrize("count", [40, pytest.param(1000, marks=pytest.mark.slow)])
def test_the_calibrated_arm_has_the_same_solutions(count: int) -> None:
    found = compared(arm(), random_joints(count, 5), 150)
    assert found.different == 0 and found.solutions > 5 * found.poses


@pytest.mark.parametrize("kind", KINDS)
def test_the_calibrated_arm_loses_none_next_to_a_singularity(kind: str) -> None:
    one = arm()
    for off in (1e-2, 1e-4, 1e-7, 0.0):
        q = near_singular(one.robot, kind, off, 2)
        assert one.is_regular(q[:, :JOINTS]).all() == (off == 1e-2)
        assert compared(one, q, 120).different == 0


def test_a_lost_solution_of_the_calibrated_arm_is_noticed() -> None:
    """One branch left out is a difference at every pose that has it."""
    one = arm()
    solve = one.family.solve

    def without_the_first(points: Array, directions: Array) -> Array:
        return solve(points, directions)[:, 1:]

    one.family.solve = without_the_first  # type: ignore[method-assign, assignment]
    assert compared(one, random_joints(8, 5), 100).different > 3


def test_next_to_an_aligned_wrist_solutions_are_all_round_the_circle() -> None:
    """There the ideal arm's are elsewhere, and the true one may have more than there are names."""
    one = arm()
    q = random_joints(20_000, 7)
    q[:, 4] = np.random.default_rng(7).uniform(-0.002, 0.002, len(q))
    own = q[one.is_regular(q[:, :JOINTS])][:200]
    # One in eight was lost before the ideal arm was asked for poses around as well.
    assert len(own) == 200 and one.lost(own, within=1e-5) <= 4
