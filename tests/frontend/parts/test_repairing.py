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
    cut_apart,
    filled,
    merged,
)
from cellcolor.frontend.parts.repairing import mended
from cellcolor.frontend.parts.shapes import disc_mesh
from cellcolor.mesh.triangle_mesh import TriangleMesh

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


def test_blocks_that_meet_in_an_edge_come_apart() -> None:
    """Four faces on one edge: each block keeps its two, and its volume but for a little."""
    box = trimesh.creation.box((0.1, 0.1, 0.1))
    corners = np.concatenate([box.vertices, box.vertices + np.array([0.1, 0.1, 0])])
    faces = np.concatenate([box.faces, box.faces + 8]).astype(np.int64)
    points, joined = merged(corners, faces)
    assert (TriangleMesh(points, joined).triangles_at == 4).sum() == 1
    apart, new, moved = cut_apart(points, joined)
    assert len(apart) == len(points) + 2 and 0 < moved <= 0.0011
    made = TriangleMesh(apart, new)
    assert (made.triangles_at == 2).all()
    part = made.parts()
    assert part.max() == 1
    for own in (0, 1):
        mesh = trimesh.Trimesh(apart, new[part == own], process=False)
        assert mesh.is_watertight and mesh.volume == pytest.approx(0.001, rel=0.03)


@given(seeds, st.integers(4, 12))
def test_a_plane_hole_is_filled_with_its_area(seed: int, count: int) -> None:
    """A polygon with a ring around: no filling without overlap has another area."""
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * (np.arange(count) + 0.4 * rng.random(count)) / count
    inner = np.column_stack([np.cos(angle), np.sin(angle)]) * rng.uniform(0.6, 1, (count, 1))
    points = np.column_stack([np.concatenate([inner, 3 * inner]), np.zeros(2 * count)])
    k, after = np.arange(count), np.roll(np.arange(count), -1)
    fan = np.concatenate(
        [np.column_stack([k, k + count, after]), np.column_stack([after, k + count, after + count])]
    )
    border = float(np.linalg.norm(inner - np.roll(inner, 1, axis=0), axis=1).sum())
    new, left = filled(points, fan, border * 1.001)
    assert left == 0 and len(new) == 1 and len(new[0]) == count - 2
    x, y = inner.T
    shoelace = 0.5 * abs(x @ np.roll(y, -1) - y @ np.roll(x, -1))
    mesh = trimesh.Trimesh(points, np.concatenate([fan, new[0]]), process=False)
    assert mesh.is_winding_consistent
    assert mesh.area_faces[len(fan) :].sum() == pytest.approx(shoelace)
    assert filled(points, fan, border * 0.999) == ([], 0)


def test_a_filling_that_folds_back_is_left_out() -> None:
    """The border of a flat disc could only be closed by the same disc, seen from behind."""
    flat, faces = disc_mesh(37, 0.1, 1)
    points = np.column_stack([flat, np.zeros(len(flat))])
    _, same, changes = mended(points, faces, longest_hole=100.0)
    assert len(same) == len(faces) and changes == ["1 hole left: nothing fits in"]
