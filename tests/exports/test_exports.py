"""Exports, read back by readers that have no part in writing them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BPoly
from stand_in import stand_in
from waves import driven

from cellcolor.data.trajectory import Trajectory, read_trajectory_csv
from cellcolor.errors import InputError
from cellcolor.exports.interface import PlannedMotion, stretches
from cellcolor.exports.registry import EXPORTS, exported
from examples import examples


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
    assert np.allclose(table.columns["time_s"], trajectory.times, atol=1e-9)
    assert np.array_equal(table.marked("contact"), trajectory.contact)
    assert np.array_equal(table.columns["segment"], trajectory.segment)


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


@given(st.integers(0, 10**6), st.sampled_from([0.004, 0.0133, 0.1]))
@examples(20)
def test_a_fixed_step_follows_the_cubic_between_samples(seed: int, step: float) -> None:
    planned = driven("ur5", seed)
    trajectory = planned.trajectory
    (own,), (judged,) = stretches(trajectory, step), stretches(trajectory)
    assert np.allclose(np.diff(own.times), step)
    assert 0 <= own.times[-1] - judged.times[-1] < step
    ends = np.stack([judged.joints, judged.velocities], axis=1)
    cubic = BPoly.from_derivatives(judged.times, ends)
    inside = np.minimum(own.times, judged.times[-1])
    assert np.allclose(own.joints, cubic(inside), atol=1e-9)
    assert np.allclose(own.velocities, cubic.derivative()(inside), atol=1e-7)
    straight = np.array([np.interp(inside, judged.times, j) for j in judged.joints.T]).T
    assert own.beside == pytest.approx(np.abs(own.joints - straight).max(), abs=1e-9)
    expected = np.interp(inside, judged.times, trajectory.contact) == 1
    assert np.array_equal(own.contact, expected)


def test_messages_have_the_fixed_step_and_accelerations() -> None:
    planned = driven("ur5", step_s=0.01)
    (message,) = yaml.safe_load_all(exported(planned)["joint_trajectory.yaml"])
    times = [
        point["time_from_start"]["sec"] * 10**9 + point["time_from_start"]["nanosec"]
        for point in message["points"]
    ]
    assert set(np.diff(times)) == {10_000_000}
    speeds = np.array([point["velocities"] for point in message["points"]])
    faster = np.array([point["accelerations"] for point in message["points"]])
    assert np.allclose(faster[1:-1], (speeds[2:] - speeds[:-2]) / 0.02, atol=1e-6)
    assert not faster[[0, -1]].any()
