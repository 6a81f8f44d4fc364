"""Motions that nobody planned, of every shipped arm, for exports."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from shipped import ROBOTS

from cellcolor.data.trajectory import Trajectory
from cellcolor.exports.interface import PlannedMotion
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.reach.prepared_arm import prepare_arm
from cellcolor.frontend.setup import Setup


@cache
def arm(name: str) -> Robot:
    return prepare_arm(setup_of(name)).robot


def setup_of(name: str) -> Setup:
    (setup, *_) = sorted(ROBOTS.glob(f"{name}*.toml"), key=lambda path: len(path.name))
    return Setup.read(setup)


def on(robot: Robot, setup: Setup) -> dict[str, Any]:
    """What exports know of an arm."""
    flange, base = robot.frame_of(setup.robot.flange_link), robot.base_frame(None)
    return {"robot": robot, "flange": flange, "base": base}


def driven(
    name: str, seed: int = 0, unplanned: tuple[int, ...] = (), **keys: object
) -> PlannedMotion:
    """A motion of an arm that nobody planned: waves, the tool on the surface now and then."""
    random, robot = np.random.default_rng(seed), arm(name)
    count = 60
    times = np.cumsum(random.uniform(0.005, 0.2, count))
    shape = random.uniform(0.1, 0.6, robot.joints), random.uniform(0.2, 1.0, robot.joints)
    joints = shape[0] * np.sin(times[:, None] * shape[1] + random.uniform(0, 6, robot.joints))
    contact = (np.arange(count) % 30 > 5) & (np.arange(count) % 30 < 26)
    trajectory = Trajectory(
        "waves", robot.joint_names, times, joints, random.normal(size=(count, 3)),
        np.tile([0.0, 0.0, 1.0], (count, 1)), contact, np.where(contact, 0, -1), unplanned,
    )  # fmt: skip
    keys = on(robot, setup_of(name)) | {"controller": setup_of(name).controller} | keys
    return PlannedMotion(trajectory, **keys)
