"""Capsules around points and meshes."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from meshed_arm import link_meshes

from cellcolor.arrays import Array
from cellcolor.frontend.arm.capsules import Capsule, capsule_around, capsules_around
from examples import examples

pytestmark = pytest.mark.second


def distances(capsule: Capsule, points: Array) -> Array:
    """From the axis, by the nearest of many points on it; at most a thousandth too large."""
    share = np.linspace(0, 1, 1001)[:, None]
    axis = capsule.start + share * (capsule.end - capsule.start)
    return np.linalg.norm(points[:, None] - axis, axis=2).min(axis=1)


@examples(15)
@given(st.integers(0, 2**32 - 1), st.sampled_from([(1, 1, 1), (1, 0.1, 0.1), (1, 1, 0.0)]))
def test_all_points_are_inside(seed: int, stretch: tuple[float, float, float]) -> None:
    points = np.random.default_rng(seed).normal(size=(30, 3)) * stretch
    capsule = capsule_around(points)
    length = float(np.linalg.norm(capsule.end - capsule.start))
    assert distances(capsule, points).max() <= capsule.radius + 1e-3 * length


def test_a_capsule_is_found_again() -> None:
    mesh = trimesh.creation.capsule(height=0.3, radius=0.05, count=[32, 32])
    found = capsule_around(np.array(mesh.vertices))
    assert found.radius == pytest.approx(0.05, rel=0.02)
    assert np.linalg.norm(found.end - found.start) == pytest.approx(0.3, rel=0.05)


@st.composite
def meshes(draw: st.DrawFn) -> tuple[Array, Array]:
    """Boxes in any place, closed and in few faces, or triangles without any order."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    count = draw(st.integers(1, 4))
    stretch = np.array(draw(st.sampled_from([(1, 1, 1), (1, 0.1, 0.1), (1, 1, 0.01)])))
    if draw(st.booleans()):
        return random.normal(size=(3 * count, 3)) * stretch, np.arange(3 * count).reshape(-1, 3)
    boxes = []
    for _ in range(count):
        boxes.append(trimesh.creation.box(random.uniform(0.05, 1, 3) * stretch))
        boxes[-1].apply_transform(trimesh.transformations.random_rotation_matrix(random.random(3)))
        boxes[-1].apply_translation(random.normal(size=3) * stretch)
    whole = trimesh.util.concatenate(boxes)
    return np.array(whole.vertices), np.array(whole.faces)


def held(vertices: Array, faces: Array, capsules: list[Capsule]) -> float:
    """How far out of all capsules the farthest of many points of the faces is."""
    corner = np.random.default_rng(1).dirichlet([0.5] * 3, (len(faces), 200))
    corner = np.concatenate([corner, np.broadcast_to(np.eye(3), (len(faces), 3, 3))], axis=1)
    points = (corner @ vertices[faces]).reshape(-1, 3)
    outside = []
    for start, end, radius in capsules:
        axis = end - start
        beyond_start = (points - start) @ axis <= 0
        beyond_end = (points - end) @ axis >= 0
        to_line = np.linalg.norm(np.cross(points - start, axis), axis=1)
        outside.append(
            np.select(
                [beyond_start, beyond_end],
                [np.linalg.norm(points - start, axis=1), np.linalg.norm(points - end, axis=1)],
                to_line / (np.linalg.norm(axis) or 1.0),
            )
            - radius
        )
    return float(np.min(outside, axis=0).max())


@examples(5)
@given(meshes())
def test_every_point_of_a_mesh_is_in_one_of_its_capsules(mesh: tuple[Array, Array]) -> None:
    capsules = capsules_around(*mesh)
    assert 1 <= len(capsules) <= 4
    assert held(*mesh, capsules) <= 1e-12


@pytest.mark.parametrize("link", ["forearm_link", "upper_arm_link"])
def test_every_point_of_a_link_is_in_one_of_its_capsules(link: str) -> None:
    mesh = link_meshes()[link]
    vertices, faces = np.array(mesh.vertices), np.array(mesh.faces)
    assert held(vertices, faces, capsules_around(vertices, faces)) <= 1e-12
