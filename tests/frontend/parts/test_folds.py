"""Folds mended where they are, held against trimesh's angles and areas of plane parts."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.distance import pdist

from cellcolor.frontend.parts.mending import crossing_pairs
from cellcolor.frontend.parts.remeshing import fold_angle, folds, unfolded
from cellcolor.mesh.triangle_mesh import TriangleMesh
from examples import examples

SIDE = 9  # vertices of a plane square, one unit apart
ANGLE = np.radians(150.0)


def square() -> tuple[np.ndarray, np.ndarray]:
    j, i = (np.arange(SIDE * SIDE) % SIDE, np.arange(SIDE * SIDE) // SIDE)
    corner = (i * SIDE + j)[(i < SIDE - 1) & (j < SIDE - 1)]
    lower = np.column_stack([corner, corner + 1, corner + SIDE + 1])
    upper = np.column_stack([corner, corner + SIDE + 1, corner + SIDE])
    points = np.column_stack([j, i, np.zeros(len(i))]).astype(float)
    return points, np.concatenate([lower, upper])


moves = st.dictionaries(
    st.integers(1, (SIDE - 2) ** 2).map(
        lambda k: (1 + (k - 1) // (SIDE - 2)) * SIDE + 1 + (k - 1) % (SIDE - 2)
    ),
    st.tuples(st.floats(-1.8, 1.8), st.floats(-1.8, 1.8)),
    min_size=1,
    max_size=3,
)


@examples(12)
@given(moves)
def test_what_folds_in_a_plane_is_flattened(moved: dict[int, tuple[float, float]]) -> None:
    """Inner vertices of a square pushed over their neighbors: then it covers itself no more.

    A square that is covered without folds has its own area; one with folds has more.
    """
    points, faces = square()
    border = set(np.flatnonzero((points[:, :2] % (SIDE - 1) == 0).any(axis=1)).tolist())
    for vertex, shift in moved.items():
        points[vertex, :2] += shift
    assume(pdist(points).min() > 0.01)  # a vertex on another one may leave a fold that stays
    new_points, new_faces, gone = unfolded(points, faces, ANGLE, 3.0)
    mesh = trimesh.Trimesh(new_points, new_faces, process=False)
    winding = mesh.face_normals[:, 2][mesh.area_faces > 1e-9]
    assert (winding > 0.999).all()
    assert mesh.area == pytest.approx((SIDE - 1) ** 2)
    assert len(new_points) == len(points) - gone
    kept = {tuple(place) for place in points[sorted(border)].tolist()}
    assert kept <= {tuple(place) for place in new_points.tolist()}
    assert gone <= 2 * len(moved) + 6 and (gone or not _folded(points, faces))


def _folded(points: np.ndarray, faces: np.ndarray) -> bool:
    a, b, c = (points[faces[:, corner], :2] for corner in range(3))
    (ux, uy), (wx, wy) = (b - a).T, (c - a).T
    return bool((ux * wy - uy * wx < -1e-6).any())


def test_no_vertex_goes_farther_than_it_may() -> None:
    """A blade over a narrow rhombus is folded at both ends, and stays where its height is kept."""
    rim = [[0.02, 0, 0], [0, 1, 0], [-0.02, 0, 0], [0, -1, 0]]
    points = np.array([*rim, [0, 0, 3.0]])
    faces = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    assert unfolded(points, faces, ANGLE, 2.9)[2] == 0
    flattened, new_faces, gone = unfolded(points, faces, ANGLE, 3.1)
    assert gone == 1 and not flattened[:, 2].any()
    assert trimesh.Trimesh(flattened, new_faces, process=False).area == pytest.approx(0.04)


def test_faces_that_cross_beside_a_corner_are_a_fold() -> None:
    """Two vertices of a square pushed past each other: no two faces turn by 150 degrees."""
    points, faces = square()
    points[4 * SIDE + 4], points[4 * SIDE + 5] = (5.7, 2.5, 0.6), (4.9, 2.7, -0.3)
    mesh = trimesh.Trimesh(points, faces, process=False)
    assert np.degrees(mesh.face_adjacency_angles.max()) < 150
    assert len(folds(points, faces, ANGLE)) == 2
    flattened, new_faces, gone = unfolded(points, faces, ANGLE, 3.0)
    crossing = crossing_pairs(flattened, new_faces)
    assert gone and not len(crossing)


@pytest.mark.parametrize(("wedge", "expected"), [(40.0, 150.0), (20.5, 159.6), (2.0, 175.0)])
def test_a_sharp_edge_of_the_part_is_no_fold(wedge: float, expected: float) -> None:
    """Two faces that meet in a wedge: by how much more two faces of the part have to turn."""
    half = np.radians(wedge / 2)
    points = np.array(
        [[0, 0, 0], [0, 1, 0]] + [[np.cos(half), 0.5, sign * np.sin(half)] for sign in (1.0, -1.0)]
    )
    mesh = TriangleMesh(points, np.array([[0, 1, 2], [1, 0, 3]]))
    assert np.degrees(fold_angle(mesh)) == pytest.approx(expected)
