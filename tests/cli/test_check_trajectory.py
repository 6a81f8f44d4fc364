"""``check`` on trajectories, from the shell and from Python."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import rasters
from commands import run
from documents import TRAJECTORY
from library import PAPER
from shipped import ROBOTS, SCENES, edited

import cellcolor
from cellcolor.data.trajectory import ExtraLiftOff, Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """The scene of ``rasters.square`` as a file."""
    text = (SCENES / "square.toml").read_text(encoding="utf-8")
    for key, value in (
        ("size_x_m", "0.16"),
        ("size_y_m", "0.12"),
        ("target_vertices", "300"),
        ("setup", f'"{(ROBOTS / "ur5_polishing.toml").as_posix()}"'),
    ):
        text = edited(text, **{key: value})
    path = tmp_path / "square.toml"
    path.write_text(text, encoding="utf-8")
    return path


def stated(trajectory: Trajectory) -> Trajectory:
    """The raster lifts off once, which the square does not need, and says so."""
    sample = trajectory.strokes[0][1] - 1
    extra = ExtraLiftOff(sample, 0, "half way", "", tuple(trajectory.points[sample]))
    return replace(trajectory, extra_lift_offs=(extra,))


def table(path: Path, trajectory: Trajectory) -> Path:
    """Joints, contact and the extra lift-off alone, with six decimals."""
    extra = {stated.sample for stated in trajectory.extra_lift_offs}
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream)
        joints = [f"q{k + 1}" for k in range(trajectory.joints.shape[1])]
        writer.writerow(["contact", *joints, "extra_lift_off"])
        for number, row in enumerate(trajectory.joints):
            cells = [f"{value:.6f}" for value in row]
            writer.writerow([int(trajectory.contact[number]), *cells, int(number in extra)])
    return path


def test_a_valid_one(scene: Path, tmp_path: Path, capsys: Capture) -> None:
    trajectory = stated(rasters.square()[2])
    path = tmp_path / "t.json"
    path.write_text(trajectory.to_json(), encoding="utf-8")
    assert run("check", scene, path) == 0
    printed = capsys.readouterr().out
    assert printed.startswith(f"{path}: valid\n  2 strokes, 1 lift-off, ")
    assert "fewest lift-offs on this surface, proved: 0; 1 more announced, 0 more not" in printed
    assert "within 15 mm of a pass 100.00%" in printed
    other = table(tmp_path / "t.csv", trajectory)
    assert run("check", scene, other, "--json") == 0
    document = json.loads(capsys.readouterr().out)
    assert document.pop("file") == str(other)
    verdict = TrajectoryVerdict.from_document(document)
    assert (verdict.timed, verdict.lift_offs, verdict.minimum_lift_offs) == (False, 1, 0)


def test_one_with_faults(scene: Path, tmp_path: Path, capsys: Capture) -> None:
    trajectory = rasters.square()[2]
    joints = trajectory.joints.copy()
    joints[500:, 4] += 2 * np.pi
    path = tmp_path / "t.json"
    path.write_text(replace(trajectory, joints=joints).to_json(), encoding="utf-8")
    assert run("check", scene, path) == 1
    printed = capsys.readouterr().out
    assert printed.startswith(f"{path}: not valid, ")
    assert "  jump: samples 499 to 500 at " in printed
    assert "wrist_2_joint moves by 6.28" in printed
    verdict = cellcolor.check(scene, path)
    assert isinstance(verdict, TrajectoryVerdict)
    assert [fault.sample for fault in verdict.of_kind("jump")] == [499]
    # As values, without the extra lift-off stated.
    verdict = cellcolor.check(rasters.square()[1], trajectory)
    assert (verdict.minimum_lift_offs, set(verdict.fault_counts)) == (0, {"lift-offs"})


def test_bad_input(scene: Path, tmp_path: Path, capsys: Capture) -> None:
    def refused(subject: Path, path: Path, *parts: str) -> None:
        assert run("check", subject, path) == 2
        printed = capsys.readouterr()
        assert printed.out == ""
        assert printed.err.count("\n") == 1
        for part in (str(path), *parts):
            assert part in printed.err

    path = tmp_path / "t.csv"
    path.write_text("contact,q1\n1,x\n", encoding="utf-8")
    refused(scene, path, "line 2, column q1", "is not a number")
    path.write_text("contact,q1\n1,0\n", encoding="utf-8")
    refused(scene, path, "line 1", "there are 1 joints, the arm has 6")
    refused(scene, tmp_path / "none.csv", "No such file")
    other = tmp_path / "t.json"
    other.write_text(json.dumps(TRAJECTORY), encoding="utf-8")
    refused(scene, other, "joint_names", "must be shoulder_pan_joint")
    other.write_text(json.dumps(TRAJECTORY | {"times": [0, 1]}), encoding="utf-8")
    refused(scene, other, "joints", "has 3 entries for 2 times")
    other.write_text(rasters.square()[2].to_json(), encoding="utf-8")
    assert run("check", PAPER / "ring.surface.json", other) == 2
    assert "has an arm" in capsys.readouterr().err


def test_the_time_limit(scene: Path, tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "t.json"
    path.write_text(rasters.square()[2].to_json(), encoding="utf-8")
    assert run("check", scene, path, "--time-limit", "0.001", "--json") == 3
    printed = capsys.readouterr()
    assert "unknown: the time limit came" in printed.err
    assert "unknown" in json.loads(printed.out)["error"]
