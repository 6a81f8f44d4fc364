"""Joints that turn and joints that slide, held against one number at a time."""

from __future__ import annotations

import math
from typing import cast

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.motion.free_space import FreeSpace
from cellcolor.motion.limits import free_near

MIXED = st.lists(
    st.tuples(st.booleans(), st.floats(-9.0, 9.0), st.floats(-9.0, 9.0)), min_size=1, max_size=4
)


def space(slides: list[bool], lower: float = -2.0, upper: float = 3.0) -> JointSpace:
    """Joints with the same limits, on an arm that reaches 0.5 m."""
    count = len(slides)
    return JointSpace(np.array(slides), np.full(count, lower), np.full(count, upper), 0.5)


@given(MIXED)
def test_a_step_is_the_shorter_way_round_unless_there_is_only_one(
    joints: list[tuple[bool, float, float]],
) -> None:
    slides, first, second = (list(column) for column in zip(*joints, strict=True))
    found = space(slides).step(np.array(first), np.array(second))
    for slide, a, b, step in zip(slides, first, second, found.tolist(), strict=True):
        if slide:
            assert step == b - a
        else:
            assert math.isclose(abs(step), abs(math.remainder(b - a, math.tau)), abs_tol=1e-9)
            assert abs(math.remainder(a + step - b, math.tau)) < 1e-9


@given(MIXED)
def test_unwrapped_positions_are_the_same_and_near_each_other(
    joints: list[tuple[bool, float, float]],
) -> None:
    slides, first, second = (list(column) for column in zip(*joints, strict=True))
    found = space(slides).unwrap(np.array([first, second]))
    assert found[0].tolist() == first
    for slide, b, at, before in zip(slides, second, found[1].tolist(), first, strict=True):
        if slide:
            assert at == b
        else:
            assert abs(math.remainder(at - b, math.tau)) < 1e-9
            assert abs(at - before) < math.pi + 1e-9


@given(st.lists(st.floats(-9.0, 9.0), min_size=1, max_size=4), st.floats(-9.0, 0.0))
def test_a_slide_fits_as_it_is_or_not_at_all(path: list[float], lower: float) -> None:
    both = space([True, False], lower, lower + 7.0)
    slide, turning = both.turns(np.array([path, path]).T)
    inside = all(lower - 1e-9 <= at <= lower + 7.0 + 1e-9 for at in path)
    assert slide.tolist() == ([0] if inside else [])
    fitting = [
        turn
        for turn in range(-5, 6)
        if all(lower - 1e-9 <= at + math.tau * turn <= lower + 7.0 + 1e-9 for at in path)
    ]
    assert turning.tolist() == fitting
    assert both.fits(np.array([path, path]).T) == (inside and bool(fitting))


def test_a_proposed_home_moves_a_slide_by_its_share_of_the_reach() -> None:
    """0.1 rad at first, so 0.05 m on an arm that reaches 0.5 m."""

    class Free:
        space = space([True, False])

        def __call__(self, asked: np.ndarray) -> np.ndarray:
            assert np.abs(asked[:, 0]).max() <= 0.05 and 0.09 < np.abs(asked[:, 1]).max() <= 0.1
            return np.asarray((asked[:, 0] > 0.03) & (asked[:, 1] > 0.06))

    home = np.zeros(2)
    near = free_near(cast(FreeSpace, Free()), home)
    assert near is not None
    assert 0.03 < near[0] <= 0.05 and 0.06 < near[1] <= 0.1
