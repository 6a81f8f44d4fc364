"""The six small triangles of a triangle, held to where their corners are."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from triangles import any_meshes

from cellcolor.mesh.dividing import (
    everywhere,
    small_areas,
    small_triangles,
    unit_everywhere,
)
from cellcolor.mesh.triangle_mesh import TriangleMesh


@given(any_meshes())
def test_corners_sides_and_areas(mesh: TriangleMesh) -> None:
    fine, side = small_triangles(mesh)
    assert fine.areas == pytest.approx(small_areas(mesh), abs=1e-9)
    for number, corners in enumerate(fine.corners.tolist()):
        triangle, corner = divmod(number // 2, 3)
        own = mesh.corners[triangle]
        assert corners[0] == own[corner]
        places = fine.points[corners]
        middle = mesh.points[mesh.edges[side[number]]].mean(axis=0)
        # Counter-clockwise: the first goes to the side after the corner, the second to that before.
        other = own[(corner + 1) % 3] if number % 2 == 0 else own[corner - 1]
        assert set(mesh.edges[side[number]].tolist()) == {own[corner], other}
        expected = [middle, mesh.points[own].mean(axis=0)]
        assert np.allclose(places[1:], expected if number % 2 == 0 else expected[::-1])
        vector = fine.area_vectors[number]
        assert np.allclose(6 * vector, mesh.area_vectors[triangle])


@given(any_meshes(), st.integers(0, 10**6))
def test_linear_values_stay_linear(mesh: TriangleMesh, seed: int) -> None:
    way = np.random.default_rng(seed).normal(size=(3, 2))
    fine, _ = small_triangles(mesh)
    assert np.allclose(everywhere(mesh, mesh.points @ way), fine.points @ way)
    lengths = np.linalg.norm(unit_everywhere(mesh, mesh.points), axis=1)
    assert np.allclose(lengths, np.linalg.norm(fine.points, axis=1) > 0)
