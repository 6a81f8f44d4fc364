"""``cellcolor new``: what it writes is read, stands where it can be reached, and is planned."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import dh_arms
import numpy as np
import pytest
import trimesh
from commands import run
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from shipped import ROBOTS

import cellcolor
from cellcolor.door.starting import _mount, arm_of
from cellcolor.errors import InputError
from cellcolor.frontend.arm.urdf import parse_urdf
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.scene import Scene
from cellcolor.motion.home import home_of
from cellcolor.motion.limits import motion_of

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def plate(tmp_path: Path) -> Path:
    """A plate of 160 x 120 mm with a low hump, in millimeters, as its file's origin has it."""
    x, y = np.meshgrid(np.linspace(300, 460, 17), np.linspace(-20, 100, 13), indexing="ij")
    z = 10 * np.exp(-((x - 380) ** 2 + (y - 40) ** 2) / 40**2)
    corner = (13 * np.arange(16)[:, None] + np.arange(12)).ravel()
    low = np.column_stack([corner, corner + 13, corner + 14])
    high = np.column_stack([corner, corner + 14, corner + 1])
    points = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    file = tmp_path / "plate.stl"
    trimesh.Trimesh(points, np.concatenate([low, high]), process=False).export(file)
    return file


@pytest.mark.parametrize(("arm", "family"), [("ur5", "ur"), ("kr6", "eaik")])
def test_family_flange_place_and_home_are_found(
    arm: str, family: str, plate: Path, tmp_path: Path
) -> None:
    made = cellcolor.new(plate, ROBOTS / f"{arm}.urdf", tmp_path / "new")
    assert {file.name for file in (tmp_path / "new").iterdir()} == {
        *("scene.toml", "setup.toml", "tool.urdf")
    }
    scene = Scene.read(made.scene)
    assert scene.setup.robot.kinematics == family
    assert scene.setup.robot.flange_link == {"ur5": "wrist_3_link", "kr6": "tool0"}[arm]
    prepared = prepare(scene)
    assert np.allclose(np.ptp(prepared.surface.vertices, axis=0)[:2], (0.16, 0.12))
    assert motion_of(prepared).home_rad is not None
    home_of(prepared, motion_of(prepared))
    built = cellcolor.build(scene)
    # It asked some of the vertices.
    whole = built.report.reachable / built.report.vertices
    assert made.reachable_share == pytest.approx(whole, abs=0.1)
    assert whole > 0.9


def test_links_that_overlap_in_every_posture_are_found_before_a_place_is_sought(
    plate: Path, tmp_path: Path
) -> None:
    """As of ros-industrial's IRB 2400, where the hull of the wrist's fork contains the flange."""
    ball = '<collision><geometry><sphere radius="0.09"/></geometry></collision>'
    arm = tmp_path / "kr6.urdf"
    text = (ROBOTS / "kr6.urdf").read_text()
    for link in ("link_4", "link_6"):
        text = text.replace(f'<link name="{link}">', f'<link name="{link}">{ball}')
    arm.write_text(text)
    made = cellcolor.new(plate, arm, tmp_path / "new")
    assert made.reachable_share > 0.5
    assert ("link_4", "link_6") in Scene.read(made.scene).setup.robot.may_touch
    assert any("link_4 and link_6 overlap" in note for note in made.notes)


@settings(deadline=None, max_examples=50)
@given(
    st.tuples(*[st.floats(-3.2, 3.2)] * 3),
    st.sampled_from(["0 0 0", "0.1 0 0", "-0.1 0.02 0"]),
)
def test_the_tool_is_turned_onto_the_last_axis(rpy: tuple[float, float, float], xyz: str) -> None:
    """Outward, whichever way the flange's own axes point."""
    text = (ROBOTS / "kr6.urdf").read_text()
    usual = '<origin xyz="0 0 0" rpy="0 1.570796326794897 0"/>'
    assert usual in text
    turned = " ".join(map(repr, rpy))
    text = text.replace(usual, f'<origin xyz="{xyz}" rpy="{turned}"/>')
    line = _mount(parse_urdf(text, Path("arm.urdf")), "tool0")
    mount = tomllib.loads(line).get("mount_rpy_rad", [0.0, 0.0, 0.0])
    tool = (Rotation.from_euler("xyz", rpy) * Rotation.from_euler("xyz", mount)).apply([0, 0, 1])
    outward = -1.0 if xyz.startswith("-") else 1.0
    assert np.allclose(tool, [outward, 0, 0], atol=2e-3)


