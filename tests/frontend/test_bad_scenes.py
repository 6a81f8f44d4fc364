"""Bad scenes, setups and meshes: one line with file and field, and exit code 2."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from shipped import ROBOTS, WOK

from cellcolor.cli import main
from cellcolor.errors import InputError
from cellcolor.frontend import build_surface

CAP, SETUP, ARM, TOOL = "wok.toml", "ur5_polishing.toml", "ur5.urdf", "polishing_tool.urdf"


@pytest.fixture
def files(tmp_path: Path) -> Path:
    """A scene and everything that it names, in one folder."""
    for name in (SETUP, ARM, TOOL):
        shutil.copy(ROBOTS / name, tmp_path)
    (tmp_path / CAP).write_text(WOK.read_text().replace("../../models/robots/", ""))
    return tmp_path


NO_MESH = '[object]\nkind = "mesh"\nfile = "none.stl"\nmeters_per_unit = 1.0\n[placement]'
# The file that is edited, a pattern and its replacement; the file that is blamed, the field, and
# what is said.
FAULTS = [
    (CAP, r"seed = 1", "sed = 1", CAP, "object.sed", "unknown key"),
    (CAP, r"\[ground\]", "[floor]", CAP, "floor", "unknown key"),
    (CAP, r"radius_m = 0.20", "", CAP, "object.radius_m", "is missing"),
    (CAP, r"radius_m = 0.20", "radius_m = nan", CAP, "object.radius_m", "finite"),
    (CAP, r"radius_m = 0.20", "radius_m = inf", CAP, "object.radius_m", "finite"),
    (CAP, r"radius_m = 0.20", "radius_m = -0.2", CAP, "object.radius_m", "greater"),
    (CAP, r"radius_m = 0.20", 'radius_m = "0.2"', CAP, "object.radius_m", "number"),
    (CAP, r"half_angle_rad = 1\.", "half_angle_rad = 65.", CAP, "object.half_angle_rad",
     "65.1345 looks like degrees: 1.1368 rad"),
    (CAP, r"jitter = 0.15", "jitter = 0.6", CAP, "object.jitter", "less"),
    (CAP, r"target_vertices = 1000", "target_vertices = 20.5", CAP,
     "object.target_vertices", "integer"),
    (CAP, r'kind = "spherical-cap"', 'kind = "torus"', CAP, "object", "torus"),
    (CAP, r"rpy_rad = .*?\]", "rpy_rad = [0.0, 0.0]", CAP, "placement.rpy_rad[2]",
     "is missing"),
    (CAP, r"position_m = .*?\]", "position_m = [0.0, nan, 0.0]", CAP,
     "placement.position_m[1]", "finite"),
    (CAP, r"\[placement\].*?\[ground", "[ground", CAP, "placement", "is missing"),
    (CAP, r"$", '\n[[obstacle]]\nkind = "box"\nsize_m = [1.0, 1.0, 0.0]\n'
     "position_m = [0.0, 0.0, 0.0]", CAP, "obstacle[0].size_m[2]", "greater"),
    (CAP, r"$", '\n[[obstacle]]\nkind = "sphere"\nradius_m = 0.1\n', CAP,
     "obstacle[0].position_m", "is missing"),
    (CAP, r"\[placement\]", "[placement", CAP, None, "not TOML"),
    (CAP, r"\[object\].*?\[placement\]", NO_MESH, "none.stl", None, "no such mesh file"),
    (CAP, r'"ur5_polishing.toml"', '"none.toml"', "none.toml", None, "No such file"),
    (SETUP, r"normal_force_n", "normal_force", SETUP, "task.normal_force",
     "unknown key; is 'normal_force_n' meant?"),
    (CAP, r"\[placement\]", "[placment]", CAP, "placment",
     "unknown key; is 'placement' meant?"),
    (SETUP, r"base_step_rad = 0.1", "base_step_rad = 0.0", SETUP,
     "continuity.base_step_rad", "greater"),
    (SETUP, r"probe_spacing_m", "border_length_m = 0.01\nprobe_spacing_m", SETUP,
     "continuity.border_length_m", "no longer known: for exact borders give .* max_edge_m"),
    (SETUP, r'"ur5.urdf"', '"ur7.urdf"', "ur7.urdf", None, "No such file"),
    (SETUP, r'"tool_tip"', '"nose"', "polishing_tool.urdf", "link[nose]", "tip link"),
    (SETUP, r'"shoulder_link"\]', '"elbow"]', SETUP, "robot.may_touch_ground", "'elbow'"),
    (SETUP, r"$", "\n[constraints]\ncolision = false\n", SETUP, "constraints.colision", "unknown"),
    (SETUP, r"uncover_below_share = 0.005", "uncover_below_share = 2.0", SETUP,
     "slivers.uncover_below_share", "less than 1"),
    (CAP, r"\[0.465, -0.15, -0.04\]", "[0.0, 0.0, -0.12]", CAP, "placement", "'base_link'"),
    (CAP, r"$", '\n[[obstacle]]\nkind = "mesh"\nfile = "no.stl"\n'
     "meters_per_unit = 1.0\nposition_m = [0.0, 0.0, 0.0]\n", "no.stl", None, "no such mesh"),
    (CAP, r"\[object\].*?\[placement\]", NO_MESH.replace("1.0", "0.0"), CAP,
     "object.meters_per_unit", "greater"),
    (TOOL, 'xyz="0 0 0.1"', 'xyz="0 0 1.1"', TOOL, "link[tool_tip]", "m"),
    (ARM, '<cylinder radius="0.065" length="0.05"/>', '<mesh filename="package://nobody/b.stl"/>',
     ARM, "link[base_link].collision[0].mesh", "nobody"),
    (SETUP, '"wrist_3_link"', '"hand"', ARM, "link[hand]", "not in the arm"),
    (SETUP, r"joint_6_rad = 0.0", "joint_6_rad = 9.0", SETUP, "robot.locked_joint_6_rad",
     "outside the limits"),
]  # fmt: skip


@pytest.mark.parametrize(("file", "pattern", "replacement", "blamed", "field", "message"), FAULTS)
def test_faults_are_named(
    files: Path,
    file: str,
    pattern: str,
    replacement: str,
    blamed: str,
    field: str | None,
    message: str,
) -> None:
    edit(files / file, pattern, replacement)
    with pytest.raises(InputError, match=message) as caught:
        build_surface(files / CAP)
    assert (caught.value.file, caught.value.field) == (str(files / blamed), field)
    assert "\n" not in str(caught.value)


def edit(file: Path, pattern: str, replacement: str) -> None:
    text, found = re.subn(
        pattern, lambda _: replacement, file.read_text(), count=1, flags=re.DOTALL
    )
    assert found
    file.write_text(text)


def test_one_clear_line(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["build", str(files / CAP), "-o", str(files / "out.json")]
    edit(files / SETUP, '"wrist_3_link"', '"hand"')
    assert main(command) == 2
    printed = capsys.readouterr()
    (line,) = printed.err.splitlines()
    assert printed.out == "" and f"{files / ARM}: link[hand]" in line
    assert not list(files.glob("out*"))
    edit(files / SETUP, '"hand"', '"wrist_3_link"')
    assert main(command) == 0
    assert capsys.readouterr().err == ""
