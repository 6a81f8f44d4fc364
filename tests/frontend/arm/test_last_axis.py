"""Both senses of the last axis, and tools along it, against it and beside it, for every family.

Solutions are held against Newton's method on Pinocchio's Jacobians, which knows no family.
"""

from __future__ import annotations

import dataclasses
import math
from itertools import product

import bent_tools
import dh_arms
import numpy as np
import pinocchio as pin
import pytest
from assembled import load_robot
from dh_arms import FILES, LOCKED
from independent import wrapped
from shipped import ROBOTS

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.arm.inverse import KINEMATICS, InverseKinematics
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.turned import TurnedKinematics
from cellcolor.frontend.arm.urdf import parse_urdf
from cellcolor.frontend.setup import Turn

pytestmark = pytest.mark.second

OUT, BACK, TILTED = "0 0 0.4", f"{np.pi} 0 0.4", "0.3 0 0"
UPPER, FORE, HAND = (0.3, 0, 0.2, 0), (0.25, 0, 0, 0), (0, 0, -0.1, 0)
LINKS = {
    "planar-2r": (UPPER, FORE),
    "planar-3r": (UPPER, FORE, HAND),
    "scara": (UPPER, FORE, HAND, (0, 0, 0, 0)),
    "scara-rrp": (UPPER, FORE, HAND),
}
SLIDING = {"scara": 3, "scara-rrp": 3}
SIX = [("ur", "ur5e"), ("eaik", "ur5e"), ("eaik", "kr6"), ("eaik", "puma560")]
CASES = [*SIX, *((name, "") for name in LINKS)]
BOTH = list(product((1, -1), (OUT, BACK)))
POSITION, WHOLE = 3, 6


def loaded(family: str, arm: str, sense: int, at: str, rpy: str) -> Robot:
    """An arm whose last turning joint has that sense, with a tool there."""
    constants = dh_arms.ARMS[arm] if arm else LINKS[family]
    text, slides = dh_arms.urdf_of([np.eye(4), *dh_arms.steps_of(constants)]), SLIDING.get(family)
    if slides:
        text = text.replace(f'"j{slides}" type="revolute"', f'"j{slides}" type="prismatic"')
    last = max(n for n in range(1, len(constants) + 1) if n != slides)
    before, after = text.split(f'name="j{last}"')
    text = f'{before}name="j{last}"' + after.replace("0 0 1", f"0 0 {sense}", 1)
    files = parse_urdf(text, "arm.urdf"), parse_urdf(dh_arms.tool_of(at, rpy), "tool.urdf")
    wanted, prismatic = len(constants), 1 if slides else 0
    return load_robot(files[0], "flange", files[1], "tool_tip", wanted, prismatic=prismatic)


def newton(robot: Robot, wanted: pin.SE3, start: Array, task: str) -> Array | None:
    """What Newton's method finds of a task from a start (joints,), None if it finds nothing.

    Asked for are the whole pose, or the tip and the z axis with the sixth joint held, or the tip.
    """
    model, data, q = robot.model, robot.model.createData(), start.copy()
    frame, around = model.getFrameId("tool_tip"), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    for _ in range(60):
        jacobian = pin.computeFrameJacobian(model, data, q, frame, around)
        pin.framesForwardKinematics(model, data, q)
        there = data.oMf[frame]
        turn = pin.log3(wanted.rotation @ there.rotation.T)
        if task == "axis":
            have, z = there.rotation[:, 2], wanted.rotation[:, 2]
            turn = np.cross(have, z) if have @ z > 0 else np.cross(have, z) + 0.1
            jacobian = jacobian.copy()
            jacobian[3:] -= np.outer(have, have @ jacobian[3:])
            jacobian[:, -1] = 0.0
        error = np.array([*(wanted.translation - there.translation), *turn])
        rows = POSITION if task == "tip" else WHOLE
        if np.abs(error[:rows]).max() < 1e-12:
            return q
        step = np.linalg.lstsq(jacobian[:rows], error[:rows], rcond=1e-9)[0]
        q = q + step * min(1.0, 0.6 / max(np.abs(step).max(), 1e-12))
    return None


