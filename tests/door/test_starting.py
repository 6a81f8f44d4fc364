"""``cellcolor new``: what it writes is read, stands where it can be reached, and is planned."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

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
import cellcolor.door.starting
from cellcolor.data.candidate_table import VALID
from cellcolor.door.starting_arm import arm_of, mount_of
from cellcolor.errors import InputError
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.urdf import parse_urdf
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.scene import Scene
from cellcolor.motion.limits import home_of, motion_of
from cellcolor.motion.posture import joint_room

Capture = pytest.CaptureFixture[str]


def first_is_quick(*rows: Any) -> list[Any]:
    """Parameters of a test that takes seconds; all but the first wait for the second stage."""
    return [rows[0], *(pytest.param(*row, marks=pytest.mark.second) for row in rows[1:])]


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


@pytest.mark.parametrize(("arm", "family"), first_is_quick(("kr6", "eaik"), ("ur5", "ur")))
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


@pytest.mark.second
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
    _, mount = mount_of(parse_urdf(text, Path("arm.urdf")), "tool0")
    tool = (Rotation.from_euler("xyz", rpy) * Rotation.from_euler("xyz", mount)).apply([0, 0, 1])
    outward = -1.0 if xyz.startswith("-") else 1.0
    assert np.allclose(tool, [outward, 0, 0], atol=2e-3)


@pytest.mark.second
def test_a_flange_measured_beside_the_last_axis_is_moved_onto_it(
    plate: Path, tmp_path: Path
) -> None:
    """As in KUKA's KR 210 L150 of ROS-Industrial, whose flange is 0.24 mm off."""
    text = (ROBOTS / "kr6.urdf").read_text()
    usual = '<origin xyz="0 0 0" rpy="0 1.570796326794897 0"/>'
    arm = tmp_path / "arm.urdf"
    arm.write_text(text.replace(usual, usual.replace("0 0 0", "0.03 0 -0.00024", 1)))
    scene = Scene.read(cellcolor.new(plate, arm, tmp_path / "new").scene)
    assert scene.setup.robot.mount_position_m == pytest.approx((-0.00024, 0, 0))


def test_an_arm_with_an_offset_wrist_is_known(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(dh_arms.urdf("hc10"))
    keys, _ = arm_of(file, None, "tip", tmp_path, {})
    assert json.loads(keys["family"]) == "offset-wrist"


@pytest.mark.second
def test_ready_to_plan(plate: Path, tmp_path: Path, capsys: Capture) -> None:
    folder = tmp_path / "new"
    assert run("new", plate, ROBOTS / "ur5.urdf", "-o", folder) == 0
    said = capsys.readouterr().out
    assert f"next: cellcolor plan {folder / 'scene.toml'} -o {folder / 'plan'}" in said
    planned = cellcolor.plan(folder / "scene.toml", spacing_m=0.03)
    assert planned.verdict.valid, planned.verdict
    assert planned.trajectory.lift_offs == planned.solution.lift_offs


@pytest.mark.second
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
    long = tmp_path / "long.urdf"  # its lengths are in millimeters
    numbers = r'<origin xyz="(\S+) (\S+) (\S+)"'
    text = (ROBOTS / "ur5.urdf").read_text()
    long.write_text(re.sub(numbers, r'<origin xyz="\1e3 \2e3 \3e3"', text))
    pinched = tmp_path / "pinched.obj"  # two triangles with one vertex in common
    corners = ("0 0 0", "90 0 0", "0 90 0", "-90 0 0", "0 -90 0")
    pinched.write_text("".join(f"v {at}\n" for at in corners) + "f 1 2 3\nf 1 4 5\n")
    arm = ROBOTS / "ur5.urdf"
    for part, urdf, options, named in (
        (plate, scara, [], "cobra600.urdf"),
        (plate, tmp_path / "none.urdf", [], "none.urdf"),
        (plate, long, [], "long.urdf: robot: the arm reaches"),
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


def new(capsys: Capture, part: Path, arm: Path, folder: Path, *options: str) -> str:
    """What the command says, with exit code 0."""
    assert run("new", part, arm, "-o", folder, *options) == 0
    return capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "flipped", "faces"),
    first_is_quick(
        (("--outside", "flip"), True, "up"),
        ((), False, "down"),
        (("--outside", "toward"), True, "up"),
        (("--outside", "away"), False, "down"),
    ),
)
def test_a_sheet_wound_inside_out(
    options: tuple[str, ...],
    flipped: bool,
    faces: str,
    plate: Path,
    tmp_path: Path,
    capsys: Capture,
) -> None:
    sheet = tmp_path / "inverted.stl"
    mesh = trimesh.load_mesh(plate)
    mesh.invert()
    mesh.export(sheet)
    said = new(capsys, sheet, ROBOTS / "ur5.urdf", tmp_path / "new", *options)
    assert f"its outside faces {faces}" in said
    assert ("the object's outside faces down" in said) == (faces == "down")
    scene = Scene.read(tmp_path / "new" / "scene.toml")
    assert scene.object.flip == flipped
    assert (prepare(scene).surface.normals[:, 2].mean() > 0) == (faces == "up")


