"""Any arm that EAIK solves: solutions by forward kinematics, names, refusals."""

from __future__ import annotations

import sys

import dh_arms
import numpy as np
import pytest
from dh_arms import LOCKED
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.errors import InputError
from cellcolor.frontend.arm.eaik import EaikKinematics
from cellcolor.frontend.arm.kinematics import forward, task_determinant
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.signs import BRANCHES
from examples import examples

pytestmark = pytest.mark.second

NAMED = ("kr6", "irb120", "puma560", "ur5e")
NAMELESS = ("passing", "cuspidal")


ROBOTS = {name: dh_arms.robot(dh_arms.urdf(name)) for name in (*NAMED, *NAMELESS)}
FAMILIES = {name: EaikKinematics(robot, LOCKED) for name, robot in ROBOTS.items()}


@given(
    name=st.sampled_from(NAMED),
    seed=st.integers(0, 2**32 - 1),
    steps=st.integers(20, 60),
)
@examples(20)
def test_names_stay_the_same_without_a_singularity(name: str, seed: int, steps: int) -> None:
    """On the straight way between two configurations, wherever no determinant is near zero."""
    random = np.random.default_rng(seed)
    first, last = random.uniform(-np.pi, np.pi, (2, 6))
    fine = first + np.linspace(0, 1, 50 * steps)[:, None] * (last - first)
    poses = forward(ROBOTS[name], fine)
    determinant = task_determinant(poses)
    # Where it is so large that it cannot have been zero between two points: it changes by less
    # than its largest difference.
    clear = determinant > 2 * np.abs(np.diff(determinant)).max()
    signs = FAMILIES[name]._solution.signs
    assert signs is not None
    branches, _ = signs.branches(ROBOTS[name], fine)
    together = clear[1:] & clear[:-1]
    assert (branches[1:][together] == branches[:-1][together]).all()


def test_branch_names_mean_what_they_say() -> None:
    # Tool down on points in front of the arm, where all eight branches exist.
    random = np.random.default_rng(8)
    turn, out = random.uniform(-1.0, 1.0, 50), random.uniform(0.35, 0.45, 50)
    points = np.column_stack([out * np.cos(turn), out * np.sin(turn), random.uniform(0.2, 0.3, 50)])
    found = FAMILIES["irb120"].solve(points, np.tile([0.0, 0.0, -1.0], (50, 1)))
    assert not np.isnan(found).any()
    robot = ROBOTS["irb120"]
    for branch, name in enumerate(BRANCHES):
        poses = forward(robot, found[:, branch])
        shoulder, elbow, wrist = (poses.origin[:, frame] for frame in (2, 3, 5))
        # Shoulder front: leaning forwards by a positive angle of joint 2, from upright at -90.
        forwards = np.stack([np.cos(found[:, branch, 0]), np.sin(found[:, branch, 0])], axis=1)
        front = ((wrist[:, :2] * forwards).sum(axis=1)) > 0
        assert (front == ("shoulder-front" in name)).all()
        chord = wrist - shoulder
        share = ((elbow - shoulder) * chord).sum(1) / (chord * chord).sum(1)
        above = elbow[:, 2] > (shoulder + share[:, None] * chord)[:, 2]
        assert (above == ("elbow-up" in name)).all()
        # At zero of joint 5 the tool goes on in the direction of the forearm.
        assert ((found[:, branch, 4] > 0) == ("wrist-unflipped" in name)).all()


def refused(robot: Robot, **keys: object) -> InputError:
    with pytest.raises(InputError) as caught:
        EaikKinematics(robot, LOCKED.varied(**keys))
    assert "\n" not in str(caught.value)
    return caught.value


def test_an_arm_without_closed_form_is_refused_with_the_way_out() -> None:
    error = refused(dh_arms.robot(dh_arms.urdf("crx10ia")))
    assert (error.file, error.field) == ("arm.urdf", "robot")
    assert "no closed form" in error.message and "own solver" in error.message


@pytest.mark.parametrize(
    ("locked", "message"), [(None, "is missing"), (7.0, "outside the limits of the sixth joint")]
)
def test_the_locked_joint_is_needed(locked: float | None, message: str) -> None:
    error = refused(ROBOTS["kr6"], locked_joint_6_rad=locked)
    assert error.field == "robot.locked_joint_6_rad" and message in error.message.lower()


def test_without_the_package_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "eaik.IK_HP", None)
    error = refused(ROBOTS["kr6"])
    assert error.field == "robot.kinematics"
    assert "extra 'arms'" in error.message and "own solvers" in error.message


@pytest.mark.parametrize("name", (*NAMED, *NAMELESS))
def test_out_of_reach_there_is_nothing(name: str) -> None:
    down = np.array([[0.0, 0.0, -1.0]])
    for place in ([9.0, 0.0, 0.0], [1e6, 0.0, 0.0]):
        assert np.isnan(FAMILIES[name].solve(np.array([place]), down)).all()
    assert len(FAMILIES[name].solve(np.empty((0, 3)), np.empty((0, 3)))) == 0
