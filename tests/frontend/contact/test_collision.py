"""Contacts of many configurations against distances between the shapes of the URDF, one by one."""

from __future__ import annotations

import os
import signal

import numpy as np
import pytest
from world import PAIRS, World

from cellcolor.arrays import Array, Mask
from cellcolor.frontend.arm.body import Shape
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.engine import Contacts, pairs_of, pairs_with
from cellcolor.frontend.parts.placement import Placement
from cellcolor.frontend.parts.shapes import CapObject
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.scene import Ground

CONTACT = 0.0005  # m; verdicts may differ nearer to contact than this
EXEMPT = ("base_link", "shoulder_link")


@pytest.fixture(scope="module")
def wok() -> Surface:
    place = Placement(position_m=(0.465, -0.15, -0.04))
    return (
        CapObject(radius_m=0.2, half_angle_rad=1.13, target_vertices=500, jitter=0.15, seed=1)
        .surface()
        .placed(place)
    )


@pytest.fixture(scope="module")
def joints() -> Array:
    return np.random.default_rng(21).uniform(-np.pi, np.pi, (600, 6))


def hits(robot: Robot, thing: Shape, joints: Array) -> Mask:
    return Contacts(pairs_with(robot, [thing]), robot)(joints)


def hits_ground(robot: Robot, ground: Shape, exempt: tuple[str, ...], joints: Array) -> Mask:
    pairs = [(body, ground, 0.0) for body in robot.bodies if body.link not in exempt]
    return Contacts(pairs, robot)(joints)


def mesh(surface: Surface, vertices: Array | None = None) -> Shape:
    own = surface.vertices if vertices is None else vertices
    return Shape("mesh", vertices=own, faces=surface.faces)


def agree(verdicts: Array, distances: Array) -> None:
    assert 0.05 < np.mean(verdicts) < 0.95  # both answers are asked for
    clear = np.abs(distances) > CONTACT
    assert (verdicts[clear] == (distances[clear] < 0)).all()
    assert np.mean(~clear) < 0.01


def test_self_collision_agrees_with_coal(robot: Robot, wok: Surface, joints: Array) -> None:
    world = World(robot, wok.vertices, wok.faces)
    distances = []
    for q in joints:
        world.place(q)
        distances.append(world.to_itself(PAIRS))
    agree(Contacts(pairs_of(robot), robot)(joints), np.array(distances))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_forked_process_finds_the_same(robot: Robot, joints: Array) -> None:
    """OpenMP's threads are not there in the child, which must not wait for them."""
    contacts = Contacts(pairs_of(robot), robot)
    own = contacts(joints)
    child = os.fork()
    if not child:
        signal.alarm(60)
        os._exit(int((contacts(joints) != own).any()))
    assert os.waitpid(child, 0)[1] == 0


def tool_down(turn: float) -> Array:
    q = np.array([[turn, -1.2, 1.4, 0.0, -np.pi / 2, 0.0]])
    q[0, 3] = -np.pi / 2 - q[0, 1] - q[0, 2]
    return q


def test_tool_body_is_flat_and_ends_above_the_tip(robot: Robot) -> None:
    poses = forward(robot, tool_down(0.0))
    assert poses.tool_axis[0, 2] == pytest.approx(-1)
    tip, arm = poses.tip[0, 2], (*EXEMPT, "upper_arm_link")
    for above, hit in ((0.0099, False), (0.0101, True)):
        ground = Ground(height_m=tip + above).half_space
        assert hits_ground(robot, ground, arm, tool_down(0.0))[0] == hit


def test_only_the_tip_touches(robot: Robot) -> None:
    # A plate 9 mm above the tip is free, one at 11 mm cuts the tool's body.
    poses = forward(robot, tool_down(-0.3))
    plate = CapObject(radius_m=5.0, half_angle_rad=0.01, target_vertices=300).surface()
    for height, expected in ((0.009, False), (0.011, True)):
        vertices = plate.vertices - [0, 0, 5.0] + poses.tip[0] + [0, 0, height]
        assert hits(robot, mesh(plate, vertices), tool_down(-0.3))[0] == expected
