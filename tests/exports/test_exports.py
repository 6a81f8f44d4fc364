"""Exports, read back by readers that have no part in writing them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from stand_in import stand_in

from cellcolor.data.trajectory import Trajectory, read_trajectory_csv
from cellcolor.errors import InputError
from cellcolor.exports.interface import PlannedMotion
from cellcolor.exports.registry import EXPORTS


@pytest.fixture(scope="module")
def planned() -> PlannedMotion:
    return PlannedMotion(stand_in().trajectory)


def content(name: str, planned: PlannedMotion) -> bytes:
    made: bytes = EXPORTS[name].content(planned)
    return made


def test_the_judge_reads_the_table_of_joints(planned: PlannedMotion, tmp_path: Path) -> None:
    (tmp_path / "joints.csv").write_bytes(content("joints.csv", planned))
    table, trajectory = read_trajectory_csv(tmp_path / "joints.csv"), planned.trajectory
    assert np.allclose(table.joints, trajectory.joints, atol=1e-9)
    assert np.allclose(table.times, trajectory.times, atol=1e-9)
    assert np.array_equal(table.contact, trajectory.contact)
    assert np.array_equal(table.segment, trajectory.segment)


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
