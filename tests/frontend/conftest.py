"""The shipped robot, and scenes made from the shipped wok with some keys changed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from shipped import ROBOTS, WOK, edited, with_keys

from cellcolor.frontend.arm.robot import Robot, load_robot
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
def scene() -> Varied:
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
            changed = changed.varied(robot={"arm_urdf": arm((ROBOTS / "ur5.urdf").read_text())})
        return with_keys(wok.with_setup(changed), **keys)

    return vary


@pytest.fixture
def scene_file(tmp_path: Path) -> Callable[..., Path]:
    """``scene_file(setup={...}, radius_m=.3, ...)`` writes a variant of the wok and its setup.

    ``setup`` replaces keys of the setup's text, and the other names those of the scene's.
    """

    def write(setup: dict[str, object] | None = None, **keys: object) -> Path:
        for name in ("ur5.urdf", "polishing_tool.urdf", "ur5_polishing.toml"):
            text = (ROBOTS / name).read_text()
            if name == "ur5_polishing.toml":
                text = edited(text, **(setup or {}))
            (tmp_path / name).write_text(text)
        file = tmp_path / "scene.toml"
        file.write_text(edited(WOK.read_text(), **({"setup": '"ur5_polishing.toml"'} | keys)))
        return file

    return write
