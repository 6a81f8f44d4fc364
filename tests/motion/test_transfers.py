"""Moves between strokes: other turns of the joints are tried where one has no way."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from shipped import shipped

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.build import BuildResult, build_surface
from cellcolor.motion.limits import motion_of, speeds_of
from cellcolor.motion.strokes import Stroke
from cellcolor.motion.transfers import _ATTEMPTS, Transfers
from cellcolor.motion.ways import FEW, MANY, Transfer
from examples import examples


@pytest.fixture(scope="module")
def square() -> BuildResult:
    """Built for a UR5, whose joints turn by a full circle each way."""
    return build_surface(shipped("square", 200))


def stroke(built: BuildResult, at: int) -> Stroke:
    """A stroke of 1 mm along x at a vertex, in the branch of the first color."""
    branch = built.color_branch[0]
    points = built.surface.vertices[at] + np.array([[0.0, 0.0, 0.0], [0.001, 0.0, 0.0]])
    normals = np.tile(built.prepared.surface.normals[at], (2, 1))
    joints = built.prepared.arm.follow(points, -normals, np.full(2, branch, dtype=np.intp))
    assert np.isfinite(joints).all()
    return Stroke(0, branch, points, normals, joints)


def strokes(built: BuildResult) -> list[Stroke]:
    """At the first and the last vertex that have the color."""
    own = [at for at, colors in enumerate(built.surface.vertex_colors) if 0 in colors]
    return [stroke(built, at) for at in (own[0], own[-1])]


def in_the_middle(built: BuildResult) -> tuple[Transfers, Stroke]:
    """What plans moves, and a stroke far from the border of the part."""
    vertices, prepared = built.surface.vertices, built.prepared
    middle = int(np.linalg.norm(vertices - vertices.mean(axis=0), axis=1).argmin())
    motion = motion_of(prepared)
    speeds = speeds_of(motion, prepared.robot)
    return Transfers(prepared, motion, speeds.velocities, 0, NEVER), stroke(built, middle)


def planned_with(
    built: BuildResult, monkeypatch: pytest.MonkeyPatch, without_way: int
) -> tuple[list[Transfer], list[tuple[bytes, int]]]:
    """The moves, and those that were asked for between the strokes, with the drawn.

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

    def between(start: Array, end: Array, drawn: int) -> Transfer:
        gap = None
        if not np.array_equal(start, home) and not np.array_equal(end, home):
            key = start.round(6).tobytes() + end.round(6).tobytes()
            asked.append((key, drawn))
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
    assert [drawn for _, drawn in asked] == [FEW]


def test_other_turns_are_tried_where_there_is_no_way(
    square: BuildResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    transfers, asked = planned_with(square, monkeypatch, 2)
    assert [one.gap for one in transfers] == [None] * 3
    assert [drawn for _, drawn in asked] == [FEW] * 3
    assert len(dict(asked)) == 3


def test_the_search_is_long_only_where_no_turns_have_a_way(
    square: BuildResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    transfers, asked = planned_with(square, monkeypatch, 100)
    assert [one.gap is None for one in transfers] == [True, False, True]
    assert [drawn for _, drawn in asked] == [FEW] * _ATTEMPTS + [MANY]
    # Turning both ends of a move by the same full circles does not make it another one.
    ways = [np.diff(np.frombuffer(key).reshape(2, -1), axis=0)[0] for key, _ in asked[:_ATTEMPTS]]
    assert len({way.round(4).tobytes() for way in ways}) == _ATTEMPTS


@examples(20)
@given(st.floats(20.0, 89.0), st.floats(0.0, 360.0))
def test_a_retreat_leaves_the_surface(square: BuildResult, tilt: float, turn: float) -> None:
    """More than 1 mm above the plane of the part from 3 mm on, or the tool would be dragged."""
    planner, own = in_the_middle(square)
    normal = own.normals[0]
    along = Rotation.from_rotvec(np.radians(turn) * normal).apply([normal[2], 0.0, -normal[0]])
    direction = np.cos(np.radians(tilt)) * normal + np.sin(np.radians(tilt)) * along
    way = planner._off(own.joints[0], normal, direction, own.branch)
    tips = forward(square.prepared.robot, way).tip
    gone = np.linalg.norm(tips - tips[0], axis=1)
    assert ((tips - tips[0])[gone > 0.003] @ normal > 0.001).all()
