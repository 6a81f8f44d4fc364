"""Exports, read back by readers that have no part in writing them."""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
import yaml
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation
from stand_in import stand_in

from cellcolor.data.tool_paths import ToolPath
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_csv import read_trajectory_csv
from cellcolor.errors import InputError
from cellcolor.exports.interface import PlannedMotion
from cellcolor.exports.registry import EXPORTS

FILLS = ("#77AADD", "#EE8866")


@pytest.fixture(scope="module")
def planned() -> PlannedMotion:
    made = stand_in()
    surface, segment_of = made.painted.surface, made.painted.segment_of.copy()
    segment_of[-3:] = -1  # as where nothing is reached
    return PlannedMotion(surface, segment_of, FILLS, made.paths, made.trajectory)


def content(name: str, planned: PlannedMotion) -> bytes:
    made: bytes = EXPORTS[name].content(planned)
    return made


def test_the_table_of_joints_is_the_trajectory(planned: PlannedMotion) -> None:
    trajectory = planned.trajectory
    text = content("joints.csv", planned).decode()
    head, *rows = csv.reader(io.StringIO(text))
    assert ",".join(head[:-3]) == "time_s,segment,contact,x,y,z,nx,ny,nz,q1,q2,q3,q4,q5,q6"
    assert head[-3:] == ["repeated", "unplanned", "extra_lift_off"]
    columns = np.array(rows, dtype=float)[:, :-3]
    expected = [trajectory.times[:, None], trajectory.segment[:, None]]
    expected += [trajectory.contact[:, None], trajectory.points, trajectory.normals]
    assert np.allclose(columns, np.concatenate([*expected, trajectory.joints], axis=1), atol=1e-9)
    assert {row[2] for row in rows} == {"0", "1"}


def test_poses_stand_on_the_surface_and_look_ahead(planned: PlannedMotion) -> None:
    segments = yaml.safe_load(content("tool_paths.yaml", planned))
    assert len(segments) == len(FILLS)
    for number, paths in enumerate(segments):
        own = [path for path in planned.paths.paths if path.segment == number]
        assert len(paths) == len(own)
        for poses, path in zip(paths, own, strict=True):
            places = np.array([[pose[key] for key in "xyz"] for pose in poses])
            turns = Rotation.from_quat([[pose[f"q{key}"] for key in "xyzw"] for pose in poses])
            assert np.allclose(places, path.points, atol=1e-8)
            assert np.allclose(turns.as_matrix()[:, :, 2], path.normals, atol=1e-7)
            ahead = np.sum(turns.as_matrix()[:-1, :, 0] * np.diff(path.points, axis=0), axis=1)
            assert (ahead > 0).all()


def test_the_judge_reads_the_table_of_joints(planned: PlannedMotion, tmp_path: Path) -> None:
    (tmp_path / "joints.csv").write_bytes(content("joints.csv", planned))
    table, trajectory = read_trajectory_csv(tmp_path / "joints.csv"), planned.trajectory
    assert np.allclose(table.joints, trajectory.joints, atol=1e-9)
    assert np.allclose(table.times, trajectory.times, atol=1e-9)
    assert np.array_equal(table.contact, trajectory.contact)
    assert np.array_equal(table.segment, trajectory.segment)


@given(
    arrays(np.float64, (6, 3), elements=st.floats(-1, 1, width=16)),
    arrays(np.float64, (6, 3), elements=st.floats(-1, 1, width=16)),
)
def test_any_path_has_proper_poses(points: np.ndarray, normals: np.ndarray) -> None:
    """Points may coincide, and steps may go along the normal."""
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.where(lengths > 0.1, normals / np.maximum(lengths, 0.1), [0.0, 0.0, 1.0])
    path = ToolPath(0, 0, points, normals, [0] * 5)
    made = stand_in()
    paths = replace(made.paths, paths=(path,))
    planned = PlannedMotion(
        made.painted.surface, made.painted.segment_of, FILLS, paths, made.trajectory
    )
    ((poses,), empty) = yaml.safe_load(content("tool_paths.yaml", planned))
    assert empty == []
    quaternions = np.array([[pose[f"q{key}"] for key in "xyzw"] for pose in poses])
    assert np.allclose(np.linalg.norm(quaternions, axis=1), 1, atol=1e-7)
    axes = Rotation.from_quat(quaternions).as_matrix()[:, :, 2]
    assert np.allclose(axes, normals, atol=1e-6)


def test_a_message_ends_where_a_move_was_not_planned(planned: PlannedMotion) -> None:
    trajectory = replace(planned.trajectory, unplanned=(2, 40))
    text = content("joint_trajectory.yaml", replace(planned, trajectory=trajectory))
    messages = list(yaml.safe_load_all(text))
    assert [len(message["points"]) for message in messages] == [3, 38, len(trajectory.times) - 41]
    first = 0
    for message in messages:
        assert message["joint_names"] == list(trajectory.joint_names)
        times = [
            point["time_from_start"]["sec"] + 1e-9 * point["time_from_start"]["nanosec"]
            for point in message["points"]
        ]
        rows = slice(first, first + len(times))
        assert np.allclose(times, trajectory.times[rows] - trajectory.times[first], atol=1e-8)
        positions = np.array([point["positions"] for point in message["points"]])
        assert np.allclose(positions, trajectory.joints[rows], atol=1e-8)
        velocities = np.array([point["velocities"] for point in message["points"]])
        assert not velocities[[0, -1]].any()
        # A parabola through three samples has this slope in the middle one.
        for row in range(1, len(times) - 1):
            own = slice(row - 1, row + 2)
            fitted = np.polyfit(np.array(times[own]) - times[row], positions[own], 2)[1]
            assert np.allclose(velocities[row], fitted, atol=1e-5)
        first += len(times)
    assert first == len(trajectory.times)


def test_no_message_goes_back_in_time(planned: PlannedMotion) -> None:
    made = planned.trajectory
    times = made.times.copy()
    times[5] = times[4]
    with pytest.raises(InputError, match=r"times\[5\]"):
        content("joint_trajectory.yaml", replace(planned, trajectory=replace(made, times=times)))


def test_a_trajectory_without_samples_is_a_file_without_messages(planned: PlannedMotion) -> None:
    none = np.empty((0, 3))
    made = Trajectory("empty", ("a",), [], np.empty((0, 1)), none, none, [], [])
    text = content("joint_trajectory.yaml", replace(planned, trajectory=made))
    assert list(yaml.safe_load_all(text)) == []


@pytest.mark.parametrize("suffix", ["ply", "glb"])
def test_meshes_have_the_colors_of_the_segments(suffix: str, planned: PlannedMotion) -> None:
    data = io.BytesIO(content(f"painted.{suffix}", planned))
    mesh = trimesh.load(data, file_type=suffix, process=False)
    if suffix == "glb":
        # As a viewer shows it, +y up: the scene's z is the height.
        world = mesh.to_mesh().vertices
        assert np.allclose(world[:, 1], planned.surface.vertices[:, 2], atol=1e-6)
        mesh = next(iter(mesh.geometry.values()))
    assert np.allclose(mesh.vertices, planned.surface.vertices, atol=1e-6)
    assert np.array_equal(mesh.faces, planned.surface.faces)
    colors = np.asarray(mesh.visual.vertex_colors)
    for segment, fill in [(0, (0x77, 0xAA, 0xDD)), (1, (0xEE, 0x88, 0x66)), (-1, (0xDD,) * 3)]:
        own = colors[planned.segment_of == segment]
        assert len(own)
        assert (own[:, :3] == fill).all()
