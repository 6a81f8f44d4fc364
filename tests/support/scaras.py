"""SCARAs with the prismatic joint anywhere, and their solutions by Newton's method on Pinocchio."""

from __future__ import annotations

import dataclasses

import dh_arms
import numpy as np
import pinocchio as pin
from bent_tools import tool
from independent import wrapped

from cellcolor.arrays import Array
from cellcolor.frontend.arm.loading import load_robot
from cellcolor.frontend.arm.robot import POSITION, POSITION_AND_TURN, Robot
from cellcolor.frontend.arm.urdf import parse_urdf

ORDERS = ("RRPR", "RRRP", "PRRR", "RPRR")
WITHOUT_TURN = ("RRP", "RPR", "PRR")
FLIP = np.diag([1.0, -1.0, -1.0])


def scara(order: str, seed: int) -> Robot:
    """Parallel axes up or down, frames turned and shifted by chance, and the tool beside them."""
    random = np.random.default_rng(seed)
    steps, before, arms = [], np.eye(3), 0
    for kind in order:
        after = FLIP if random.integers(2) else np.eye(3)
        step = np.eye(4)
        angle = random.uniform(-3, 3)
        cosine, sine = np.cos(angle), np.sin(angle)
        turn = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
        step[:3, :3] = before.T @ turn @ after
        # Arms of some length, and everything else nearly beside its joint.
        arms += kind == "R"
        far = random.uniform(0.2, 0.4) if kind == "R" and arms > 1 else random.uniform(0.0, 0.02)
        away = random.uniform(-np.pi, np.pi)
        step[:3, 3] = before.T @ [far * np.cos(away), far * np.sin(away), random.uniform(-0.1, 0.1)]
        steps.append(step)
        before = after
    last = np.eye(4)
    last[:3, :3] = before.T @ FLIP
    text = dh_arms.urdf_of([*steps, last])
    for number, kind in enumerate(order, 1):
        if kind == "P":
            text = text.replace(f'"j{number}" type="revolute"', f'"j{number}" type="prismatic"')
    out = 0.05 if len(order) == 4 else random.uniform(0.2, 0.4)
    fixed = parse_urdf(tool((f"{out} -0.02 0.1", "0 0 0.8")), "tool.urdf")
    arm = parse_urdf(text, "arm.urdf")
    robot = load_robot(arm, "flange", fixed, "tool_tip", len(order), prismatic=1)
    return dataclasses.replace(robot, task=POSITION_AND_TURN if len(order) == 4 else POSITION)


def configurations(robot: Robot, count: int, seed: int) -> Array:
    """Random ones (count, joints): angles all around, and slides of 0.3 m to either side."""
    random = np.random.default_rng(seed)
    most = np.where(robot.slides, 0.3, np.pi)
    return random.uniform(-most, most, (count, robot.joints))


def newton_solutions(robot: Robot, wanted: pin.SE3, starts: Array) -> Array:
    """What Newton's method finds from some starts (s, joints), each once, (k, joints).

    The tip's place is asked for, and with four joints the tool's turn.
    """
    model, data = robot.model, robot.model.createData()
    frame, slides = model.getFrameId("tool_tip"), robot.slides
    found: list[Array] = []
    rows = [0, 1, 2, 5][: robot.joints]
    for start in starts:
        q = start.copy()
        for _ in range(40):
            jacobian = pin.computeFrameJacobian(
                model, data, q, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
            )[rows]
            pin.framesForwardKinematics(model, data, q)
            there = data.oMf[frame]
            turn = wanted.rotation @ there.rotation.T
            error = np.array([*(wanted.translation - there.translation), pin.log3(turn)[2]])
            error = error[: robot.joints]
            if np.abs(error).max() < 1e-12:
                break
            step = np.linalg.lstsq(jacobian, error, rcond=1e-9)[0]
            q = q + step * min(1.0, 0.6 / max(np.abs(step).max(), 1e-12))
        else:
            continue
        if not any(distance(robot, q, other) < 1e-6 for other in found):
            found.append(q)
    return np.array(found).reshape(-1, len(slides))


def distance(robot: Robot, first: Array, second: Array) -> float:
    """Of two configurations, the joint that is farthest off, modulo full circles, in rad or m."""
    off = np.where(robot.slides, np.abs(first - second), wrapped(first - second))
    return float(off.max())


def sets_apart(robot: Robot, first: Array, second: Array) -> float:
    """How far two sets of configurations are apart, both ways; infinite if one lacks any."""
    if len(first) != len(second):
        return np.inf
    apart = np.array([[distance(robot, a, b) for b in second] for a in first])
    return float(max(apart.min(axis=0).max(initial=0), apart.min(axis=1).max(initial=0)))
