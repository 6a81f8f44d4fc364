"""Capsules around points and meshes."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from meshed_arm import link_meshes

from cellcolor.arrays import Array
from cellcolor.frontend.arm.capsules import Capsule, capsule_around, capsules_around


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


@pytest.mark.parametrize("link", ["forearm_link", "upper_arm_link", "base_link"])
def test_every_face_is_in_one_of_the_capsules(link: str) -> None:
    mesh = link_meshes()[link]
    capsules = capsules_around(np.array(mesh.vertices), np.array(mesh.faces))
    held = np.zeros(len(mesh.faces), dtype=bool)
    for capsule in capsules:
        inside = distances(capsule, np.array(mesh.vertices)) <= capsule.radius + 5e-4
        held |= inside[mesh.faces].all(axis=1)
    assert held.all()
    assert 1 <= len(capsules) <= 4
