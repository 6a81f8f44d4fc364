"""The sweep of a body's axis settles what fcl would say, and leaves little to it."""

from __future__ import annotations

from dataclasses import replace

import fcl
import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from trimesh import Trimesh
from trimesh.proximity import closest_point_naive

from cellcolor.arrays import Array
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.fcl_bodies import body_poses, body_shape
from cellcolor.frontend.contact.obstacle import BoxObstacle
from cellcolor.frontend.contact.solids import Solid, mesh_solid, sample_mesh
from cellcolor.frontend.parts.shapes import disc_mesh, spherical_cap
from cellcolor.frontend.parts.surface import Surface

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

    def counted(self: Solid, body: Body, ends: Array, *poses: object) -> Array:
        asked.append(ends.shape[1])
        return touches(self, body, ends, *poses)

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
    assert (box.solid().hits(single, ends) == expected).all()


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


@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from([1.0, 0.1, 0.01, 1e-4]),
    st.sampled_from([10_000, 300]),
)
def test_no_point_of_a_face_or_an_edge_is_far_from_a_sample_of_its_own(
    seed: int, thickness: float, most: int
) -> None:
    """Of all samples of one triangle: thick and thin, with acute and obtuse corners."""
    rng = np.random.default_rng(seed)
    corners = rng.uniform(-1, 1, (3, 3)) * [1.0, thickness, 0.0]
    points, slack = sample_mesh(corners, np.array([[0, 1, 2]]), 0.02, most)
    shares = rng.dirichlet([0.6, 0.6, 0.6], 200)
    gaps = np.linalg.norm((shares @ corners)[:, None] - points, axis=2).min(axis=1)
    assert gaps.max() <= slack * (1 + 1e-9)
    assert len(points) <= 3 + 1.2 * most
    for i, j in ((0, 1), (1, 2), (2, 0)):
        along = (corners[j] - corners[i]) / np.linalg.norm(corners[j] - corners[i])
        off = np.linalg.norm(np.cross(points - corners[i], along), axis=1)
        own = np.sort((points[off < 1e-9] - corners[i]) @ along)
        assert np.diff(own).max() / 2 <= slack


@pytest.mark.parametrize("sections", [32, 512])
def test_long_thin_faces_have_no_more_samples_than_their_size_needs(sections: int) -> None:
    """A tube of 60 mm, 2 m long: lattices as fine across as along would have millions."""
    mesh = trimesh.creation.cylinder(radius=0.03, height=2.0, sections=sections)
    points, slack = sample_mesh(np.array(mesh.vertices), np.array(mesh.faces), 0.003, 500_000)
    assert slack <= 0.004
    edges = mesh.edges_unique_length.sum()
    assert len(points) <= 1.5 * (edges / 0.0042 + mesh.area / 0.0042**2) + len(mesh.vertices)
