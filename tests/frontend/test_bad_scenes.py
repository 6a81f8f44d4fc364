"""Bad scenes, setups and meshes: one line with file and field, and exit code 2."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from dirty import BOX, OUTWARD, obj
from shipped import ROBOTS, WOK

from cellcolor.cli import main
from cellcolor.errors import InputError
from cellcolor.frontend import build_surface

SCENE, CAP, SETUP, ARM, TOOL, MESH = (
    "scene.toml",
    "wok.toml",
    "ur5_polishing.toml",
    "ur5.urdf",
    "polishing_tool.urdf",
    "part.obj",
)


@pytest.fixture
def files(tmp_path: Path) -> Path:
    """A scene with a mesh object, one with a cap, and everything they name, in one folder."""
    for name in (SETUP, ARM, TOOL):
        shutil.copy(ROBOTS / name, tmp_path)
    text = WOK.read_text().replace("../../models/robots/", "")
    table = f'[object]\nkind = "mesh"\nfile = "{MESH}"\nmeters_per_unit = 0.1\n\n'
    start, end = text.index("[object]"), text.index("[placement]")
    (tmp_path / SCENE).write_text(text[:start] + table + text[end:])
    (tmp_path / CAP).write_text(text)
    (tmp_path / MESH).write_text(obj(BOX, OUTWARD))
    return tmp_path


def mesh(vertices: object = BOX, faces: list[list[int]] = OUTWARD) -> tuple[str, str, str]:
    return MESH, r".*", obj(vertices, faces)


FLAT = np.vstack([BOX, [[0.5, 0, 0]]])
TWICE = np.vstack([BOX, BOX[:1]])
LIMIT = r'<limit lower="-6[^>]*effort="150"/>'
# name: (file, pattern, replacement), the file that is blamed, the field
CASES = {
    "mesh missing": ((SCENE, f'"{MESH}"', '"none.obj"'), "none.obj", None),
    "mesh format unknown": ((SCENE, f'"{MESH}"', f'"{ARM}"'), ARM, None),
    "mesh unreadable": ((MESH, r".*", "f 1 2 x\n"), MESH, None),
    "inverted normals": (mesh(faces=[f[::-1] for f in OUTWARD]), MESH, "faces"),
    "one face inverted": (mesh(faces=[OUTWARD[0][::-1], *OUTWARD[1:]]), MESH, "faces["),
    "non-manifold edge": (mesh(faces=[*OUTWARD, [0, 1, 6]]), MESH, "faces["),
    "two vertices at one place": (mesh(TWICE, [*OUTWARD[1:], [8, 1, 3]]), MESH, "vertices[8]"),
    "zero-area face": (mesh(FLAT, [[0, 8, 4], [0, 4, 8]]), MESH, "vertices"),
    "vertex without faces": (mesh(FLAT), MESH, "vertices[8]"),
    "no faces": (mesh(faces=[]), MESH, None),
    "coordinate not finite": (mesh(np.where(BOX > 0, np.inf, 0)), MESH, "line 2"),
    "object in the base": ((SCENE, r"\[0.465, -0.15, -0.04\]", "[0.0, 0.0, 0.0]"), SCENE,
                           "placement"),
    "obstacle without size": ((SCENE, r"$", '\n[[obstacle]]\nkind = "box"\n'), SCENE,
                              "obstacle[0].position_m"),
    "obstacle mesh missing": ((SCENE, r"$", '\n[[obstacle]]\nkind = "mesh"\nfile = "no.stl"\n'
                               "meters_per_unit = 1.0\nposition_m = [0.0, 0.0, 0.0]\n"),
                              "no.stl", None),
    "units of zero": ((SCENE, r"meters_per_unit = 0.1", "meters_per_unit = 0.0"), SCENE,
                      "object.meters_per_unit"),
    "switch misspelled": ((SETUP, r"$", "\n[constraints]\ncolision = false\n"), SETUP,
                          "constraints.colision"),
    "sliver share above one": ((SETUP, r"uncover_below_share = 0.005",
                                "uncover_below_share = 2.0"), SETUP,
                               "slivers.uncover_below_share"),
    "tool longer than the arm": ((TOOL, 'xyz="0 0 0.1"', 'xyz="0 0 1.1"'), TOOL,
                                 "link[tool_tip]"),
    "tool off the axis": ((TOOL, 'xyz="0 0 0.1"', 'xyz="0.05 0 0.1"'), ARM,
                          "joint[wrist_3_joint]"),
    "cone that Pinocchio drops": ((ARM, '<cylinder radius="0.065" length="0.05"/>',
                                   '<cone radius="0.065" length="0.05"/>'), ARM,
                                  "link[base_link].collision[0]"),
    "mesh of a link missing": ((ARM, '<cylinder radius="0.065" length="0.05"/>',
                      '<mesh filename="package://nobody/base.stl"/>'), ARM,
                     "link[base_link].collision[0].mesh"),
    "limits missing": ((ARM, LIMIT, '<limit effort="150" velocity="3"/>'), ARM,
                       "joint[shoulder_pan_joint].limit"),
    "mass missing": ((ARM, r'<mass value="3.7"/>', ""), ARM, "link[shoulder_link].inertial.mass"),
    "not XML": ((ARM, r"</robot>", ""), ARM, None),
    "flange missing": ((SETUP, '"wrist_3_link"', '"hand"'), ARM, "link[hand]"),
}  # fmt: skip

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


def test_the_scene_itself_is_good(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["build", str(files / SCENE), "-o", str(files / "out.json")]) == 0
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("name", CASES)
def test_one_clear_line(name: str, files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (file, pattern, replacement), blamed, field = CASES[name]
    edit(files / file, pattern, replacement)
    assert main(["build", str(files / SCENE), "-o", str(files / "out.json")]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    (line,) = printed.err.splitlines()
    assert str(files / blamed) in line
    assert field is None or f"{field}" in line
    assert not list(files.glob("out*"))
