"""Forged drives are refused, and what only looks different is not."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import rasters
from forged_drives import FORGERS
from honest_drives import HONEST, Honest
from motions import planned

from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.trajectory_checker.check import check_trajectory

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
    honest = Honest(made.built.prepared, made.trajectory, made.solution.lift_offs)
    for seed in range(3):
        forged = FORGERS[name](honest, np.random.default_rng(seed))
        verdict = check_trajectory(made.built, forged, minimum_lift_offs=made.solution.lift_offs)
        assert not verdict.valid, seed


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