@pytest.mark.second
def test_a_sheet_wound_half_each_way(plate: Path, tmp_path: Path, capsys: Capture) -> None:
    """What inspect and repair say of it, new says as well."""
    mesh = trimesh.load_mesh(plate)
    mesh.faces[::2] = mesh.faces[::2, ::-1]
    half = tmp_path / "half.stl"
    mesh.export(half)
    said = new(capsys, half, ROBOTS / "ur5.urdf", tmp_path / "new")
    assert "192 faces turned to wind like those around" in said
    assert f"cellcolor repair {half}" in said
    assert Scene.read(tmp_path / "new" / "scene.toml").object.repair


@pytest.mark.second
def test_the_part_is_not_put_too_near(plate: Path, tmp_path: Path) -> None:
    """At the nearest place where all is reached, the wrist is 0.23 rad from being straight."""
    made = cellcolor.new(plate, ROBOTS / "kr6.urdf", tmp_path / "new")
    prepared = prepare(made.scene)
    home = np.array(motion_of(prepared).home_rad)
    assert made.reachable_share == 1 and joint_room(prepared.robot, home) > 0.5
    assert abs(np.sin(home[4])) > 0.5


def shell(folder: Path) -> Path:
    """A closed sheet of 200 x 200 x 2 mm."""
    box = trimesh.creation.box((200, 200, 2))
    box.export(folder / "shell.stl")
    return folder / "shell.stl"


@pytest.mark.parametrize(
    ("options", "side"),
    first_is_quick(((), "up"), (("--outside", "away"), "down"), (("--cover", "all"), "both")),
)
def test_one_side_of_a_shell(
    options: tuple[str, ...], side: str, tmp_path: Path, capsys: Capture
) -> None:
    said = new(capsys, shell(tmp_path), ROBOTS / "ur5.urdf", tmp_path / "new", *options)
    assert f"faces {side}, is covered" in said or (side == "both" and "both sides" in said)
    normals = prepare(Scene.read(tmp_path / "new" / "scene.toml")).surface.normals
    along = {"up": [1], "down": [-1], "both": [-1, 1]}[side]
    assert np.unique(np.round(normals[np.abs(normals[:, 2]) > 0.99, 2])).tolist() == along


@pytest.mark.second
def test_the_largest_piece_of_a_block(tmp_path: Path, capsys: Capture) -> None:
    trimesh.creation.box((200, 150, 100)).export(tmp_path / "block.stl")
    said = new(
        capsys, tmp_path / "block.stl", ROBOTS / "ur5.urdf", tmp_path / "new", "--cover", "largest"
    )
    assert "the largest piece between sharp edges is covered" in said
    surface = prepare(Scene.read(tmp_path / "new" / "scene.toml")).surface
    assert surface.mesh.areas.sum() == pytest.approx(0.2 * 0.15)


@pytest.mark.second
def test_a_large_part_gets_a_mesh_of_some_thousand_vertices(
    tmp_path: Path, capsys: Capture
) -> None:
    """A door of 1 m^2 with edges of 10 mm has 40,000 vertices, and its build takes half an hour."""
    trimesh.creation.box((1000, 900, 50)).export(tmp_path / "door.stl")
    said = new(capsys, tmp_path / "door.stl", ROBOTS / "ur5.urdf", tmp_path / "new")
    found = re.search(r"its mesh has ([\d,]+) vertices, with edges up to", said)
    assert found and 1500 < int(found[1].replace(",", "")) < 5000


def test_a_closed_part_has_its_outside(tmp_path: Path, capsys: Capture) -> None:
    trimesh.creation.icosphere(2, 100).export(tmp_path / "ball.stl")
    arm = ROBOTS / "ur5.urdf"
    folder = tmp_path / "new"
    assert run("new", tmp_path / "ball.stl", arm, "-o", folder, "--outside", "flip") == 2
    assert "--outside: the part is closed" in capsys.readouterr().err
    assert not folder.exists()


@pytest.fixture
def on_rail(tmp_path: Path) -> Path:
    """The UR5 on a rail of 3 m along y."""
    file = tmp_path / "rail.urdf"
    rail = (
        '<link name="rail"/><joint name="rail_joint" type="prismatic"><parent link="rail"/>'
        '<child link="base_link"/><axis xyz="0 1 0"/>'
        '<limit lower="-1.5" upper="1.5" velocity="1" effort="1000"/></joint>'
    )
    text = (ROBOTS / "ur5.urdf").read_text()
    file.write_text(text.replace('<robot name="ur5">', f'<robot name="ur5">{rail}', 1))
    assert "rail_joint" in file.read_text()
    return file


@pytest.mark.parametrize(
    ("options", "at"), first_is_quick((("--fix", "rail_joint=0.4"), 0.4), ((), 0.0))
)
def test_an_arm_on_a_rail_stands_still(
    options: tuple[str, ...],
    at: float,
    plate: Path,
    on_rail: Path,
    tmp_path: Path,
    capsys: Capture,
) -> None:
    said = new(capsys, plate, on_rail, tmp_path / "new", *options)
    assert f"rail_joint stands still at {at:g}" in said
    scene = Scene.read(tmp_path / "new" / "scene.toml")
    assert scene.setup.robot.fixed_joints == {"rail_joint": at}
    vertices = prepare(scene).surface.vertices
    assert (vertices.min(axis=0) + vertices.max(axis=0))[1] / 2 == pytest.approx(at)


