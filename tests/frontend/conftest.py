"""The shipped robot, and scenes made from the shipped wok with some keys changed."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from assembled import load_robot
from shipped import ROBOTS, WOK, with_keys, wok_file

from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.ur import UrGeometry, ur_geometry
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Setup

Varied = Callable[..., Scene]


@pytest.fixture(scope="session")
def robot() -> Robot:
    """The UR5 with its polishing tool."""
    return load_robot(
        ROBOTS / "ur5.urdf", "wrist_3_link", ROBOTS / "polishing_tool.urdf", "tool_tip"
    )


@pytest.fixture(scope="session")
def geometry(robot: Robot) -> UrGeometry:
    """Its Denavit-Hartenberg constants."""
    return ur_geometry(robot)


@pytest.fixture(scope="session")
def setup() -> Setup:
    """The shared setup."""
    return Setup.read(ROBOTS / "ur5_polishing.toml")


@pytest.fixture
def scene(tmp_path: Path) -> Varied:
    """``scene(setup={...}, arm=function, radius_m=.3, ...)`` makes a variant of the wok.

    ``setup`` changes keys of the setup, ``arm`` rewrites the arm's URDF text, and the other names
    change keys of the scene.
    """

    def vary(
        setup: dict[str, object] | None = None,
        arm: Callable[[str], str] | None = None,
        **keys: object,
    ) -> Scene:
        wok = Scene.read(WOK)
        changed = with_keys(wok.setup, **(setup or {}))
        if arm is not None:
            file = tmp_path / "arm.urdf"  # Pinocchio reads it as well
            file.write_text(arm((ROBOTS / "ur5.urdf").read_text()))
            changed = changed.varied(robot={"arm_urdf": str(file)})
        return with_keys(wok.with_setup(changed), **keys)

    return vary


@pytest.fixture
def scene_file(tmp_path: Path) -> Callable[..., Path]:
    """The variant as a file instead, beside its setup; see :func:`shipped.wok_file`."""
    return partial(wok_file, tmp_path)
