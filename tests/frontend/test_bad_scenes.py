"""Bad scenes and meshes through the command line: exit code 2 and one line with file and field."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from dirty import BOX, OUTWARD, obj
from shipped import ROBOTS, WOK

from cellcolor.cli import main

SCENE, SETUP, ARM, TOOL, MESH = (
    "scene.toml",
    "ur5_polishing.toml",
    "ur5.urdf",
    "polishing_tool.urdf",
    "part.obj",
)


@pytest.fixture
def files(tmp_path: Path) -> Path:
    """A scene with a mesh object and everything it names, in one folder."""
    for name in (SETUP, ARM, TOOL):
        shutil.copy(ROBOTS / name, tmp_path)
    text = WOK.read_text().replace("../../models/robots/", "")
    table = f'[object]\nkind = "mesh"\nfile = "{MESH}"\nmeters_per_unit = 0.1\n\n'
    start, end = text.index("[object]"), text.index("[placement]")
    (tmp_path / SCENE).write_text(text[:start] + table + text[end:])
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
    "not TOML": ((SCENE, r"name = ", "name "), SCENE, None),
    "setup missing": ((SCENE, f'"{SETUP}"', '"none.toml"'), "none.toml", None),
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


def test_there_are_twenty() -> None:
    assert len(CASES) >= 20


def test_the_scene_itself_is_good(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["build", str(files / SCENE), "-o", str(files / "out.json")]) == 0
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("name", CASES)
def test_one_clear_line(name: str, files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (file, pattern, replacement), blamed, field = CASES[name]
    text, found = re.subn(
        pattern,
        lambda _: replacement,
        (files / file).read_text(),
        count=1,
        flags=re.DOTALL,
    )
    assert found
    (files / file).write_text(text)
    assert main(["build", str(files / SCENE), "-o", str(files / "out.json")]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    (line,) = printed.err.splitlines()
    assert str(files / blamed) in line
    assert field is None or f"{field}" in line
    assert not list(files.glob("out*"))
