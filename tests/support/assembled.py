"""An arm and a tool put together as a setup would, by a few keys of its table."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cellcolor.frontend.arm import loading
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.urdf import Urdf, load_urdf
from cellcolor.frontend.setup import RobotFiles


def load_robot(
    arm: Path | Urdf,
    flange: str,
    tool: Path | Urdf,
    tip: str,
    joints: int = 6,
    *,
    prismatic: int = 0,
    force: bool = True,
    **keys: Any,
) -> Robot:
    """Arm and tool from files, or as they have been read; ``keys`` of the table ``[robot]``."""
    files = RobotFiles(arm_urdf="", flange_link=flange, tool_urdf="", tip_link=tip, **keys)
    read = [given if isinstance(given, Urdf) else load_urdf(given) for given in (arm, tool)]
    return loading.load_robot(*read, files, joints, prismatic, force=force)
