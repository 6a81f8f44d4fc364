"""Scene and setup files: what is refused, and that the fault is named."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from shipped import ROBOTS, WOK

from cellcolor.errors import InputError
from cellcolor.frontend import build_surface


@pytest.fixture
def files(tmp_path: Path) -> Path:
    """The wok's scene, setup and robot in one folder."""
    for name in ("ur5.urdf", "polishing_tool.urdf", "ur5_polishing.toml"):
        shutil.copy(ROBOTS / name, tmp_path)
    text = WOK.read_text().replace("../../models/robots/", "")
    (tmp_path / "wok.toml").write_text(text)
    return tmp_path


SCENE, SETUP = "wok.toml", "ur5_polishing.toml"
MESH = '[object]\nkind = "mesh"\nfile = "none.stl"\nmeters_per_unit = 1.0\n[placement]'


@pytest.mark.parametrize(
    ("file", "pattern", "replacement", "blamed", "field", "message"),
    [
        (SCENE, r"seed = 1", "sed = 1", SCENE, "object.sed", "unknown key"),
        (SCENE, r"\[ground\]", "[floor]", SCENE, "floor", "unknown key"),
        (SCENE, r"radius_m = 0.20", "", SCENE, "object.radius_m", "is missing"),
        (SCENE, r"radius_m = 0.20", "radius_m = nan", SCENE, "object.radius_m", "finite"),
        (SCENE, r"radius_m = 0.20", "radius_m = inf", SCENE, "object.radius_m", "finite"),
        (SCENE, r"radius_m = 0.20", "radius_m = -0.2", SCENE, "object.radius_m", "greater"),
        (SCENE, r"radius_m = 0.20", 'radius_m = "0.2"', SCENE, "object.radius_m", "number"),
        (SCENE, r"half_angle_rad = 1\.", "half_angle_rad = 65.", SCENE, "object.half_angle_rad",
         "65.1345 looks like degrees: 1.1368 rad"),
        (SCENE, r"jitter = 0.15", "jitter = 0.6", SCENE, "object.jitter", "less"),
        (SCENE, r"target_vertices = 1000", "target_vertices = 20.5", SCENE,
         "object.target_vertices", "integer"),
        (SCENE, r'kind = "spherical-cap"', 'kind = "torus"', SCENE, "object", "torus"),
        (SCENE, r"rpy_rad = .*?\]", "rpy_rad = [0.0, 0.0]", SCENE, "placement.rpy_rad[2]",
         "is missing"),
        (SCENE, r"position_m = .*?\]", "position_m = [0.0, nan, 0.0]", SCENE,
         "placement.position_m[1]", "finite"),
        (SCENE, r"\[placement\].*?\[ground", "[ground", SCENE, "placement", "is missing"),
        (SCENE, r"$", '\n[[obstacle]]\nkind = "box"\nsize_m = [1.0, 1.0, 0.0]\n'
         "position_m = [0.0, 0.0, 0.0]", SCENE, "obstacle[0].size_m[2]", "greater"),
        (SCENE, r"$", '\n[[obstacle]]\nkind = "sphere"\nradius_m = 0.1\n', SCENE,
         "obstacle[0].position_m", "is missing"),
        (SCENE, r"\[placement\]", "[placement", SCENE, None, "not TOML"),
        (SCENE, r"\[object\].*?\[placement\]", MESH, "none.stl", None, "no such mesh file"),
        (SCENE, r'"ur5_polishing.toml"', '"none.toml"', "none.toml", None, "No such file"),
        (SETUP, r"normal_force_n", "normal_force", SETUP, "task.normal_force",
         "unknown key; is 'normal_force_n' meant?"),
        (SCENE, r"\[placement\]", "[placment]", SCENE, "placment",
         "unknown key; is 'placement' meant?"),
        (SETUP, r"base_step_rad = 0.1", "base_step_rad = 0.0", SETUP,
         "continuity.base_step_rad", "greater"),
        (SETUP, r"(probe_spacing_m)", r"border_length_m = 0.01\n\1", SETUP,
         "continuity.border_length_m", "no longer known: for exact borders give .* max_edge_m"),
        (SETUP, r'"ur5.urdf"', '"ur7.urdf"', "ur7.urdf", None, "No such file"),
        (SETUP, r'"tool_tip"', '"nose"', "polishing_tool.urdf", "link[nose]", "tip link"),
        (SETUP, r'"shoulder_link"\]', '"elbow"]', SETUP, "robot.may_touch_ground", "'elbow'"),
        (SETUP, r"joint_6_rad = 0.0", "joint_6_rad = 9.0", SETUP, "robot.locked_joint_6_rad",
         "outside the limits"),
    ],
)  # fmt: skip
def test_faults_are_named(
    files: Path,
    file: str,
    pattern: str,
    replacement: str,
    blamed: str,
    field: str | None,
    message: str,
) -> None:
    text, found = re.subn(
        pattern, replacement, (files / file).read_text(), count=1, flags=re.DOTALL
    )
    assert found
    (files / file).write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        build_surface(files / SCENE)
    assert caught.value.file == str(files / blamed)
    assert caught.value.field == field
    assert "\n" not in str(caught.value)


def test_missing_scene(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file") as caught:
        build_surface(tmp_path / "none.toml")
    assert caught.value.file == str(tmp_path / "none.toml")


def test_mesh_without_a_usable_format_names_file(files: Path) -> None:
    text = re.sub(r"\[object\].*?\[placement\]", MESH, (files / SCENE).read_text(), flags=re.DOTALL)
    (files / SCENE).write_text(text)
    (files / "none.stl").write_text("solid nothing\nendsolid nothing\n")
    with pytest.raises(InputError) as caught:
        build_surface(files / SCENE)
    assert caught.value.file == str(files / "none.stl")
