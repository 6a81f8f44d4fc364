"""The steps of planning a motion, each by itself."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.deadline import NEVER
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.motion.following import Followed, Samples
from cellcolor.motion.order import Visit, chosen_turns, ordered
from cellcolor.motion.strokes import Stroke, cut_where_full, trimmed
from cellcolor.motion.ways import quickest_way

UP = np.array([0.0, 0.0, 1.0])


def turning(lower: list[float], upper: list[float]) -> JointSpace:
    """Joints that all turn, with these limits."""
    slides = np.zeros(len(lower), dtype=bool)
    return JointSpace(slides, np.array(lower), np.array(upper), 1.0)


def stroke(joints: np.ndarray, segment: int = 0) -> Stroke:
    """Samples on a line along x, with these joints."""
    points = np.column_stack([np.arange(len(joints)) * 1e-3, np.zeros((len(joints), 2))])
    return Stroke(segment, 0, points, np.tile(UP, (len(joints), 1)), joints)


def test_a_bad_sample_and_a_jump_cut_a_path_and_are_named() -> None:
    joints = np.zeros((30, 2))
    joints[20:] += 2.0
    reasons = np.zeros(30, dtype=np.uint8)
    reasons[10] = 2
    torn = np.zeros(29, dtype=bool)
    torn[19] = True
    points = np.column_stack([np.arange(30) * 1e-3, np.zeros((30, 2))])
    samples = Samples(points, np.tile(UP, (30, 1)), np.zeros(30, dtype=np.int64))
    names = ("valid", "no solution", "joint limits")
    space = turning([-np.inf] * 2, [np.inf] * 2)
    parts = trimmed(4, 0, samples, Followed(joints, reasons, torn), 0.0, names, space)
    ends = [(round(part.points[0, 0] * 1e3), round(part.points[-1, 0] * 1e3)) for part in parts]
    assert ends == [(0, 9), (11, 19), (20, 29)]
    texts = [part.parting.text if part.parting else None for part in parts]
    assert texts == [
        None,
        "the path was cut where samples fail: joint limits",
        "the path was cut where the branch jumps",
    ]
    assert {part.parting.reason for part in parts if part.parting} == {"trimmed"}


@given(st.floats(0.5, 30.0), st.floats(1.0, 6.0))
def test_a_stroke_that_winds_is_cut_as_seldom_as_can_be(turned: float, room: float) -> None:
    joints = np.linspace(0.3, 0.3 + turned, 400)[:, None]
    # The range of the limits is a full circle and more, so that any angle is inside somehow.
    space = turning([-np.pi], [np.pi + room])
    parts = cut_where_full(stroke(joints), space, ("pan",))
    assert all(space.fits(part.joints) for part in parts)
    assert np.array_equal(parts[0].joints[0], joints[0])
    for before, after in pairwise(parts):
        assert np.array_equal(before.joints[-1], after.joints[0])
        assert after.parting is not None
        assert after.parting.reason == "winding"
        assert "pan" in after.parting.text
        # With the next sample it would not have fitted any more.
        longer = np.concatenate([before.joints, after.joints[1:2]])
        assert not space.fits(longer)
    assert parts[-1].joints[-1] == joints[-1]


def wall(configurations: np.ndarray) -> np.ndarray:
    """Free unless the first joint is near 1 and the second below 1."""
    blocked = (np.abs(configurations[:, 0] - 1) < 0.2) & (configurations[:, 1] < 1)
    return np.asarray(~blocked)


def way_over(
    free: Callable[[np.ndarray], np.ndarray], seed: int, joints: int
) -> list[np.ndarray] | None:
    """Corners of a way from 0 to 2 of the first joint over configurations that are drawn."""
    ends = 2.0 * np.eye(joints)[:1] * np.array([[0.0], [1.0]])
    drawn = np.random.default_rng(seed).uniform(-3, 3, (60, joints))
    nodes = np.concatenate([ends, drawn[free(drawn)]])
    seconds = 0.2 + np.abs(nodes[:, None] - nodes).max(axis=2)
    asked = list[tuple[int, int]]()

    def is_free(one: int, other: int) -> bool:
        asked.append((one, other))
        way = nodes[one] + np.linspace(0, 1, 1000)[:, None] * (nodes[other] - nodes[one])
        return bool(free(way).all())

    way = quickest_way(seconds, is_free, NEVER)
    assert len(asked) == len(set(asked))
    return None if way is None else [nodes[node] for node in way]


@pytest.mark.parametrize("seed", range(3))
def test_a_way_round_is_found_and_all_its_moves_are_free(seed: int) -> None:
    corners = way_over(wall, seed, 3)
    assert corners is not None and len(corners) > 2
    assert corners[0].tolist() == [0, 0, 0] and corners[-1].tolist() == [2, 0, 0]
    for start, end in pairwise(corners):
        assert wall(start + np.linspace(0, 1, 777)[:, None] * (end - start)).all()


@pytest.mark.parametrize("home", [np.zeros(4), None])
def test_turns_of_many_strokes_are_chosen_so_that_straight_moves_are_free(
    home: np.ndarray | None,
) -> None:
    """Each of six may be turned in 24 ways; no joint can pass pi, which would be quickest."""
    visits = []
    for number in range(6):
        at = np.array([2.8, 2.7, 2.6, 0.1]) * (-1) ** number
        visits.append(Visit(at, at, np.stack([at, at + 1e-3])))

    def passes(start: np.ndarray, end: np.ndarray) -> bool:
        low, high = np.minimum(start, end), np.maximum(start, end)
        return any(((low < wall) & (wall < high)).any() for wall in (-np.pi, np.pi))

    limits = turning([-2 * np.pi] * 4, [2 * np.pi] * 4)
    found = chosen_turns(visits, home, limits, np.ones(4), lambda *ends: 100.0 * passes(*ends))
    places = [visit.start + 2 * np.pi * own for visit, own in zip(visits, found, strict=True)]
    assert not any(passes(*ends) for ends in pairwise(places))
    assert home is None or not passes(home, places[0])


def test_strokes_are_ordered_and_turned_round_so_that_transfers_are_short() -> None:
    """Three strokes in a row on a line of angles, handed over out of order and reversed."""
    spans = [(2.0, 2.9), (0.9, 0.1), (1.9, 1.0)]
    strokes = [
        stroke(np.linspace(a, b, 5)[:, None], segment) for segment, (a, b) in enumerate(spans)
    ]
    limits = turning([-2 * np.pi], [2 * np.pi])
    found = ordered(strokes, limits, np.array([1.0]), np.array([0.0]), NEVER)
    # Home is at 0, and the way back from wherever the last one ends counts as well: the strokes
    # are passed upwards, or all of them downwards.
    way = [0.0, *(one.joints[at, 0] for one in found for at in (0, -1)), 0.0]
    between = sum(abs(b - a) for a, b in zip(way[::2], way[1::2], strict=True))
    assert between == pytest.approx(0.1 + 0.1 + 0.1 + 2.9)
