"""Closed-form inverse kinematics against forward kinematics."""

from __future__ import annotations

import dh_arms
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from independent import wrapped
from scipy.spatial.transform import Rotation

from cellcolor.arrays import Array
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.ur import BRANCHES, UrGeometry, solve_inverse, ur_geometry
from examples import examples

LOCKED = 0.4


@given(
    st.lists(st.floats(-3.1, 3.1), min_size=5, max_size=5).filter(
        lambda q: abs(np.sin(q[4])) > 1e-3 and abs(np.sin(q[2])) > 1e-3
    )
)
def test_every_configuration_is_among_the_solutions_of_its_pose(
    robot: Robot, geometry: UrGeometry, five: list[float]
) -> None:
    q = np.array([*five, LOCKED])
    poses = forward(robot, q[None])
    found = solve_inverse(geometry, poses.tip, poses.tool_axis, LOCKED)[0]
    # At a straight shoulder both branches meet, and half of the digits are lost.
    assert np.nanmin(np.where(np.isnan(found), np.inf, wrapped(found - q)).max(axis=1)) < 1e-5


def test_branch_names_mean_what_they_say(robot: Robot, geometry: UrGeometry) -> None:
    # Tool down on points in front of the robot, where all eight branches exist.
    random = np.random.default_rng(8)
    turn, out = random.uniform(-np.pi, np.pi, 50), random.uniform(0.35, 0.5, 50)
    points = np.column_stack([out * np.cos(turn), out * np.sin(turn), random.uniform(0, 0.2, 50)])
    found = solve_inverse(geometry, points, np.tile([0.0, 0.0, -1.0], (50, 1)), LOCKED)
    assert not np.isnan(found).any()
    for branch, name in enumerate(BRANCHES):
        poses = forward(robot, found[:, branch])
        shoulder, elbow, wrist = (poses.origin[:, frame] for frame in (2, 3, 5))
        # The upper arm's middle line runs beside the base axis: seen from above, left of the
        # way out to the wrist or right of it.
        beside = poses.rotation[:, 2, :, 2] * 0.13585
        left = wrist[:, 0] * beside[:, 1] - wrist[:, 1] * beside[:, 0] > 0
        assert (left == ("shoulder-left" in name)).all()
        # Above the straight line from shoulder to wrist 1, or below it.
        chord = poses.origin[:, 4] - shoulder
        share = ((elbow - shoulder) * chord).sum(1) / (chord * chord).sum(1)
        above = elbow[:, 2] > (shoulder + share[:, None] * chord)[:, 2]
        assert (above == ("elbow-up" in name)).all()
        assert ((found[:, branch, 4] < 0) == ("wrist-flipped" in name)).all()


def arm_with_frames(lengths: Array, signs: list[int], turns: list[float]) -> Robot:
    """A UR-type arm whose joints turn in given senses and count from given zeros."""
    d1, a2, a3, d4, d5, d6 = lengths
    half = np.pi / 2
    origins = [
        (0, 0, d1, 0),
        (0, 0, 0, half),
        (-a2, 0, 0, 0),
        (-a3, 0, d4, 0),
        (0, -d5, 0, half),
        (0, d6, 0, -half),
    ]
    placements = np.tile(np.eye(4), (7, 1, 1))
    counted = [turns[0], 0, turns[1], turns[2], 0, 0]
    for place, (*xyz, roll), turn in zip(placements, origins, counted, strict=False):
        place[:3, :3] = Rotation.from_euler("xyz", [roll, 0, turn]).as_matrix()
        place[:3, 3] = xyz
    before, *after = dh_arms.urdf_of(list(placements)).split('<axis xyz="0 0 1"/>')
    axes = [f'<axis xyz="0 0 {sign}"/>' for sign in (*signs, 1)]
    return dh_arms.robot("".join([before, *map("".join, zip(axes, after, strict=True))]))


@given(
    signs=st.lists(st.sampled_from([1, -1]), min_size=6, max_size=6),
    turns=st.lists(st.floats(-3, 3), min_size=3, max_size=3),
    seed=st.integers(0, 2**32 - 1),
)
@examples(12)
def test_frames_of_another_urdf_do_not_matter(
    signs: list[int], turns: list[float], seed: int
) -> None:
    random = np.random.default_rng(seed)
    lengths = random.uniform(0.05, 0.5, 6)
    plain = arm_with_frames(lengths, [1] * 6, [0.0] * 3)
    arm = arm_with_frames(lengths, signs, turns)
    q = random.uniform(-np.pi, np.pi, (40, 6))
    poses = forward(arm, q)
    found = solve_inverse(ur_geometry(arm), poses.tip, poses.tool_axis, LOCKED)
    q[:, 5] = LOCKED
    near = np.where(np.isnan(found), np.inf, wrapped(found - q[:, None])).max(axis=2).min(axis=1)
    assert near.max() < 1e-4
    # The same links in the same places under the same branch names, whatever the joints count.
    expected = solve_inverse(ur_geometry(plain), poses.tip, poses.tool_axis, LOCKED)
    solved = ~np.isnan(found[:, :, 0])
    assert (solved == ~np.isnan(expected[:, :, 0])).all()
    ours, theirs = forward(arm, found[solved]), forward(plain, expected[solved])
    assert np.allclose(ours.origin[:, 1:], theirs.origin[:, 1:], atol=1e-4)
