"""Where the object is, and whether its outside is towards the robot."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shipped import ROBOTS, SCENES, edited

from cellcolor.cli import main
from cellcolor.frontend import build_surface
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.ur import UrKinematics
from cellcolor.frontend.parts.placement import Placement
from cellcolor.frontend.parts.shapes import CapObject
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.report import Survey, from_behind, survey_of
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Setup
from examples import examples


@pytest.fixture(scope="module")
def arm(robot: Robot) -> UrKinematics:
    return UrKinematics(robot, Setup.read(ROBOTS / "ur5_polishing.toml").robot)


def turned_over(surface: Surface) -> Surface:
    """Its inside out."""
    return replace(surface, faces=surface.faces[:, ::-1].copy(), normals=-surface.normals)


@pytest.mark.parametrize(
    ("scale", "text"), [(0.001, "0.002 x 0.004 x 0 m"), (100.0, "200 x 400 x 0 m")]
)
def test_a_wrong_unit_is_seen(scale: float, text: str) -> None:
    assert str(Survey((2.0 * scale, 4.0 * scale, 0.0), 1.0, 0.0)).startswith(text)


@given(
    st.floats(0.05, 0.25),
    st.floats(0.3, np.pi / 2),
    st.floats(0.35, 0.9),
    st.floats(-0.4, 0.0),
    st.floats(-np.pi, np.pi),
    st.integers(20, 400),
)
@examples(6)
def test_domes_before_the_robot(
    arm: UrKinematics,
    radius: float,
    half_angle: float,
    away: float,
    height: float,
    around: float,
    target: int,
) -> None:
    """The robot looks from above a dome's rim, so it sees no inside, or nothing else."""
    position = (away * np.cos(around), away * np.sin(around), height - radius * np.cos(half_angle))
    part = CapObject(radius_m=radius, half_angle_rad=half_angle, target_vertices=target)
    dome = part.surface().placed(Placement(position_m=position, rpy_rad=(0.0, 0.0, 0.0)))
    assert from_behind(dome.mesh, arm.viewpoints) < 0.1
    over = from_behind(turned_over(dome).mesh, arm.viewpoints)
    (warning,) = Survey((1.0, 1.0, 1.0), 1.0, over).warnings
    assert "from behind" in warning


@pytest.mark.parametrize("scene", sorted(SCENES.glob("*.toml")), ids=lambda path: path.stem)
def test_no_shipped_scene_is_warned_of(scene: Path) -> None:
    """Half a pipe shows the shoulder mostly its inside."""
    prepared = prepare(scene)
    assert survey_of(prepared).warnings == ()


def test_report_and_commands_warn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The square with its outside down: the same mesh wound the other way round."""
    text = (SCENES / "square.toml").read_text().replace("../../models", f"{SCENES}/../../models")
    path = tmp_path / "scene.toml"
    path.write_text(
        edited(text, target_vertices=50, rpy_rad="[3.1416, 0.0, 0.0]", position_m="[0.5, 0.0, 0.0]")
    )
    report = str(build_surface(path).report)
    first, second, *_ = report.splitlines()
    assert first.startswith("object  0.") and first.endswith("from the robot's base")
    assert second.startswith("warning  the robot sees 100 % of the object only from behind")
    main(["solve", str(path)])
    assert f"cellcolor: {path}: warning: the robot sees 100 %" in capsys.readouterr().err
    main(["build", str(path), "-o", str(tmp_path / "out.json")])
    assert second in capsys.readouterr().out


def test_an_open_part_that_faces_down_is_said() -> None:
    """Overhead the robot sees its front, and still it may be the wrong side."""
    plate = Scene.read(SCENES / "square.toml")
    for turn, warned in ((0.0, 0), (np.pi, 1), (np.pi / 2, 0)):
        prepared = prepare(plate.moved(position_m=(0.4, 0.0, 0.6), rpy_rad=(turn, 0.0, 0.0)))
        assert sum("faces down" in text for text in survey_of(prepared).warnings) == warned
