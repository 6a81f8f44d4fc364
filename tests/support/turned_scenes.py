"""Scenes for a UR5 whose tool has its turn by a rule: a plate before it."""

from __future__ import annotations

import re
from functools import cache

import bent_tools
import dh_arms
from shipped import ROBOTS

from cellcolor.frontend import Scene, Setup
from cellcolor.frontend.parts.shapes import RectangleObject

SHIPPED = Setup.read(ROBOTS / "ur5_polishing.toml")


@cache
def arm(lower: float, upper: float) -> str:
    """The shipped arm's URDF with other limits of joint 6, rad."""
    text, found = re.subn(
        r'(<joint name="wrist_3_joint".*?<limit )lower="[^"]*" upper="[^"]*"',
        rf'\1lower="{lower}" upper="{upper}"',
        (ROBOTS / "ur5.urdf").read_text(),
        flags=re.DOTALL,
    )
    assert found == 1
    return text


def setup(
    turn: dict[str, object] | None, limits: tuple[float, float] | None = None, tool: str = ""
) -> Setup:
    """The shipped setup with ``[task.turn]``.

    Args:
        turn: its keys; None for a free turn.
        limits: of joint 6, rad.
        tool: one of ``bent_tools``, bent or across; the shipped one without.
    """
    robot: dict[str, object] = {"locked_joint_6_rad": 0.0 if turn is None else None}
    if limits is not None:
        robot["arm_urdf"] = arm(*limits)
    if tool:
        at = {"bent": bent_tools.BENT, "across": bent_tools.ACROSS}[tool]
        robot["tool_urdf"] = dh_arms.tool_of(*at)
    return SHIPPED.varied(task={"turn": turn}, robot=robot, slivers=None)


def plate(given: Setup, vertices: int = 40) -> Scene:
    """A plate of 250 by 600 mm before the arm."""
    part = RectangleObject(size_x_m=0.25, size_y_m=0.6, target_vertices=vertices)
    placement = {"position_m": (0.45, 0.0, 0.1)}
    return Scene(name="plate", setup=given, object=part, placement=placement)
