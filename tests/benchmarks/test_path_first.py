"""The fewest changes of branch along a path, and the fewest strokes that an arm can follow."""

from __future__ import annotations

import itertools
import sys
from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from shipped import TOP, shipped

from cellcolor.arrays import Array, Mask
from cellcolor.frontend import build_surface

sys.path.append(str(TOP / "benchmarks"))
from path_first import accepted, counted, fewest_lift_offs, fewest_strokes
from raster import Raster

ROWS = st.lists(st.lists(st.booleans(), min_size=3, max_size=3).filter(any), min_size=1, max_size=6)
LOWER, UPPER, JUMP = np.array([-4.0, -7.0]), np.array([4.0, 7.0]), 2.2


@given(ROWS)
def test_no_choice_of_branches_changes_less_often(valid: list[list[bool]]) -> None:
    """Against every choice of one valid branch for each point."""
    choices = itertools.product(*[[b for b in range(3) if row[b]] for row in valid])
    changes = (sum(a != b for a, b in itertools.pairwise(choice)) for choice in choices)
    assert fewest_lift_offs(np.array(valid)) == min(changes)


def path(samples: int, starts: list[int]) -> Raster:
    """So many samples; where they are does not matter."""
    return Raster(np.zeros((samples, 3)), np.zeros((samples, 3)), np.array([0, *starts]))


def can_follow(joints: Array) -> bool:
    """Whether unwound angles (k, 2) exist: every start turn and every turn of a step is tried."""
    for column, low, high in zip(joints.T, LOWER, UPPER, strict=True):
        turns = 2 * np.pi * np.arange(-4, 5)
        here = {a for a in (column[0] + turns).tolist() if low <= a <= high}
        for angle in column[1:]:
            here = {
                a
                for a in (angle + turns).tolist()
                if low <= a <= high and any(abs(a - b) <= JUMP for b in here)
            }
        if not here:
            return False
    return True


def least(joints: Array, valid: Mask, starts: set[int]) -> int:
    """The fewest strokes over all ways to cut the path, by dynamic programming."""
    count = len(valid)
    best = [0] + [count + 1] * count
    for end in range(1, count + 1):
        if not valid[end - 1].any():
            best[end] = best[end - 1]
        for begin in range(end):
            if starts & set(range(begin + 1, end)):
                continue
            for branch in range(valid.shape[1]):
                if valid[begin:end, branch].all() and can_follow(joints[begin:end, branch]):
                    best[end] = min(best[end], best[begin] + 1)
    return best[count]


@given(
    st.lists(
        st.lists(
            st.tuples(
                st.booleans(), st.sampled_from([-3.0, -1.5, 0.0, 1.0, 2.5]), st.floats(-3, 3)
            ),
            min_size=2,
            max_size=2,
        ),
        min_size=1,
        max_size=8,
    ),
    st.sets(st.integers(1, 7), max_size=1),
)
def test_no_other_strokes_are_fewer(
    rows: list[list[tuple[bool, float, float]]], starts: set[int]
) -> None:
    """Against all ways to cut the path, with jumps, full circles and limits tried one by one."""
    starts = {start for start in starts if start < len(rows)}
    valid = np.array([[known for known, _, _ in row] for row in rows])
    joints = np.array([[angles for _, *angles in row] for row in rows])
    joints[~valid] = np.nan
    found = fewest_strokes(path(len(rows), sorted(starts)), joints, valid, LOWER, UPPER, JUMP)
    assert len(found) == least(joints, valid, starts)
    samples = [k for stroke in found for k in range(stroke.first, stroke.after)]
    assert samples == np.flatnonzero(valid.any(axis=1)).tolist()
    for stroke in found:
        given_angles = joints[stroke.first : stroke.after, stroke.branch]
        turns = (stroke.joints - given_angles) / (2 * np.pi)
        assert np.allclose(turns, np.round(turns))
        assert (stroke.joints >= LOWER - 1e-9).all() and (stroke.joints <= UPPER + 1e-9).all()
        assert (np.abs(np.diff(stroke.joints, axis=0)) <= JUMP + 1e-9).all()


def test_a_joint_that_winds_up_ends_a_stroke() -> None:
    """One branch, its first joint going on and on by a radian a sample, with limits of 4 rad.

    Strokes begin at 0, 5 - 2 pi, 11 - 4 pi and 17 - 6 pi, each the smallest angle that is not below
    the limits, and the first three end when the next radian would be beyond 4.
    """
    joints = np.stack([np.arange(20.0), np.zeros(20)], axis=1)[:, None]
    valid = np.ones((20, 1), dtype=bool)
    found = fewest_strokes(path(20, []), joints, valid, LOWER, UPPER, JUMP)
    assert [stroke.after - stroke.first for stroke in found] == [5, 6, 6, 3]
    begins = [stroke.joints[0, 0] for stroke in found]
    assert np.allclose(begins, np.array([0, 5, 11, 17]) - 2 * np.pi * np.arange(4))


def test_strokes_of_the_square_and_a_jump_planted_in_them() -> None:
    """One stroke covers the square; a full circle in the middle of it makes two."""
    scene = shipped("square", 200)
    built = build_surface(scene.with_setup(scene.setup.varied(motion=None)))
    one = counted(built, 0.5, 0.06)
    assert (one.optimistic, one.judged, len(one.strokes)) == (0, 0, 1)
    joints = one.trajectory.joints.copy()
    middle = len(joints) // 2
    joints[middle:, 5] += 2 * np.pi
    contact = accepted(built, replace(one.trajectory, joints=joints))
    assert one.trajectory.contact[middle - 1 : middle + 2].all()
    begins = np.flatnonzero(contact[1:] & ~contact[:-1])
    assert begins.tolist() == [middle] and contact[0]
