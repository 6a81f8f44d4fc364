"""Every arm's solutions against ssik: 5,000 poses each with ``-m slow`` (docs/arms.md).

The calibrated arm's are in ``test_many_starts.py``.
"""

from __future__ import annotations

import dh_arms
import numpy as np
import pytest
from shipped import ROBOTS

from cellcolor.frontend.arm.eaik import EaikKinematics
from cellcolor.frontend.setup import RobotFiles, Setup

pytest.importorskip("ssik")

from solution_sets import KINDS, Arm, near_singular

pytestmark = pytest.mark.second

ARMS = ("ur5", "ur3e", "ur5e", "ur10e", "ur16e", "kr6", "irb120", "tx2_60")
NOT_SHIPPED = ("puma560", "passing", "cuspidal")
FILES = RobotFiles(
    arm_urdf="<", flange_link="flange", tool_urdf="<", tip_link="tool_tip", locked_joint_6_rad=0.4
)


def arm(name: str) -> Arm:
    if name in ARMS:
        return Arm.of(Setup.read(ROBOTS / f"{name}_polishing.toml"))
    robot = dh_arms.robot(dh_arms.urdf(name))
    return Arm(robot, EaikKinematics(robot, FILES))


@pytest.mark.parametrize("count", [40, pytest.param(5000, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ARMS + NOT_SHIPPED)
def test_the_same_solutions(name: str, count: int) -> None:
    """Now and then ssik has fewer, of arms whose signs have no names; these reach the pose, too."""
    q = np.random.default_rng(6).uniform(-np.pi, np.pi, (count, 6))
    found = arm(name).compared(q)
    assert found.different <= (5 if name in NOT_SHIPPED and count == 5000 else 0)
    assert found.solutions > (3 if name in NOT_SHIPPED else 5) * found.poses


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["ur3e", "irb120", "tx2_60", "puma560"])
def test_none_is_lost_next_to_a_singularity(name: str, kind: str) -> None:
    """Beyond a determinant of 1e-5 of the cube of the reach sets are the same, at any distance."""
    one = arm(name)
    for off in (1e-2, 1e-4, 1e-7, 0.0):
        q = near_singular(one.robot, kind, off, 4)
        assert len(q) == 4 and one.compared(q).different == 0
        if off >= 1e-4:  # half of the digits are lost where two solutions meet
            assert one.lost(q, within=1e-9 / off) == 0
