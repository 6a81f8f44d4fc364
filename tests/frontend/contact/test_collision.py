"""Contacts of many configurations against distances between the shapes of the URDF, one by one."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable

import coal
import numpy as np
import pytest
from reasons import Reason
from scipy.spatial.transform import Rotation
from world import PAIRS, World

from cellcolor.arrays import Array, Mask
from cellcolor.frontend import build_surface
from cellcolor.frontend.arm.body import Shape
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.engine import Contacts, pairs_of, pairs_with
from cellcolor.frontend.contact.obstacle import (
    BoxObstacle,
    CapsuleObstacle,
    ConeObstacle,
    CylinderObstacle,
    HalfSpaceObstacle,
    Obstacle,
    SphereObstacle,
)
from cellcolor.frontend.contact.tip import HalfSpace
from cellcolor.frontend.parts.placement import Placement
from cellcolor.frontend.parts.shapes import disc_mesh, spherical_cap
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.scene import Scene

CONTACT = 0.0005  # m; verdicts may differ nearer to contact than this
EXEMPT = ("base_link", "shoulder_link")


@pytest.fixture(scope="module")
def wok() -> Surface:
    place = Placement(position_m=(0.465, -0.15, -0.04))
    return spherical_cap(0.2, 1.13, *disc_mesh(500, 0.15, 1)).placed(place)


@pytest.fixture(scope="module")
def joints() -> Array:
    return np.random.default_rng(21).uniform(-np.pi, np.pi, (600, 6))


def hits(robot: Robot, thing: Shape, joints: Array) -> Mask:
    return Contacts(pairs_with(robot, [thing]), robot)(joints)


def hits_ground(robot: Robot, ground: HalfSpace, exempt: tuple[str, ...], joints: Array) -> Mask:
    thing = ground.shape
    pairs = [(body, thing, 0.0) for body in robot.bodies if body.link not in exempt]
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


@pytest.mark.parametrize(
    ("height", "normal"), [(-0.02, (0.0, 0.0, 1.0)), (0.05, (0.3, -0.5, 2.0)), (-0.1, (0.9, 0, 1))]
)
def test_ground_agrees_with_coal(
    robot: Robot, wok: Surface, joints: Array, height: float, normal: tuple[float, float, float]
) -> None:
    world = World(robot, wok.vertices, wok.faces)
    distances = []
    for q in joints:
        world.place(q)
        distances.append(world.to_ground(height, EXEMPT, normal))
    ground = HalfSpace.through(np.array([0.0, 0.0, height]), np.array(normal))
    agree(hits_ground(robot, ground, EXEMPT, joints), np.array(distances))


def test_object_agrees_with_coal(robot: Robot, wok: Surface, joints: Array) -> None:
    world = World(robot, wok.vertices, wok.faces)
    found = hits(robot, mesh(wok), joints)
    assert 0.05 < found.mean() < 0.95
    near = 0
    for q, verdict in zip(joints, found, strict=True):
        world.place(q)
        distance = world.to_object()
        # A shell has no inside: depths mean nothing, so "touching" is a distance of zero.
        if verdict != (distance <= 0):
            assert abs(distance) <= CONTACT
            near += 1
    assert near < 0.01 * len(joints)


ASIDE = {"position_m": (0.3, -0.1, 0.35), "rpy_rad": (0.4, -0.7, 1.1)}
WALL = {"position_m": (0.6, 0.0, 0.0), "rpy_rad": (0.2, -1.4, 0.3)}
OBSTACLES = [
    (BoxObstacle(kind="box", size_m=(0.1, 0.4, 0.2), **ASIDE), coal.Box(0.1, 0.4, 0.2)),
    (CylinderObstacle(kind="cylinder", radius_m=0.1, height_m=0.5, **ASIDE),
     coal.Cylinder(0.1, 0.5)),
    (SphereObstacle(kind="sphere", radius_m=0.2, **ASIDE), coal.Sphere(0.2)),
    (ConeObstacle(kind="cone", radius_m=0.2, height_m=0.5, **ASIDE), coal.Cone(0.2, 0.5)),
    (CapsuleObstacle(kind="capsule", radius_m=0.1, axis_m=0.5, **ASIDE), coal.Capsule(0.1, 0.5)),
    (HalfSpaceObstacle(kind="half-space", **WALL), coal.Halfspace(np.array([0.0, 0.0, 1.0]), 0.0)),
]  # fmt: skip


@pytest.mark.parametrize(("obstacle", "shape"), OBSTACLES, ids=[one.kind for one, _ in OBSTACLES])
def test_obstacles_agree_with_coal(
    robot: Robot, wok: Surface, joints: Array, obstacle: Obstacle, shape: coal.ShapeBase
) -> None:
    world = World(robot, wok.vertices, wok.faces)
    turn = Rotation.from_euler("xyz", obstacle.rpy_rad).as_matrix()
    pose = coal.Transform3s(turn, np.array(obstacle.position_m))
    distances = []
    for q in joints:
        world.place(q)
        distances.append(world.to_solid(shape, pose))
    found = hits(robot, obstacle.solid(), joints)
    agree(found, np.array(distances))


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


def test_an_obstacle_takes_away_what_it_hits(scene: Callable[..., Scene]) -> None:
    wok = scene(target_vertices=500)
    free = build_surface(wok)
    post = CylinderObstacle(radius_m=0.03, height_m=0.3, position_m=(0.205, 0.005, 0.15))
    blocked = build_surface(wok.with_obstacle(post))
    changed = free.reasons != blocked.reasons
    assert (blocked.reasons[changed] == Reason.OBSTACLE_COLLISION).all()
    assert changed.sum() == blocked.report.candidates["obstacle collision"] > 100


def tool_down(turn: float) -> Array:
    q = np.array([[turn, -1.2, 1.4, 0.0, -np.pi / 2, 0.0]])
    q[0, 3] = -np.pi / 2 - q[0, 1] - q[0, 2]
    return q


def test_tool_body_is_flat_and_ends_above_the_tip(robot: Robot) -> None:
    poses = forward(robot, tool_down(0.0))
    assert poses.tool_axis[0, 2] == pytest.approx(-1)
    tip, arm = poses.tip[0, 2], (*EXEMPT, "upper_arm_link")
    for above, hit in ((0.0099, False), (0.0101, True)):
        ground = HalfSpace((0.0, 0.0, 1.0), tip + above)
        assert hits_ground(robot, ground, arm, tool_down(0.0))[0] == hit


def test_only_the_tip_touches(robot: Robot) -> None:
    # A plate 9 mm above the tip is free, one at 11 mm cuts the tool's body.
    poses = forward(robot, tool_down(-0.3))
    plate = spherical_cap(5.0, 0.01, *disc_mesh(300, 0.0, 0))
    for height, expected in ((0.009, False), (0.011, True)):
        vertices = plate.vertices - [0, 0, 5.0] + poses.tip[0] + [0, 0, height]
        assert hits(robot, mesh(plate, vertices), tool_down(-0.3))[0] == expected
