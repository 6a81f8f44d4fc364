"""Planned motions, held against Pinocchio and against differences of samples."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from bent_tools import tip_frames
from scipy.spatial import cKDTree
from shipped import ROBOTS, shipped, with_keys

import cellcolor
from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.prepared import prepare
from cellcolor.motion.limits import motion_of
from cellcolor.motion.plan import plan_motion
from cellcolor.motion.small_triangles import ArmRefusals
from cellcolor.tool_paths.refused import Codes
from cellcolor.trajectory_checker.check import check_trajectory

pytestmark = pytest.mark.second


@pytest.fixture(scope="module", params=["half_pipe", "wok_obstacle"])
def motion(request: pytest.FixtureRequest) -> cellcolor.PlannedScene:
    """A motion with one lift-off, and one with two around an obstacle."""
    scene = shipped(request.param, 500)
    return cellcolor.plan(scene, spacing_m=0.02)


def test_the_tip_is_where_the_trajectory_says_and_the_tool_goes_against_the_normal(
    motion: cellcolor.PlannedScene,
) -> None:
    trajectory = motion.trajectory
    points, axes, _ = tip_frames(motion.built.robot.model, trajectory.joints)
    assert np.abs(points - trajectory.points).max() < 1e-6
    assert np.abs(axes + trajectory.normals).max() < 1e-6


def test_in_contact_the_tip_is_on_the_tool_path(motion: cellcolor.PlannedScene) -> None:
    trajectory, paths = motion.trajectory, motion.paths.paths
    for first, end in trajectory.strokes:
        path = next(p for p in paths if p.segment == trajectory.segment[first])
        # The path as points 0.1 mm apart: a sample that lies on it has one within half of that.
        lengths = np.linalg.norm(np.diff(path.points, axis=0), axis=1)
        total = np.concatenate([[0.0], np.cumsum(lengths)])
        at = np.append(np.arange(0.0, total[-1], 1e-4), total[-1])
        dense = np.column_stack([np.interp(at, total, path.points[:, axis]) for axis in range(3)])
        assert cKDTree(dense).query(trajectory.points[first:end])[0].max() < 0.6e-4
        # And the whole path is passed: a sample for each of its points within half a step.
        away, _ = cKDTree(trajectory.points[first:end]).query(dense)
        assert away.max() < 0.6e-3


@pytest.mark.parametrize("motion", ["wok_obstacle"], indirect=True)
def test_the_tool_touches_at_the_approach_speed(motion: cellcolor.PlannedScene) -> None:
    setup = motion.built.prepared.setup.varied(motion={"approach_speed_m_per_s": 0.004})
    prepared = prepare(motion.built.prepared.scene.with_setup(setup))
    built = replace(motion.built, prepared=prepared)
    slow = plan_motion(built, motion.painted).trajectory
    for trajectory, within in ((slow, True), (motion.trajectory, False)):
        steps = np.linalg.norm(np.diff(trajectory.points, axis=0), axis=1)
        speed = steps / np.diff(trajectory.times)
        touching = trajectory.contact[1:] != trajectory.contact[:-1]
        assert touching.sum() == 2 * len(trajectory.strokes)
        assert (speed[touching].max() <= 0.004 * (1 + 1e-9)) == within
        verdict = check_trajectory(built, trajectory)
        assert ("velocity" in verdict.fault_counts) != within


def test_lift_offs_are_the_proved_minimum_and_all_transfers_are_planned(
    motion: cellcolor.PlannedScene,
) -> None:
    trajectory = motion.trajectory
    assert motion.verdict.valid
    assert trajectory.lift_offs == motion.solution.lift_offs
    assert trajectory.extra_lift_offs == ()
    assert trajectory.unplanned == ()


@pytest.mark.parametrize("motion", ["wok_obstacle"], indirect=True)
def test_the_same_scene_and_seed_give_the_same_trajectory(motion: cellcolor.PlannedScene) -> None:
    again = plan_motion(motion.built, motion.painted)
    assert again.trajectory == motion.trajectory
    assert again.paths == motion.paths


def test_segments_overlap_where_both_colors_are_valid() -> None:
    """One segment is covered 30 mm beyond the border, or both together are that far.

    The outermost pass is half a spacing inside of that. The corner with the largest share of a
    triangle tells to which segment a place belongs.
    """
    scene = shipped("half_pipe", 500)
    keys = {"spacing_m": 0.01, "overlap_m": 0.03}
    motion = cellcolor.plan(scene.with_setup(with_keys(scene.setup, **keys)))
    drive, mesh = motion.trajectory, motion.painted.surface.mesh
    corners = mesh.points[mesh.corners]
    shares = np.random.default_rng(0).dirichlet([1.0, 1.0, 1.0], 60)
    points = np.einsum("kc,mcd->mkd", shares, corners).reshape(-1, 3)
    vertex = mesh.corners[:, shares.argmax(axis=1)].ravel()
    segment_of = motion.painted.segment_of[vertex]
    farthest = []
    for segment in range(2):
        samples = drive.points[drive.contact & (drive.segment == segment)]
        beyond = cKDTree(points[segment_of == segment]).query(samples)[0]
        farthest.append(beyond.max())
    assert 0.018 < sum(farthest) < 0.035
    assert motion.verdict.valid


def test_a_setup_without_a_motion_and_one_that_does_not_fit_are_refused() -> None:
    scene = shipped("square", 100)
    for change, where in (
        ({"motion": None}, "motion"),
        ({"motion": {"home_rad": [0.0] * 5}}, "motion.home_rad"),
        ({"motion": {"home_rad": [7.0, 0.0, 0.0, 0.0, 0.0, 0.0]}}, "motion.home_rad[0]"),
        ({"motion": {"joint_accelerations_rad_per_s2": [1.0]}}, "accelerations"),
        ({"motion": {"retract_m": 0.01}}, "motion.retract_m"),
    ):
        prepared = prepare(scene.with_setup(scene.setup.varied(**change)))
        with pytest.raises(InputError, match=re.escape(where)):
            motion_of(prepared)


@pytest.mark.slow
def test_an_arm_of_continuous_joints_without_masses_and_velocities() -> None:
    """As many vendors describe theirs: of what is missing a plan needs the velocities."""
    text = (ROBOTS / "ur5.urdf").read_text()
    text = re.sub(r"<inertial>.*?</inertial>|<limit [^>]*/>", "", text, flags=re.DOTALL)
    text = text.replace('type="revolute"', 'type="continuous"')
    square = shipped("square", 200)
    setup = square.setup.varied(robot={"arm_urdf": text}, constraints={"force": False})
    with pytest.raises(InputError, match="joint_velocities_rad_per_s") as caught:
        cellcolor.plan(square.with_setup(setup))
    assert caught.value.field == "joint[shoulder_pan_joint].limit.velocity"
    setup = setup.varied(motion={"joint_velocities_rad_per_s": [3.0] * 6})
    planned = cellcolor.plan(square.with_setup(setup))
    assert planned.verdict.valid
    assert re.search(r'"lower":\s*\[null', planned.page().decode())  # JSON knows no infinity


def test_where_no_path_can_be_followed_it_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(asked: ArmRefusals, points: Array, _normals: Array) -> Codes:
        return np.full(len(points), asked.names.index("object collision"), dtype=np.uint8)

    monkeypatch.setattr(ArmRefusals, "__call__", refuse)
    with pytest.raises(InputError, match=r"no path .* 100% \(object collision\); try a finer mesh"):
        cellcolor.plan(shipped("square", 100))
