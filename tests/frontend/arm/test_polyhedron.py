"""Solids with flat faces: what is inside them, boxes around them, hulls."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from meshed_arm import is_inside, link_meshes

from cellcolor.frontend.arm.polyhedron import Polyhedron, convex_hull


def solid(mesh: trimesh.Trimesh) -> Polyhedron:
    return Polyhedron(np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64))


@pytest.mark.parametrize("turned", [False, True])
@given(seed=st.integers(0, 2**32 - 1))
def test_inside_a_bent_link_as_by_hand(turned: bool, seed: int) -> None:
    """Three boxes that overlap, wound outward or all inward."""
    mesh = link_meshes()["forearm_link"]
    if turned:
        mesh.invert()
    low, high = mesh.bounds
    points = np.random.default_rng(seed).uniform(low - 0.02, high + 0.02, (50, 3))
    expected = [is_inside("forearm_link", point) for point in points]
    assert solid(mesh).contains(points).tolist() == expected


def test_a_small_hole_does_no_harm() -> None:
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=1.0)
    mesh.update_faces(np.arange(len(mesh.faces)) != 17)
    points = np.random.default_rng(1).uniform(-1.2, 1.2, (300, 3))
    radius = np.linalg.norm(points, axis=1)
    clear = np.abs(radius - 1) > 0.02
    assert (solid(mesh).contains(points) == (radius < 1))[clear].all()


def test_the_hull_is_wound_outward_and_has_no_other_vertices() -> None:
    mesh = link_meshes()["upper_arm_link"]
    hull = convex_hull(np.array(mesh.vertices))
    assert hull is not None
    read = trimesh.Trimesh(hull.vertices, hull.faces, process=False)
    assert read.is_watertight and read.volume == pytest.approx(mesh.convex_hull.volume)
    assert len(np.unique(hull.faces)) == len(hull.vertices)
    assert convex_hull(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])) is None


def test_parts_are_counted() -> None:
    boxes = [trimesh.creation.box((1, 1, 1)) for _ in range(3)]
    for number, box in enumerate(boxes):
        box.apply_translation((2 * number, 0, 0))
    found = solid(trimesh.util.concatenate(boxes)).one_of_each_part
    assert sorted(np.rint(found[:, 0] / 2).tolist()) == [0, 1, 2]
