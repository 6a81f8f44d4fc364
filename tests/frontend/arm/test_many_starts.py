"""The calibrated arm's solutions against Newton's method from many starts, and that held, too."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from bent_tools import tip_frame
from independent import set_distance, wrapped
from shipped import ROBOTS
from solution_sets import (
    JOINTS,
    KINDS,
    Arm,
    Compared,
    ManyStarts,
    each_once,
    estimated_missing,
    near_singular,
)

from cellcolor.arrays import Array, Index
from cellcolor.frontend.arm.signs import BRANCHES
from cellcolor.frontend.setup import Setup

pytestmark = pytest.mark.second

CALIBRATED = "ur5e_calibrated"


def arm(name: str = CALIBRATED) -> Arm:
    return Arm.of(Setup.read(ROBOTS / f"{name}_polishing.toml"))


def random_joints(count: int, seed: int) -> Array:
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (count, 6))


def compared(one: Arm, q: Array, starts: int) -> tuple[Compared, list[Index]]:
    """Both ways, and how often each solution was found, pose by pose, but those about to meet."""
    other = ManyStarts.of(one.robot.model)
    points, directions, _ = other.posed(q[:, :JOINTS])
    found = other.solutions(points, directions, starts, 8)
    hits = [each.hits[one.is_regular(each.joints)] for each in found]
    return one.held_against([each.joints for each in found], q), hits


# --- the method ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [CALIBRATED, "kr6"])
def test_poses_and_jacobians_are_pinocchios(name: str) -> None:
    model = arm(name).robot.model
    q = random_joints(50, 1)
    tip, tool, jacobian = ManyStarts.of(model).posed(q[:, :JOINTS])
    frame, data = model.getFrameId("tool_tip"), model.createData()
    for row, joints in enumerate(q):
        there = tip_frame(model, joints)
        assert np.abs(there.translation - tip[row]).max() < 1e-12
        assert np.abs(there.rotation[:, 2] - tool[row]).max() < 1e-12
        theirs = pin.computeFrameJacobian(
            model, data, joints, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )[:, :JOINTS]
        # The tool's axis moves by the cross product with the angular velocity.
        turned = np.cross(theirs[3:].T, tool[row]).T
        assert np.abs(jacobian[row] - np.vstack([theirs[:3], turned])).max() < 1e-12


@pytest.mark.parametrize("name", ["ur5e", "irb120"])
def test_it_finds_all_that_ssik_does(name: str) -> None:
    """Of arms with a closed form, of which there is another solver to say what all are."""
    from solution_sets import Ssik

    one, q = arm(name), random_joints(25, 2)
    ssik, other = Ssik(one.robot), ManyStarts.of(one.robot.model)
    points, directions, _ = other.posed(q[:, :JOINTS])
    found = other.solutions(points, directions, 120, 3)
    for each, point, direction in zip(found, points, directions, strict=True):
        theirs = one.regular(ssik.solutions(point, direction, 0.3))
        assert set_distance(one.regular(each.joints), theirs) < 1e-5


def test_equal_ends_are_counted_modulo_full_circles() -> None:
    one, other = np.linspace(-3, 3, JOINTS), np.zeros(JOINTS)
    full = 2 * np.pi * np.array([1, 0, -1, 0, 2])
    found = each_once(np.array([one, np.full(JOINTS, np.nan), other, one + full, one]))
    assert found.hits.tolist() == [3, 1]
    assert wrapped(found.joints - [one, other]).max() < 1e-12


def test_what_was_found_once_and_twice_tells_what_is_missing() -> None:
    """Of 100,000 kinds, drawn at random 150,000 times, exp(-1.5) of them are missing."""
    drawn = np.random.default_rng(4).integers(0, 100_000, 150_000)
    hits = np.bincount(drawn, minlength=100_000)
    missing = np.count_nonzero(hits == 0)
    assert abs(missing - 22_313) < 500  # Poisson
    assert abs(estimated_missing(hits[hits > 0]) - missing) < 0.03 * missing
    assert estimated_missing(np.full(9, 7)) == 0


# --- the calibrated arm -------------------------------------------------------------------------


def test_the_calibrated_arm_has_the_same_solutions() -> None:
    found, hits = compared(arm(), random_joints(40, 5), 150)
    assert found.different == 0 and found.solutions > 5 * found.poses
    often = np.concatenate(hits)
    assert often.min() >= 3 and estimated_missing(often) == 0


@pytest.mark.slow
def test_the_calibrated_arm_has_the_same_solutions_of_five_thousand_poses() -> None:
    found, hits = compared(arm(), random_joints(5000, 6), 240)
    # One pose has ten solutions, and branches are eight.
    crowded = sum(len(each) > len(BRANCHES) for each in hits)
    assert found.different == crowded <= 1 and found.solutions > 5 * found.poses
    assert estimated_missing(np.concatenate(hits)) < 0.5


@pytest.mark.parametrize("kind", KINDS)
def test_the_calibrated_arm_loses_none_next_to_a_singularity(kind: str) -> None:
    one = arm()
    for off in (1e-2, 1e-4, 1e-7, 0.0):
        q = near_singular(one.robot, one.family.reach, kind, off, 2)
        assert one.is_regular(q[:, :JOINTS]).all() == (off == 1e-2)
        assert compared(one, q, 120)[0].different == 0


def test_a_lost_solution_of_the_calibrated_arm_is_noticed() -> None:
    """One branch left out is a difference at every pose that has it."""
    one = arm()
    solve = one.family.solve

    def without_the_first(points: Array, directions: Array) -> Array:
        return solve(points, directions)[:, 1:]

    one.family.solve = without_the_first  # type: ignore[method-assign, assignment]
    assert compared(one, random_joints(8, 5), 100)[0].different > 3


def test_next_to_an_aligned_wrist_solutions_are_all_round_the_circle() -> None:
    """There the ideal arm's are elsewhere, and the true one may have more than there are names."""
    one = arm()
    q = random_joints(20_000, 7)
    q[:, 4] = np.random.default_rng(7).uniform(-0.002, 0.002, len(q))
    own = q[one.is_regular(q[:, :JOINTS])][:200]
    # One in eight was lost before the ideal arm was asked for poses around as well.
    assert len(own) == 200 and one.lost(own, within=1e-5) <= 4
