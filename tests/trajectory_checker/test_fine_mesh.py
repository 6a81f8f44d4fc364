"""The fine mesh: conforming, as large as before, and asked for nearest points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER
from cellcolor.errors import TooLarge
from cellcolor.frontend.parts.surface import Surface
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.trajectory_checker.fine_mesh import FineMesh, refined
from examples import examples


def bumpy(seed: int, count: int = 5) -> Surface:
    """A square grid of uneven triangles with bumps."""
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(count) * 0.01, np.arange(count) * 0.02, indexing="ij")
    vertices = np.column_stack([x.ravel(), y.ravel(), np.zeros(count * count)])
    vertices += random.uniform(-0.003, 0.003, vertices.shape)
    at = np.arange(count * count).reshape(count, count)
    a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    faces = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    normals = np.zeros_like(vertices)
    np.add.at(normals, faces, TriangleMesh(vertices, faces).area_vectors[:, None])
    return Surface(vertices, faces, normals / np.linalg.norm(normals, axis=1, keepdims=True))


@examples(10)
@given(seed=st.integers(0, 1000), longest=st.sampled_from([0.002, 0.005, 0.012, 0.1]))
def test_refined_meshes_conform(seed: int, longest: float) -> None:
    surface = bumpy(seed)
    fine = refined(surface, longest, NEVER)
    sides = np.concatenate([fine.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    made = TriangleMesh(fine.vertices, fine.triangles)
    assert made.lengths.max() <= longest
    # Every directed edge once: each edge has one triangle on each side, or is on the border.
    assert len(np.unique(sides, axis=0)) == len(sides)
    assert fine.mesh.euler_number == 1  # a disc, so nowhere torn
    assert fine.mesh.area_faces.sum() == pytest.approx(surface.mesh.areas.sum())
    # Each corner lies in the given face, with the normal that is interpolated there.
    corners, given_faces = fine.vertices[fine.triangles], surface.faces[fine.face]
    for corner in range(3):
        shares = TriangleMesh(surface.vertices, surface.faces).shares(fine.face, corners[:, corner])
        assert shares.min() > -1e-9
        assert np.allclose(
            np.einsum("kc,kcd->kd", shares, surface.vertices[given_faces]), corners[:, corner]
        )
        normals = np.einsum("kc,kcd->kd", shares, surface.normals[given_faces])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        assert np.allclose(fine.normals[fine.triangles[:, corner]], normals)


def brute_nearest(fine: FineMesh, point: Array) -> float:
    """The distance from a point to the nearest of very many points of the mesh."""
    share = np.linspace(0, 1, 41)
    u, v = np.meshgrid(share, share)
    inside = u + v <= 1
    weights = np.column_stack([1 - u[inside] - v[inside], u[inside], v[inside]])
    corners = fine.surface.vertices[fine.surface.faces]
    points = np.einsum("wc,fcd->fwd", weights, corners).reshape(-1, 3)
    return float(np.linalg.norm(points - point, axis=1).min())


def test_nearest_points_are_the_nearest() -> None:
    fine = refined(bumpy(2), 0.004, NEVER)
    random = np.random.default_rng(0)
    points = random.uniform([-0.01, -0.01, -0.01], [0.05, 0.09, 0.02], (200, 3))
    located = fine.locate(points, np.tile([0.0, 0.0, 1.0], (200, 1)))
    found = np.linalg.norm(located.points - points, axis=1)
    for point, distance in zip(points, found, strict=True):
        brute = brute_nearest(fine, point)
        assert brute - 4e-4 <= distance <= brute + 1e-12


def test_an_upright_tool_is_where_its_tip_is() -> None:
    """On a wall, 10 mm below a roof; and of a thin sheet on the side that faces it."""
    roof = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]) * 0.02
    wall = np.array([[1, 0, 0], [1, 0, -1], [1, 1, -1], [1, 1, 0]]) * 0.02
    faces = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    normals = np.repeat([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], 4, axis=0)
    fine = refined(Surface(np.concatenate([roof, wall]), faces, normals), 0.003, NEVER)
    place, up = np.array([[0.02, 0.01, -0.01]]), np.array([[0.0, 0.0, 1.0]])
    at = replace(fine, away=0.001).locate(place, up)
    assert np.abs(at.points - place).max() < 1e-12 and at.normals[0, 0] == 1
    under = roof - [0, 0, 1e-4]
    back = np.array([[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]])
    normals = np.repeat([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]], 4, axis=0)
    sheet = refined(Surface(np.concatenate([roof, under]), back, normals), 0.003, NEVER)
    at = replace(sheet, away=0.001).locate(np.array([[0.01, 0.01, -1e-4]]), up)
    assert at.normals[0, 2] == 1


def test_what_would_not_fit_into_memory_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cellcolor.trajectory_checker.fine_mesh._MOST", 1000)
    with pytest.raises(TooLarge, match="too large to be judged"):
        refined(bumpy(0), 1e-3, NEVER)
