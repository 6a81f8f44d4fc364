"""What a trajectory states of itself: parts left out, stretches passed twice, further lift-offs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import rasters
from forged_drives import FORGERS
from honest_drives import Honest

from cellcolor.data.trajectory import (
    ExtraLiftOff,
    LeftOut,
    RepeatedStretch,
    Trajectory,
    read_trajectory_csv,
)
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.exports.joint_files import joints_csv
from cellcolor.frontend.prepared import prepare
from cellcolor.trajectory_checker.check import check_trajectory
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.stated import completed, judge_lift_offs


def judged(trajectory: Trajectory, **options: Any) -> TrajectoryVerdict:
    _, built, _ = rasters.cap()
    return check_trajectory(built, trajectory, **options)


def driven_twice() -> Trajectory:
    """The raster with one stretch gone back and over again."""
    prepared, _, trajectory = rasters.cap()
    return FORGERS["a stretch twice"](Honest(prepared, trajectory, 1), np.random.default_rng(5))


def test_an_extra_lift_off_has_to_be_there() -> None:
    trajectory = rasters.cap()[2]
    first, after = trajectory.strokes[0]
    middle = (first + after) // 2
    stated = ExtraLiftOff(middle, 0, "winding", "", (0.0, 0.0, 0.0))
    verdict = judged(replace(trajectory, extra_lift_offs=(stated,)))
    assert [(fault.kind, fault.sample) for fault in verdict.faults] == [("claim", middle)]


def test_what_is_left_out_without_a_cause_is_uncovered() -> None:
    """The second segment is stated to be left out, and its branch is valid there."""
    trajectory = rasters.cap()[2]
    place = tuple(trajectory.points[trajectory.segment == 1][200].tolist())
    stated = (LeftOut(0, 0.01, "torque", place),)
    missing = replace(
        trajectory, contact=trajectory.contact & (trajectory.segment != 1), left_out=stated
    )
    verdict = judged(missing)
    assert verdict.covered is not None
    assert verdict.covered.left_out_share == 0.0
    assert verdict.of_kind("uncovered")


def test_what_is_rightly_left_out_is_not_uncovered() -> None:
    """The same with an arm that is too weak anywhere: then nothing is valid there."""

    prepared, built, trajectory = rasters.cap()
    scene = prepared.scene
    weak = prepare(scene.with_setup(scene.setup.varied(task={"normal_force_n": 1e4})))
    missing = replace(
        trajectory,
        contact=trajectory.contact & (trajectory.segment != 1),
        left_out=(LeftOut(0, 0.01, "torque", (0.0, 0.0, 0.0)),),
    )
    verdict = check_trajectory(replace(built, prepared=weak), missing)
    assert verdict.covered is not None
    assert verdict.covered.left_out_share > 0.3
    assert not verdict.of_kind("uncovered")
    unstated = check_trajectory(replace(built, prepared=weak), replace(missing, left_out=()))
    assert unstated.of_kind("uncovered")


def test_a_repeated_stretch_may_be_stated() -> None:
    """All of it, or it is a fault as far as it is not stated."""
    planted = driven_twice()
    (fault,) = judged(planted).of_kind("repeated")
    assert fault.sample is not None
    assert fault.last_sample is not None
    whole = RepeatedStretch(fault.sample, fault.last_sample, "narrow")
    verdict = judged(replace(planted, repeated=(whole,)))
    assert verdict.valid
    assert verdict.covered is not None
    assert verdict.covered.stated_repeated_m == pytest.approx(verdict.covered.repeated_m, rel=0.01)
    part = RepeatedStretch(fault.sample, fault.sample + 60, "narrow")
    (rest,) = judged(replace(planted, repeated=(part,))).of_kind("repeated")
    assert rest.sample == pytest.approx(fault.sample + 61, abs=2)
    assert rest.last_sample == fault.last_sample


@pytest.mark.second
def test_a_table_says_what_the_trajectory_states(tmp_path: Path) -> None:
    """A stretch twice is valid where it is stated; so it is in the table of the same motion."""
    prepared, again = rasters.cap()[0], driven_twice()
    (fault,) = judged(again).of_kind("repeated")
    extra = ExtraLiftOff(again.strokes[0][1] - 1, 0, "winding", "", (0.0, 0.0, 0.0))
    assert fault.sample is not None
    assert fault.last_sample is not None
    stated = replace(
        again,
        repeated=(RepeatedStretch(fault.sample, fault.last_sample, "on purpose"),),
        extra_lift_offs=(extra,),
        unplanned=(3,),
    )
    file = tmp_path / "joints.csv"
    file.write_bytes(joints_csv(SimpleNamespace(trajectory=stated)))  # type: ignore[arg-type]
    read = completed(read_trajectory_csv(file), prepared.robot)
    assert [(r.sample, r.last_sample) for r in read.repeated] == [
        (r.sample, r.last_sample) for r in stated.repeated
    ]
    assert [e.sample for e in read.extra_lift_offs] == [extra.sample]
    assert read.unplanned == (3,)
    as_file, as_table = judged(stated), judged(read, silent=True)
    assert as_file.fault_counts == as_table.fault_counts
    assert "repeated" not in as_table.fault_counts


@pytest.mark.parametrize(
    ("segments", "faults"), [((), 1), ((0,), 1), ((7,), 0), ((7, 8), 0)], ids=str
)
def test_a_whole_segment_left_out_allows_one_fewer(segments: tuple[int, ...], faults: int) -> None:
    """Three segments are needed for all of the surface, and the drive has two of them.

    With the third stated as left out it is no contradiction. A part of a segment that is driven
    makes no difference.
    """
    drive = rasters.cap()[2]
    assert drive.lift_offs == 1
    assert 0 in drive.segment[drive.contact] and 7 not in drive.segment
    left_out = tuple(LeftOut(number, 1e-5, "ground", (0.0, 0.0, 0.0)) for number in segments)
    found = FaultList(replace(drive, left_out=left_out, extra_lift_offs=()), drive.points)
    judge_lift_offs(2, found)
    assert found.counts["lift-offs"] == faults