@pytest.mark.parametrize(
    ("fix", "message"),
    [
        ("rail_joint=4", "4 is outside the joint's limits"),
        ("rail=0.4", "robot.fixed_joints.rail: no such joint"),
        ("rail_joint", "'rail_joint' is not JOINT=POSITION"),
        ("rail_joint=nan", "'rail_joint=nan' is not JOINT=POSITION"),
        (
            "shoulder_pan_joint=0.2",
            "has 5: --fix shoulder_pan_joint makes a joint of the arm itself stand still",
        ),
    ],
)
def test_a_joint_that_cannot_stand_there(
    fix: str, message: str, plate: Path, on_rail: Path, tmp_path: Path, capsys: Capture
) -> None:
    assert run("new", plate, on_rail, "-o", tmp_path / "new", "--fix", *fix.split()) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "new").exists()


@pytest.mark.second
def test_under_an_arm_that_hangs(plate: Path, tmp_path: Path) -> None:
    """The part lies below its base, not above the ground far below."""
    text = (ROBOTS / "ur5.urdf").read_text()
    hung = '<joint name="hung" type="fixed"><parent link="roof"/><child link="base_link"/>'
    hung += '<origin xyz="0 0 3" rpy="3.14159265 0 0"/></joint><link name="roof"/></robot>'
    arm = tmp_path / "arm.urdf"
    arm.write_text(text.replace("</robot>", hung))
    made = cellcolor.new(plate, arm, tmp_path / "new")
    assert made.reachable_share > 0.9
    assert 1.9 < Scene.read(made.scene).placement.position_m[2] < 2.7


@pytest.mark.parametrize(
    ("yaw", "turned"), first_is_quick((90, True), (180, False), (-90, True), (0, True))
)
def test_an_upright_part_is_turned_to_the_robot(
    yaw: float, turned: bool, plate: Path, tmp_path: Path, capsys: Capture
) -> None:
    mesh = trimesh.load_mesh(plate)
    mesh.apply_transform(trimesh.transformations.euler_matrix(0, np.pi / 2, np.radians(yaw)))
    mesh.export(tmp_path / "upright.stl")
    printed = new(capsys, tmp_path / "upright.stl", ROBOTS / "ur5.urdf", tmp_path / "new")
    assert ("turned by" in printed) == turned
    normals = prepare(Scene.read(tmp_path / "new" / "scene.toml")).surface.normals
    assert np.allclose(normals.mean(axis=0)[[0, 1]], [-1, 0], atol=0.1)


def test_the_home_is_over_the_part_and_well_conditioned(plate: Path, tmp_path: Path) -> None:
    made = cellcolor.new(plate, ROBOTS / "ur5e.urdf", tmp_path / "new")
    prepared = prepare(made.scene)
    home = np.array([motion_of(prepared).home_rad])
    assert prepared.judge(home).reasons[0] == VALID  # which asks for conditioning too
    poses = forward(prepared.robot, home)
    off = np.linalg.norm(prepared.surface.vertices - poses.tip[0], axis=1).min()
    assert off == pytest.approx(0.1, abs=0.01)
    # Of the four postures that cover the plate, the one that does not lean back over the base.
    assert abs(home[0, 0]) < np.pi / 2
    assert any("100 mm over the part" in note for note in made.notes)


@pytest.mark.second
def test_without_room_over_the_part_the_arm_begins_anywhere(
    plate: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cellcolor.door.starting, "home_over", lambda *_: None)
    made = cellcolor.new(plate, ROBOTS / "ur5.urdf", tmp_path / "new")
    assert any("none over the part is free" in note for note in made.notes)
    prepared = prepare(made.scene)
    assert home_of(prepared, motion_of(prepared)) is not None


@pytest.mark.second
def test_a_tool_of_ones_own(plate: Path, tmp_path: Path) -> None:
    tool = ROBOTS / "polishing_tool.urdf"
    made = cellcolor.new(
        plate, ROBOTS / "ur5.urdf", tmp_path / "new", tool=tool, tip_link="tool_tip"
    )
    assert not (tmp_path / "new" / "tool.urdf").exists()
    robot = Scene.read(made.scene).setup.robot
    assert (made.scene.parent / robot.tool_urdf).resolve() == tool
    bare = tmp_path / "bare.urdf"
    bare.write_text(re.sub("<inertial>.*?</inertial>", "", tool.read_text(), flags=re.DOTALL))
    made = cellcolor.new(
        plate, ROBOTS / "ur5.urdf", tmp_path / "bare", tool=bare, tip_link="tool_tip"
    )
    assert not Scene.read(made.scene).setup.constraints.force
    with pytest.raises(InputError, match="tip link"):
        cellcolor.new(plate, ROBOTS / "ur5.urdf", tmp_path / "other", tool=tool)
