"""Moves between strokes: other turns of the joints are tried where one has no way."""

from __future__ import annotations

import numpy as np
import pytest
from shipped import shipped

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER
from cellcolor.frontend.build import BuildResult, build_surface
from cellcolor.motion.limits import motion_of, speeds_of
from cellcolor.motion.strokes import Stroke
from cellcolor.motion.transfers import _ATTEMPTS, Transfers
from cellcolor.motion.ways import FEW_ROUNDS, MANY_ROUNDS, Transfer


@pytest.fixture(scope="module")
def square() -> BuildResult:
    """Built for a UR5, whose joints turn by a full circle each way."""
    return build_surface(shipped("square", 200))


def strokes(built: BuildResult) -> list[Stroke]:
    """Two strokes of 1 mm along x, in one branch, at the first and the last vertex that have it."""
    branch = built.color_branch[0]
    own = [at for at, colors in enumerate(built.surface.vertex_colors) if 0 in colors]
    found = []
    for at in (own[0], own[-1]):
        points = built.surface.vertices[at] + np.array([[0.0, 0.0, 0.0], [0.001, 0.0, 0.0]])
        normals = np.tile(built.prepared.surface.normals[at], (2, 1))
        joints = built.prepared.arm.follow(points, -normals, np.full(2, branch, dtype=np.intp))
        assert np.isfinite(joints).all()
        found.append(Stroke(0, branch, points, normals, joints))
    return found


def planned_with(
    built: BuildResult, monkeypatch: pytest.MonkeyPatch, without_way: int
) -> tuple[list[Transfer], list[tuple[bytes, int]]]:
    """The moves, and those that were asked for between the strokes, with the rounds.

    The first ``without_way`` different ones of them have no way.
    """
    prepared = built.prepared
    motion = motion_of(prepared)
    velocities = speeds_of(motion, prepared.robot).velocities
    planner = Transfers(prepared, motion, velocities, 0, NEVER)
    assert planner.home is not None
    home = planner.home
    asked: list[tuple[bytes, int]] = []
    shut: set[bytes] = set()

    def between(start: Array, end: Array, rounds: int) -> Transfer:
        gap = None
        if not np.array_equal(start, home) and not np.array_equal(end, home):
            key = start.round(6).tobytes() + end.round(6).tobytes()
            asked.append((key, rounds))
            if len(shut) < without_way:
                shut.add(key)
            gap = 0 if key in shut else None
        return Transfer(np.array([start, end]), gap)

    monkeypatch.setattr(planner._ways, "between", between)
    _, transfers = planner.between_strokes(strokes(built))
    assert len(transfers) == 3
    return transfers, asked


def test_the_quickest_turns_are_taken_where_they_have_a_way(
    square: BuildResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    transfers, asked = planned_with(square, monkeypatch, 0)
    assert [one.gap for one in transfers] == [None] * 3
    assert [rounds for _, rounds in asked] == [FEW_ROUNDS]


def test_other_turns_are_tried_where_there_is_no_way(
    square: BuildResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    transfers, asked = planned_with(square, monkeypatch, 2)
    assert [one.gap for one in transfers] == [None] * 3
    assert [rounds for _, rounds in asked] == [FEW_ROUNDS] * 3
    assert len(dict(asked)) == 3


def test_the_search_is_long_only_where_no_turns_have_a_way(
    square: BuildResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    transfers, asked = planned_with(square, monkeypatch, 100)
    assert [one.gap is None for one in transfers] == [True, False, True]
    assert [rounds for _, rounds in asked] == [FEW_ROUNDS] * _ATTEMPTS + [MANY_ROUNDS]
    # Turning both ends of a move by the same full circles does not make it another one.
    ways = [np.diff(np.frombuffer(key).reshape(2, -1), axis=0)[0] for key, _ in asked[:_ATTEMPTS]]
    assert len({way.round(4).tobytes() for way in ways}) == _ATTEMPTS
