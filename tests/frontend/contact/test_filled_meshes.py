"""Meshes of links are filled, for the planner's engine and for the judge's; hulls and parts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from meshed_arm import is_inside, link_meshes

from cellcolor.arrays import Array
from cellcolor.frontend.arm.body import Shape, convex_hull, mesh_body
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.engine import Contacts, Pair
from cellcolor.trajectory_checker.validity import touching
from examples import examples


def holds(robot: Robot, mesh: trimesh.Trimesh, points: Array) -> list[bool]:
    """Whether both engines find that tiny balls at points (k, 3) touch a mesh at the base."""
    vertices, faces = np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64)
    body, still = mesh_body("link", 0, Path("link.stl"), vertices, faces, "exact"), (1, 6)
    found = []
    for point in points:
        pairs: list[Pair] = [(body, Shape("sphere", (1e-9,), origin=point), 0.0)]
        hit = Contacts(pairs, robot)(np.zeros(still))[0]
        assert touching(pairs, forward(robot, np.zeros(still)))[0] == hit
        found.append(bool(hit))
    return found


@pytest.mark.parametrize("turned", [False, True])
@examples(10)
@given(seed=st.integers(0, 2**32 - 1))
def test_inside_a_bent_link_as_by_hand(robot: Robot, turned: bool, seed: int) -> None:
    """Three boxes that overlap, wound outward or all inward."""
    mesh = link_meshes()["forearm_link"]
    if turned:
        mesh.invert()
    low, high = mesh.bounds
    points = np.random.default_rng(seed).uniform(low - 0.02, high + 0.02, (20, 3))
    assert holds(robot, mesh, points) == [is_inside("forearm_link", point) for point in points]


def test_a_small_hole_does_no_harm(robot: Robot) -> None:
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=1.0)
    mesh.update_faces(np.arange(len(mesh.faces)) != 17)
    points = np.random.default_rng(1).uniform(-1.2, 1.2, (100, 3))
    radius = np.linalg.norm(points, axis=1)
    clear = np.abs(radius - 1) > 0.02
    assert (np.array(holds(robot, mesh, points)) == (radius < 1))[clear].all()


def test_the_hull_is_wound_outward_and_has_no_other_vertices() -> None:
    mesh = link_meshes()["upper_arm_link"]
    hull = convex_hull(np.array(mesh.vertices))
    assert hull is not None
    read = trimesh.Trimesh(hull.vertices, hull.faces, process=False)
    assert read.is_watertight and read.volume == pytest.approx(mesh.convex_hull.volume)
    assert len(np.unique(hull.faces)) == len(hull.vertices)
    assert convex_hull(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])) is None
