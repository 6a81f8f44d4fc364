"""The sweep of a body's axis settles what fcl would say, and leaves little to it."""

from __future__ import annotations

from dataclasses import replace

import fcl
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from trimesh import Trimesh
from trimesh.proximity import closest_point_naive

from cellcolor.frontend.collision import body_poses, body_shape
from cellcolor.frontend.generators import disc_mesh, spherical_cap
from cellcolor.frontend.robot import Array, Body, Robot
from cellcolor.frontend.scene import BoxObstacle
from cellcolor.frontend.solids import Solid, mesh_solid, primitive_solid
from cellcolor.frontend.surfaces import Surface

BODIES = {
    "ball": (0.0, 0.04, False),
    "arm": (0.4, 0.05, False),
    "stub": (0.03, 0.06, False),
    "tool": (0.09, 0.02, True),
    "disc": (0.01, 0.05, True),
}


@pytest.fixture(scope="module")
def cap() -> Surface:
    return spherical_cap(0.2, 1.4, *disc_mesh(300, 0.2, 3))


def alone(robot: Robot, length: float, radius: float, flat: bool) -> tuple[Robot, Body]:
    body = Body("one", 1, np.zeros(3), np.array([0.0, 0.0, length]), radius, flat)
    return replace(robot, bodies=(body,)), body


def poses_near(surface: Surface, body: Body, count: int) -> Array:
    """Ends of axes (1, 2, n, 3) somewhere around the surface, inside as well as outside."""
    rng = np.random.default_rng(5)
    vertices = rng.integers(len(surface.vertices), size=count)
    middle = surface.vertices[vertices] + rng.uniform(-0.12, 0.12, (count, 3))
    half = Rotation.random(count, rng=rng).apply([0.0, 0.0, body.length / 2])
    return np.array([[middle - half, middle + half]])


def by_fcl(shape: fcl.CollisionObject, body: Body, ends: Array) -> Array:
    other = fcl.CollisionObject(body_shape(body), fcl.Transform())
    touching = []
    for turn, center in zip(*body_poses(body, ends), strict=True):
        other.setTransform(fcl.Transform(turn, center))
        touching.append(bool(fcl.collide(shape, other)))
    return np.array(touching)


def fcl_mesh(surface: Surface) -> fcl.CollisionObject:
    model = fcl.BVHModel()
    model.beginModel(len(surface.faces), len(surface.vertices))
    model.addSubModel(surface.vertices, surface.faces)
    model.endModel()
    return fcl.CollisionObject(model, fcl.Transform())


@pytest.mark.parametrize("kind", BODIES)
def test_a_mesh_is_hit_where_fcl_says_so(
    robot: Robot, cap: Surface, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    single, body = alone(robot, *BODIES[kind])
    ends = poses_near(cap, body, 4000)
    expected = by_fcl(fcl_mesh(cap), body, ends[0])
    assert 0.05 < expected.mean() < 0.95
    asked = []
    touches = Solid._touches

    def counted(self: Solid, body: Body, ends: Array) -> Array:
        asked.append(ends.shape[1])
        return touches(self, body, ends)

    monkeypatch.setattr(Solid, "_touches", counted)
    assert (mesh_solid(cap.vertices, cap.faces).hits(single, ends) == expected).all()
    # How a flat end meets the mesh at a slant is not known from distances of the axis.
    assert body.flat or sum(asked) < 0.02 * len(expected)


@pytest.mark.parametrize("kind", BODIES)
def test_a_box_is_hit_where_fcl_says_so(robot: Robot, cap: Surface, kind: str) -> None:
    single, body = alone(robot, *BODIES[kind])
    ends = poses_near(cap, body, 2000)
    box = BoxObstacle(kind="box", size_m=(0.1, 0.2, 0.3), position_m=(0.1, 0.0, 0.05))
    shape = fcl.CollisionObject(fcl.Box(0.1, 0.2, 0.3), fcl.Transform(np.array([0.1, 0, 0.05])))
    expected = by_fcl(shape, body, ends[0])
    assert 0.01 < expected.mean() < 0.99
    assert (primitive_solid(box).hits(single, ends) == expected).all()


@pytest.mark.parametrize("target", [30, 300, 3000])
def test_balls_about_a_point_end_at_its_distance(robot: Robot, target: int) -> None:
    """For faces larger than the samples' spacing and smaller ones, over faces, edges and rims."""
    cap = spherical_cap(0.2, 1.4, *disc_mesh(target, 0.2, 3))
    solid = mesh_solid(cap.vertices, cap.faces)
    rng = np.random.default_rng(8)
    points = rng.uniform([-0.3, -0.3, -0.1], [0.3, 0.3, 0.3], (60, 3))
    mesh = Trimesh(cap.vertices, cap.faces, process=False)
    _, distances, _ = closest_point_naive(mesh, points)
    for point, distance in zip(points, distances, strict=True):
        for radius, expected in ((distance - 1e-6, False), (distance + 1e-6, True)):
            single, _ = alone(robot, 0.0, radius, flat=False)
            assert solid.hits(single, np.tile(point, (1, 2, 1, 1)))[0] == expected
