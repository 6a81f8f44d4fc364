"""Meshes spoiled at random and repaired, held to what they were by trimesh."""

from __future__ import annotations

import fcl
import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.frontend.parts.mending import (
    crossing_pairs,
)
from cellcolor.frontend.parts.repairing import mended
from cellcolor.frontend.parts.shapes import disc_mesh

BALL = trimesh.creation.icosphere(subdivisions=2, radius=0.1)
VERTICES, FACES = np.array(BALL.vertices), np.array(BALL.faces, dtype=np.int64)
seeds = st.integers(0, 2**32 - 1)


@given(seeds, st.integers(0, 40), st.integers(0, 40), st.integers(0, 6))
def test_a_spoiled_ball_is_a_ball_again(seed: int, turn: int, twice: int, gone: int) -> None:
    rng = np.random.default_rng(seed)
    faces = FACES.copy()
    rows = rng.choice(len(faces), turn, replace=False)
    faces[rows] = faces[rows][:, ::-1]
    again = np.roll(faces[rng.choice(len(faces), twice, replace=False)], 1, axis=1)
    faces = np.delete(faces, rng.choice(len(faces), gone, replace=False), axis=0)
    faces = rng.permutation(np.concatenate([faces, again]))
    loose = VERTICES[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3)
    made, new, _ = mended(*loose, longest_hole=1.0)
    mesh = trimesh.Trimesh(made, new, process=False)
    assert mesh.is_watertight and mesh.is_winding_consistent
    # Of a hole of several faces the flattest filling has less area and volume.
    assert 0.95 < mesh.volume / BALL.volume < 1 + 1e-9
    if not gone:
        assert mesh.volume == pytest.approx(BALL.volume)


@given(seeds, st.integers(2, 30))
def test_crossing_faces_are_those_that_fcl_finds(seed: int, count: int) -> None:
    """Triangles at random that share no vertex, one pair after the other."""
    points = np.random.default_rng(seed).uniform(-1, 1, (3 * count, 3))
    faces = np.arange(3 * count).reshape(-1, 3)
    models = []
    for face in faces:
        model = fcl.BVHModel()
        model.beginModel(1, 3)
        model.addSubModel(points[face], np.array([[0, 1, 2]]))
        model.endModel()
        models.append(fcl.CollisionObject(model, fcl.Transform()))
    expected = {
        (i, j)
        for i in range(count)
        for j in range(i + 1, count)
        if fcl.collide(models[i], models[j])
    }
    found = crossing_pairs(points, faces)
    assert set(map(tuple, found.tolist())) == expected


def test_a_face_that_comes_back_through_one_that_it_touches() -> None:
    """Two faces with one vertex in common, of which one goes through the other."""
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0.2, -1], [0.1, 0.2, 1.0]], dtype=float)
    assert crossing_pairs(points, np.array([[0, 1, 2], [0, 3, 4]])).tolist() == [[0, 1]]


def test_a_filling_that_folds_back_is_left_out() -> None:
    """The border of a flat disc could only be closed by the same disc, seen from behind."""
    flat, faces = disc_mesh(37, 0.1, 1)
    points = np.column_stack([flat, np.zeros(len(flat))])
    _, same, changes = mended(points, faces, longest_hole=100.0)
    assert len(same) == len(faces) and changes == ["1 hole left: nothing fits in"]