def test_an_arm_with_an_offset_wrist_is_known(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(dh_arms.urdf("hc10"))
    assert json.loads(arm_of(file, None, "tip", tmp_path).keys["family"]) == "offset-wrist"


def test_ready_to_plan(plate: Path, tmp_path: Path, capsys: Capture) -> None:
    folder = tmp_path / "new"
    assert run("new", plate, ROBOTS / "ur5.urdf", "-o", folder) == 0
    said = capsys.readouterr().out
    assert f"next: cellcolor plan {folder / 'scene.toml'} -o {folder / 'plan'}" in said
    planned = cellcolor.plan(folder / "scene.toml", spacing_m=0.03)
    assert planned.verdict.valid, planned.verdict
    assert planned.trajectory.lift_offs == planned.solution.lift_offs


def test_only_its_own_files_are_replaced(plate: Path, tmp_path: Path, capsys: Capture) -> None:
    folder, arm = tmp_path / "new", ROBOTS / "ur5.urdf"
    assert run("new", plate, arm, "-o", folder) == 0
    first = {file: file.read_bytes() for file in folder.iterdir()}
    assert run("new", plate, arm, "-o", folder) == 0
    assert {file: file.read_bytes() for file in folder.iterdir()} == first
    (folder / "setup.toml").write_text("# mine\n")
    assert run("new", plate, arm, "-o", folder) == 2
    assert "setup.toml" in capsys.readouterr().err
    assert (folder / "setup.toml").read_text() == "# mine\n"


def test_what_cannot_be_used_is_one_line_and_nothing_is_written(
    plate: Path, tmp_path: Path, capsys: Capture
) -> None:
    scara = ROBOTS / "cobra600.urdf"
    faulty = tmp_path / "faulty.stl"
    faulty.write_text("solid\nendsolid\n")
    pinched = tmp_path / "pinched.obj"  # two triangles with one vertex in common
    corners = ("0 0 0", "90 0 0", "0 90 0", "-90 0 0", "0 -90 0")
    pinched.write_text("".join(f"v {at}\n" for at in corners) + "f 1 2 3\nf 1 4 5\n")
    arm = ROBOTS / "ur5.urdf"
    for part, urdf, options, named in (
        (plate, scara, [], "cobra600.urdf"),
        (plate, tmp_path / "none.urdf", [], "none.urdf"),
        (faulty, arm, [], "faulty.stl"),
        (pinched, arm, [], f"repair it first: cellcolor repair {pinched} -o pinched-repaired.obj"),
        (plate, arm, ["--unit", "m"], "the part is 160 x 120"),
    ):
        assert run("new", part, urdf, "-o", tmp_path / "new", *options) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert named in line
        assert not (tmp_path / "new").exists()
    assert run("new", plate, arm, "-o", tmp_path / "new", "--time-limit", "0.001") == 3
    assert not (tmp_path / "new").exists()


def test_a_part_out_of_reach_is_refused_with_the_commonest_reason(tmp_path: Path) -> None:
    """The inside of a pipe of 60 mm: the tool that is written is 100 mm long."""
    angle, height = np.meshgrid(np.linspace(0, 2 * np.pi, 12, endpoint=False), (0.0, 0.2))
    ring = np.column_stack(
        [0.03 * np.cos(angle).ravel(), 0.03 * np.sin(angle).ravel(), height.ravel()]
    )
    low = np.arange(12)
    onward = (low + 1) % 12
    inward = [
        np.column_stack(rows) for rows in ((low, 12 + low, onward), (onward, 12 + low, 12 + onward))
    ]
    pipe = tmp_path / "pipe.stl"
    trimesh.Trimesh(ring, np.concatenate(inward), process=False).export(pipe)
    message = "nothing of the part can be reached .* fails by 'object collision'"
    with pytest.raises(InputError, match=message) as caught:
        cellcolor.new(pipe, ROBOTS / "ur5.urdf", tmp_path / "new")
    assert caught.value.file == str(pipe)
    assert not (tmp_path / "new").exists()


def test_a_tool_of_ones_own(plate: Path, tmp_path: Path) -> None:
    tool = ROBOTS / "polishing_tool.urdf"
    made = cellcolor.new(
        plate, ROBOTS / "ur5.urdf", tmp_path / "new", tool=tool, tip_link="tool_tip"
    )
    assert not (tmp_path / "new" / "tool.urdf").exists()
    robot = Scene.read(made.scene).setup.robot
    assert (made.scene.parent / robot.tool_urdf).resolve() == tool
    with pytest.raises(InputError, match="tip link"):
        cellcolor.new(plate, ROBOTS / "ur5.urdf", tmp_path / "other", tool=tool)
