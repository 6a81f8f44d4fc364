"""Motions along one edge, given as functions: smooth or not, whatever its length and turn."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from cellcolor.arrays import Array
from cellcolor.frontend.links import link
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.reach.smooth import Measure, Motions, Probe, follow_edges
from cellcolor.frontend.reach.validity_tests import Verdicts
from cellcolor.frontend.setup import Continuity

POLICY = Continuity(
    base_step_rad=0.1,
    step_per_length_rad_per_m=30.0,
    near_singular_determinant_m3=0.005,
    probe_spacing_m=0.0005,
)
EDGE = np.array([[0, 1]])
LEVER = 0.2
MEASURE = Measure(POLICY, near_singular=0.005, lever=LEVER)
Joint = Callable[[Array], Array]
"""The first joint in rad at parts of the way, 0 to 1."""


def edge(length: float, turn: float) -> Surface:
    """One triangle; the normal turns along its first edge."""
    vertices = np.array([[0.0, 0, 0], [length, 0, 0], [0, length, 0]])
    normals = np.array([[0.0, 0, 1], [np.sin(turn), 0, np.cos(turn)], [0, 0, 1]])
    return Surface(vertices, np.array([[0, 1, 2]]), normals)


def wound(angle: Array) -> Array:
    """Only the first joint moves; as inverse kinematics gives it, in (-pi, pi]."""
    joints = np.zeros((len(angle), 6))
    joints[:, 0] = np.pi - np.mod(np.pi - angle, 2 * np.pi)
    return joints


def asked(surface: Surface, joint: Joint, determinant: Joint) -> Probe:
    def probe(points: Array, _: Array, __: Array) -> tuple[Array, Array]:
        at = points[:, 0] / surface.vertices[1, 0]
        return wound(joint(at)), determinant(at)

    return probe


def followed(
    surface: Surface, joint: Joint, determinant: Joint = lambda at: np.full(len(at), 0.02)
) -> Motions:
    ends = np.array([0.0]), np.array([1.0])
    return follow_edges(
        surface,
        EDGE,
        np.zeros(1, dtype=np.intp),
        (wound(joint(ends[0])), wound(joint(ends[1]))),
        (determinant(ends[0]), determinant(ends[1])),
        MEASURE,
        asked(surface, joint, determinant),
    )


lengths = st.floats(1e-4, 0.1)
turns = st.floats(0.0, 2.5)


@given(lengths, turns, st.floats(-5, 5), st.floats(0, 1), st.floats(1, 8), st.floats(-3, 3))
def test_smooth_motions_are_smooth_and_unwound(
    length: float, turn: float, total: float, even: float, power: float, start: float
) -> None:
    """A joint goes one way, faster and faster; its ends do not say how often around.

    Beyond some speed a motion counts as a jump: a step of the bound on a part that is too short.
    """
    policy = MEASURE.policy
    fastest = abs(total) * (even + (1 - even) * power)
    shortest = policy.probe_spacing_m / 2**11 / (length + LEVER * turn)
    assume(fastest * shortest < policy.base_step_rad / 2)
    found = followed(
        edge(length, turn), lambda at: start + total * (even * at + (1 - even) * at**power)
    )
    assert found.smooth.all()
    assert found.lowest[0, 0] == pytest.approx(min(total, 0), abs=1e-9)
    assert found.highest[0, 0] == pytest.approx(max(total, 0), abs=1e-9)
    assert not found.lowest[0, 1:].any() and not found.highest[0, 1:].any()


@given(lengths, turns, st.floats(1, 5), st.floats(0.001, 0.999))
def test_a_jump_is_a_jump_however_short_the_edge(
    length: float, turn: float, jump: float, place: float
) -> None:
    def joint(at: Array) -> Array:
        return 0.3 * at + np.where(at > place, jump, 0.0)

    def determinant(at: Array) -> Array:
        return 0.001 + 0.02 * np.abs(at - place)  # it leads through a singularity

    assert not followed(edge(length, turn), joint, determinant).smooth.any()


def along(at: Array, length: float, turn: float) -> Array:
    """The part of an edge's whole change of pose up to parts of its way."""
    angle = np.arctan2(at * np.sin(turn), 1 - at + at * np.cos(turn))
    return np.asarray((length * at + LEVER * angle) / (length + LEVER * turn))


@pytest.mark.parametrize(("upper", "fits"), [(4.2, True), (3.8, False)])
def test_limits_are_asked_of_the_motion_and_not_of_the_shorter_way(
    upper: float, fits: bool
) -> None:
    """A joint turns by 4 rad; the shorter way, 2.28 rad backwards, is not what it does."""
    surface = edge(0.05, 0.5)

    def joint(at: Array) -> Array:
        return 4.0 * at

    configurations = np.zeros((3, 1, 6))
    configurations[:2, 0] = wound(joint(np.array([0.0, 1.0])))
    candidates = Verdicts(
        configurations,
        np.array([[0], [0], [1]], dtype=np.uint8),
        np.full((3, 1), 0.02),
        np.empty((0, 3, 1, 3)),
        ("valid", "no solution"),
    )
    limits = np.full(6, -2.4), np.full(6, 2.4)
    limits[0][0], limits[1][0] = -0.1, upper
    probe = asked(surface, joint, lambda at: np.full(len(at), 0.02))
    assert link(surface, EDGE, candidates, MEASURE, limits, probe).tolist() == [[fits]]
