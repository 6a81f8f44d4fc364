"""Verdicts and reasons against a loop over Pinocchio and coal, and each constraint alone."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from independent import arm_reason, clearances, possible_reasons
from reasons import Reason
from world import World

from cellcolor.frontend import BuildResult, build_surface
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.reach.prepared_arm import prepare_arm
from cellcolor.frontend.reach.validity_tests import turned_into_limits
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Setup

pytestmark = pytest.mark.second

Varied = Callable[..., Scene]


@pytest.mark.parametrize("weak", [False, True])
def test_reasons_agree_with_an_independent_loop(setup: Setup, scene: Varied, weak: bool) -> None:
    # Placed so that most reasons occur; once with small torque limits and little room for joint 3.
    wok = scene(
        arm=lambda text: narrow_elbow(lowered_effort(text)) if weak else text,
        target_vertices=200,
        radius_m=0.22,
        half_angle_rad=1.5,
        position_m=(0.39, 0.03, 0.09),
    )
    result, robot = build_surface(wok), prepare_arm(wok.setup).robot
    surface = result.surface
    world = World(robot, surface.vertices, surface.faces)
    unclear = 0
    codes = result.reasons[::4]
    for q, code in zip(result.configurations[::4].reshape(-1, 6), codes.flat, strict=True):
        first = arm_reason(robot, setup, q)
        # Contacts are asked for only where they can matter: NaN cannot be placed.
        contacts = {} if first is not Reason.VALID else clearances(world, setup, 0.0, q)
        expected = possible_reasons(first, contacts)
        assert Reason(code) in expected
        unclear += len(expected) > 1
    assert unclear < 0.01 * codes.size
    counts = result.report.candidates
    assert sum(counts.values()) == result.reasons.size
    assert sum(count > 0 for count in counts.values()) >= 6


def counts(result: BuildResult) -> dict[str, int]:
    return result.report.candidates


def lowered_effort(text: str) -> str:
    return text.replace('effort="28"', 'effort="1.5"')


def narrow_elbow(text: str) -> str:
    joint = r'(<joint name="elbow_joint".*?<limit )lower="[^"]*" upper="[^"]*"'
    return re.sub(joint, r'\1lower="-0.5" upper="1.6"', text, flags=re.DOTALL)


@pytest.mark.parametrize("gravity", [(0.0, 0.0, 0.0), (0.0, 0.0, -9.81)])
def test_force_and_gravity_both_count(scene: Varied, gravity: tuple[float, ...]) -> None:
    failed = []
    for force in (0.0, 30.0, 60.0):
        task = {"normal_force_n": force, "gravity_m_per_s2": gravity}
        wok = scene(setup=task, arm=lowered_effort, target_vertices=200)
        failed.append(counts(build_surface(wok))["torque"])
    # Without gravity only the push loads the joints. With it the surface carries some of the
    # arm's weight, so that pressing helps at first.
    if not any(gravity):
        assert failed[0] == 0 < failed[1] < failed[2]
    else:
        assert failed[0] > failed[1] > 0


def test_limits_count_full_circles(robot: Robot) -> None:
    lower, upper = np.array([1.0, -4.0, -1, -1, -1, -1]), np.array([7.0, 4.0, 1, 1, 1, 1])
    narrow = replace(robot, lower=lower, upper=upper)
    asked = np.array(
        [
            [-1.0, 3.5, 0.0, 0.0, 0.0, 0.0],  # joint 1 turns once, joint 2 stays
            [0.5, 0.0, 0.0, 0.0, 0.0, 0.0],  # 0.5 + 2 pi is inside
            [0.9, 0.0, 0.0, 0.0, 0.0, 0.0],  # 0.9 + 2 pi is not
            [2.0, 0.0, 3.0, 0.0, 0.0, 0.0],  # joint 3 has no room
        ]
    )
    moved = turned_into_limits(narrow, asked)
    inside = ((moved >= lower) & (moved <= upper)).all(axis=1)
    assert inside.tolist() == [True, True, False, False]
    assert moved[0].tolist() == pytest.approx([2 * np.pi - 1, 3.5, 0, 0, 0, 0])
    assert moved[1, 0] == pytest.approx(2 * np.pi + 0.5)
