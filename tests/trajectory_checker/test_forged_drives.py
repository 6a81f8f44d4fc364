"""Forged drives are refused, and what only looks different is not."""

from __future__ import annotations

import sys
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
import rasters
from forged_drives import FORGERS
from honest_drives import HONEST, Honest, resampled
from hypothesis import given
from hypothesis import strategies as st
from motions import planned
from shipped import TOP

import cellcolor
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.trajectory_checker.check import check_trajectory
from cellcolor.trajectory_checker.joint_motion import corners
from examples import examples

sys.path.append(str(TOP / "benchmarks"))
import judge

pytestmark = pytest.mark.second

NOT_HERE = (
    "begins in motion",  # the raster has no way to the part
    "ends in motion",
    "a row doubled 0.1 s later at full speed",  # it is so slow that the arm can stop
    "10% of a stroke dropped",  # so little is never missed on this part
)
# What some of them are called by the judge; the others are told by several kinds.
KINDS = {
    "a joint three turns farther": "joint limit",
    "a jump by a full circle": "jump",
    "a stretch twice": "repeated",
    "a part of a stroke in another branch": "branch",
    "a stroke dropped": "uncovered",
    "points off by 0.01": "pose",
    "two columns of joints exchanged": "pose",
    "time backwards": "time",
}


@cache
def cap() -> Honest:
    """A raster in two strokes; that it needs them is only said here."""
    prepared, _, trajectory = rasters.cap()
    return Honest(prepared, trajectory, 1)


def judged(trajectory: Trajectory) -> TrajectoryVerdict:
    _, built, _ = rasters.cap()
    return check_trajectory(built, trajectory, minimum_lift_offs=1)


@pytest.mark.parametrize("name", HONEST)
def test_honest_drives_stay_valid(name: str) -> None:
    assert judged(HONEST[name](cap())).faults == ()


@pytest.mark.parametrize("name", [name for name in FORGERS if name not in NOT_HERE])
def test_forged_drives_are_refused(name: str) -> None:
    verdict = judged(FORGERS[name](cap(), np.random.default_rng(3)))
    assert not verdict.valid
    assert name not in KINDS or KINDS[name] in verdict.fault_counts


@pytest.mark.slow
@pytest.mark.parametrize("name", FORGERS)
def test_forged_plans_are_refused(name: str) -> None:
    made = planned("wok_obstacle", 1000)
    honest = Honest(made.prepared, made.plan.trajectory, made.lift_offs)
    for seed in range(3):
        forged = FORGERS[name](honest, np.random.default_rng(seed))
        verdict = check_trajectory(made.built, forged, minimum_lift_offs=made.lift_offs)
        assert not verdict.valid, seed


@pytest.mark.second
def test_the_campaign_says_what_was_accepted(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Also a sort that changes nothing, and one that finds nothing to forge."""

    def nothing(*_: object) -> Trajectory:
        raise LookupError

    prepared, built, trajectory = rasters.cap()
    made = SimpleNamespace(prepared=prepared, built=built, trajectory=trajectory)
    made.solution = SimpleNamespace(lift_offs=1)
    monkeypatch.setattr(cellcolor, "plan", lambda _: made)
    monkeypatch.setattr(judge, "SCENES", ("cap",))
    monkeypatch.setattr(judge, "HONEST", {"as it is": HONEST["as it is"]})
    few = {name: FORGERS[name] for name in ("a move not planned", "time backwards")}
    monkeypatch.setattr(judge, "FORGERS", few)
    assert judge.main(["2"]) == 0
    out = capsys.readouterr().out
    assert "honest: 1 of 1 accepted" in out and "a stroke dropped: 2 of 2 refused" in out
    assert "| all 2 | 2 | 2 |" in out
    same = {"none": FORGERS["10% of a stroke dropped"], "same": lambda h, _: h.trajectory}
    monkeypatch.setattr(judge, "FORGERS", same)
    assert judge.main(["4"]) == 1
    out = capsys.readouterr().out
    assert out.count("not refused: same, draw ") == 2 and "draw 1" in out and "draw 3" in out
    assert "| none | 0 | 0 |" in out and "| all 2 | 2 | 0 |" in out


def test_the_proved_minimum_is_held_against_the_drive() -> None:
    """One lift-off fewer contradicts the proof; one more is a fault unless it is stated."""
    _, built, trajectory = rasters.cap()
    for minimum, said in ((0, "proved to be enough"), (2, "contradicts the proved minimum of 2")):
        verdict = check_trajectory(built, trajectory, minimum_lift_offs=minimum)
        (fault,) = verdict.faults
        assert fault.kind == "lift-offs"
        assert said in fault.text


def test_a_dragged_tip_is_found_and_covers_nothing() -> None:
    trajectory = rasters.cap()[2]
    none = np.zeros(len(trajectory.times), dtype=bool)
    verdict = judged(replace(trajectory, contact=none))
    assert len(verdict.of_kind("dragged")) == 2
    assert verdict.covered is not None
    assert verdict.covered.covered_share == 0.0


@pytest.mark.slow
@pytest.mark.parametrize("most", [0.02, 0.005])
def test_denser_samples_change_no_verdict(most: float) -> None:
    assert judged(resampled(cap().trajectory, most)).faults == ()
    fast = FORGERS["all 10 times as fast"](cap(), np.random.default_rng(0))
    coarse, dense = judged(fast), judged(resampled(fast, most / 10))
    assert set(coarse.fault_counts) == set(dense.fault_counts)


def test_the_tool_keeps_the_speed_of_the_setup() -> None:
    prepared, built, trajectory = rasters.cap()
    points = np.linalg.norm(np.diff(trajectory.points, axis=0), axis=1)
    together = trajectory.contact[1:] & trajectory.contact[:-1]
    fastest = float((points / np.diff(trajectory.times))[together].max())
    for share, valid in ((1.02, True), (0.97, False)):
        setup = prepared.setup.varied(motion={"speed_m_per_s": share * fastest})
        scene = replace(prepared, scene=prepared.scene.with_setup(setup))
        verdict = check_trajectory(replace(built, prepared=scene), trajectory)
        assert verdict.valid == valid
        if not valid:
            assert "the tool moves at" in verdict.faults[0].text


@examples(30)
@given(seed=st.integers(0, 10_000), pieces=st.integers(1, 30))
def test_corners_are_those_of_the_line(seed: int, pieces: int) -> None:
    """Points put into a polygon's sides are left out again, and none of its corners is."""
    random = np.random.default_rng(seed)
    count = int(random.integers(2, 12))
    times = np.cumsum(random.uniform(0.01, 0.2, count))
    joints = np.cumsum(random.choice([-1.0, 1.0], (count, 2)) * random.uniform(0.01, 1, (count, 2)),
                       axis=0)  # fmt: skip
    at = np.unique(np.concatenate([times, random.uniform(times[0], times[-1], pieces)]))
    dense = np.stack([np.interp(at, times, column) for column in joints.T], axis=1)
    found = at[corners(at, dense)]
    slopes = np.diff(joints, axis=0) / np.diff(times)[:, None]
    bends = np.abs(np.diff(slopes, axis=0)).max(axis=1, initial=0.0) > 0.1
    assert set(times[1:-1][bends]) <= set(found)
    assert set(found) <= set(times)