def held(robot: Robot, solutions: Array, pose: pin.SE3, task: str, seed: int) -> None:
    """All solutions (s, joints) reach the pose, and there are all that Newton's method finds."""
    solutions = solutions[~np.isnan(solutions[:, 0])]
    rows = {"pose": (0, 1, 2), "axis": (2,), "tip": ()}[task]
    for each in solutions:
        reached = bent_tools.tip_frame(robot.model, each)
        assert np.abs(reached.translation - pose.translation).max() < 1e-8
        assert all(np.abs((reached.rotation - pose.rotation)[:, row]).max() < 1e-8 for row in rows)
    random = np.random.default_rng(seed)
    most, count = np.where(robot.slides, 0.3, np.pi), 0
    for _ in range(8):
        start = random.uniform(-most, most, robot.joints)
        if task == "axis":
            start[-1] = LOCKED.locked_joint_6_rad
        theirs = newton(robot, pose, start, task)
        if theirs is None:
            continue
        off = np.where(robot.slides, np.abs(solutions - theirs), wrapped(solutions - theirs))
        assert len(off) and off.max(axis=1).min() < 1e-5
        count += 1
    assert count


@pytest.mark.parametrize(("sense", "rpy"), BOTH)
@pytest.mark.parametrize(
    ("family", "arm"), [each for each in CASES if each[0] not in ("planar-2r", "scara-rrp")]
)
def test_a_given_turn(family: str, arm: str, sense: int, rpy: str) -> None:
    """By the rule, from points and directions: tips before the wrist, beside it and behind it."""
    of: type[InverseKinematics] = KINEMATICS.find(family)
    inside = dh_arms.ARMS[arm][-1][2] if arm else 0.0
    for seed, height in enumerate((0.1, 0.0, -inside, -0.16)):
        at = f"0.05 -0.02 {height}"
        robot = dataclasses.replace(loaded(family, arm, sense, at, rpy), task=of.given_turn)
        q = np.random.default_rng(seed).uniform(-0.9, 0.9, robot.joints) + 0.5
        q[robot.slides] = 0.1
        pose = bent_tools.tip_frame(robot.model, q)
        turn = Turn(along=tuple(pose.rotation[:, 0].tolist()))
        found = TurnedKinematics(of, robot, FILES, turn).solve(
            pose.translation[None], pose.rotation[None, :, 2]
        )
        held(robot, found[0], pose, "pose", seed)


@pytest.mark.parametrize(("sense", "rpy"), BOTH)
@pytest.mark.parametrize(
    ("family", "arm"), [each for each in CASES if each[0] not in ("planar-3r", "scara")]
)
def test_a_free_turn(family: str, arm: str, sense: int, rpy: str) -> None:
    robot = loaded(family, arm, sense, "0 0 0.1" if arm else "0.2 0.1 0.1", rpy)
    of: type[InverseKinematics] = KINEMATICS.find(family)
    robot = dataclasses.replace(robot, task=of.free_turn)
    if (family, rpy) == ("ur", BACK):  # this family has no solution for it, and says so
        with pytest.raises(InputError, match="points back into the wrist"):
            of(robot, LOCKED)
        return
    kinematics = of(robot, LOCKED if arm else FILES)
    for seed in range(3):
        q = np.random.default_rng(seed).uniform(-0.9, 0.9, robot.joints) + 0.5
        if arm:
            q[-1] = LOCKED.locked_joint_6_rad
        pose = bent_tools.tip_frame(robot.model, q)
        found = kinematics.solve(pose.translation[None], pose.rotation[None, :, 2])
        held(robot, found[0], pose, "axis" if arm else "tip", seed)


@pytest.mark.parametrize("family", ["planar-3r", "scara"])
def test_a_tool_that_no_joint_can_tilt_must_not_be_tilted(family: str) -> None:
    """Taken for one along the axis it would be sent to places where its tip is not."""
    robot = loaded(family, "", 1, "0.05 0 0.1", TILTED)
    with pytest.raises(InputError, match="not parallel to the tool's z axis"):
        TurnedKinematics(KINEMATICS.find(family), robot, FILES, Turn(along=(1, 0, 0)))


def mounted(position: tuple[float, float, float], rpy: tuple[float, float, float]) -> Robot:
    files = (ROBOTS / "ur5.urdf", "wrist_3_link", ROBOTS / "polishing_tool.urdf", "tool_tip")
    return load_robot(*files, mount_position_m=position, mount_rpy_rad=rpy)


def check(robot: Robot) -> None:
    KINEMATICS.find("ur")(robot, FILES.varied(locked_joint_6_rad=0.0))


def test_off_by_a_mount() -> None:
    # Tilted about the flange by an angle, the tip 0.1 m from it; the offset is across that.
    tilt = math.radians(3)
    off = math.hypot(100 * math.sin(tilt), 12.5)
    with pytest.raises(InputError, match=f"tip is {off:.3g} mm off it, the axis 3 deg") as caught:
        check(mounted((0.0, 0.0125, 0.0), (0.0, tilt, 0.0)))
    assert caught.value.field == "joint[wrist_3_joint]"


def test_on_the_axis_at_any_turn() -> None:
    check(mounted((0.0, 0.0, 0.07), (0.0, 0.0, 1.2)))
