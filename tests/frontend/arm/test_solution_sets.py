"""Every arm's solutions against Newton's method from many starts (docs/arms.md)."""

from __future__ import annotations

import dh_arms
import numpy as np
import pytest
from shipped import ROBOTS
from solution_sets import JOINTS, KINDS, Arm, near_singular

from cellcolor.arrays import Array
from cellcolor.frontend.arm.eaik import EaikKinematics
from cellcolor.frontend.arm.offset_wrist import OffsetWrist
from cellcolor.frontend.setup import Setup

pytestmark = pytest.mark.second

SHIPPED = ("ur5", "ur3e", "ur5e", "ur10e", "ur16e", "ur5e_calibrated", "kr6", "irb120", "tx2_60")
OTHERS = ("puma560", "passing", "cuspidal", *dh_arms.OFFSET_WRISTS)


def arm(name: str) -> Arm:
    if name in SHIPPED:
        return Arm.of(Setup.read(ROBOTS / f"{name}_polishing.toml"))
    robot = dh_arms.robot(dh_arms.urdf(name))
    family = OffsetWrist if name in dh_arms.OFFSET_WRISTS else EaikKinematics
    return Arm(robot, family(robot, dh_arms.LOCKED))


def random_joints(count: int, seed: int) -> Array:
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (count, 6))


@pytest.mark.parametrize("count", [20, pytest.param(300, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", SHIPPED + OTHERS)
def test_the_same_solutions(name: str, count: int) -> None:
    different, solutions = arm(name).different(random_joints(count, 6), 250)
    assert different == 0 and solutions > (5 if name in SHIPPED else 3) * count


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["ur3e", "irb120", "tx2_60", "puma560", "ur5e_calibrated"])
def test_none_is_lost_next_to_a_singularity(name: str, kind: str) -> None:
    """Beyond a determinant of 1e-5 of the cube of the reach sets are the same, at any distance."""
    one = arm(name)
    for off in (1e-2, 1e-4, 1e-7, 0.0):
        q = near_singular(one.robot, kind, off, 2)
        assert len(q) == 2 and one.different(q, 120)[0] == 0
        # Half of the digits are lost where two solutions meet; the calibrated arm is iterated.
        if off >= 1e-4 and name != "ur5e_calibrated":
            assert one.lost(q, within=1e-9 / off) == 0


def test_a_lost_solution_is_noticed() -> None:
    """One branch left out is a difference at every pose that has it."""
    one = arm("kr6")
    solve = one.family.solve

    def without_the_first(points: Array, directions: Array) -> Array:
        return solve(points, directions)[:, 1:]

    one.family.solve = without_the_first  # type: ignore[method-assign, assignment]
    assert one.different(random_joints(10, 5), 120)[0] > 5


def test_next_to_an_aligned_wrist_solutions_are_all_round_the_circle() -> None:
    """There the ideal arm's are elsewhere, and the true one may have more than there are names."""
    one = arm("ur5e_calibrated")
    q = random_joints(20_000, 7)
    q[:, 4] = np.random.default_rng(7).uniform(-0.002, 0.002, len(q))
    own = q[one.is_regular(q[:, :JOINTS])][:200]
    # One in eight was lost before the ideal arm was asked for poses around as well.
    assert len(own) == 200 and one.lost(own, within=1e-5) <= 4


def test_solutions_where_an_offset_wrist_passes_the_shoulder() -> None:
    """Two of twelve lie where the equation jumps: there joints 1 to 3 turn fast."""
    q = np.array([[1.629821223, 1.849835247, 1.022817709, 1.180825568, -1.549104954, 2.125680380]])
    assert arm("crx10ia").different(q, 250) == (0, 12)
