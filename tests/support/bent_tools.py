"""Tools that are not on the last joint's axis, and whole poses of a tool by Pinocchio."""

from __future__ import annotations

import dataclasses

import dh_arms
import numpy as np
import pinocchio as pin
from assembled import load_robot

from cellcolor.arrays import Array
from cellcolor.frontend.arm.robot import GIVEN_TURN, Robot
from cellcolor.frontend.arm.urdf import parse_urdf

STRAIGHT = ("0 0 0.1", "0 0 0")
BENT = ("0.06 -0.03 0.12", "0.5 0.7 -0.4")
ACROSS = ("0.05 0.02 -0.03", "0 1.5707963267948966 0.3")


def robot(arm: str, at: tuple[str, str] = BENT) -> Robot:
    """An arm of ``dh_arms``, or of a URDF, with such a tool, whose turn is given."""
    text = arm if arm.startswith("<") else dh_arms.urdf(arm)
    parsed = parse_urdf(text, "arm.urdf"), parse_urdf(dh_arms.tool_of(*at), "tool.urdf")
    loaded = load_robot(parsed[0], "flange", parsed[1], "tool_tip", 6)
    return dataclasses.replace(loaded, task=GIVEN_TURN)


def tip_frame(model: pin.Model, q: Array) -> pin.SE3:
    """The tip's pose in a configuration (joints,)."""
    data = model.createData()
    pin.framesForwardKinematics(model, data, q)
    return data.oMf[model.getFrameId("tool_tip")].copy()


def tip_frames(model: pin.Model, joints: Array) -> tuple[Array, Array, Array]:
    """Tips, z axes and x axes (k, 3) in configurations (k, joints)."""
    frames = [tip_frame(model, q) for q in joints]
    turns = np.array([frame.rotation for frame in frames]).reshape(-1, 3, 3)
    tips = np.array([frame.translation for frame in frames]).reshape(-1, 3)
    return tips, turns[:, :, 2], turns[:, :, 0]
