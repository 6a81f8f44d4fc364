"""Normals rounded over a radius, against sums over tiny triangles and closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from shipped import shipped

from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import InputError
from cellcolor.frontend.parts import rounding
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.rounding import note_on_triangles, rounded
from cellcolor.frontend.parts.surface import Surface
from cellcolor.mesh.dividing import halved
from cellcolor.mesh.triangle_mesh import TriangleMesh


def surface_of(mesh: trimesh.Trimesh) -> Surface:
    return mesh_surface(np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64))


def angle(first: np.ndarray, second: np.ndarray) -> float:
    return float(np.degrees(np.arccos(np.clip(first @ second, -1, 1))))


def tiny(surface: Surface, times: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Middles, areas and normals of its triangles, each cut into four so many times."""
    points, faces = surface.vertices, surface.faces
    for _ in range(times):
        points, faces = trimesh.remesh.subdivide(points, faces)
    doubled = TriangleMesh(points, faces).area_vectors
    areas = np.linalg.norm(doubled, axis=1) / 2
    return points[faces].mean(axis=1), areas, doubled / (2 * areas[:, None])


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10_000), st.floats(0.3, 0.9))
def test_the_mean_around_a_vertex(seed: int, radius: float) -> None:
    """On bumpy convex shapes nothing lies between a vertex and what is near: d is the distance."""
    rng = np.random.default_rng(seed)
    ball = rng.normal(size=(30, 3))
    hull = trimesh.convex.convex_hull(ball / np.linalg.norm(ball, axis=1)[:, None])
    surface = surface_of(hull)
    made = rounded(surface, radius)
    middles, areas, normals = tiny(surface, 5)
    vertex = int(rng.integers(len(surface.vertices)))
    away = np.linalg.norm(middles - surface.vertices[vertex], axis=1)
    weights = areas * np.maximum(1 - (away / radius) ** 2, 0)
    mean = weights @ normals
    assert angle(made.normals[vertex], mean / np.linalg.norm(mean)) < 0.5
    assert np.linalg.norm(made.normals, axis=1) == pytest.approx(1.0)


def test_a_triangle_inside_a_disc_counts_whole_whatever_rounding_leaves_of_its_corner() -> None:
    """Triangles with a corner in the origin, all but for the last digit."""
    rng = np.random.default_rng(0)
    length, tilt, wide = rng.uniform([0.1, -1.5, 0.1], [1.0, 1.5, 1.0], (5000, 3)).T
    far = length[:, None] * np.column_stack([0 * tilt, -np.cos(tilt), np.sin(tilt)])
    side = far / 2 + wide[:, None] * [1.0, 0.0, 0.0]
    corners = np.stack([side, far, 0 * far], axis=1)
    normals = np.cross(far - side, -side)
    areas = np.linalg.norm(normals, axis=1) / 2
    normals = normals / (2 * areas[:, None]) + 3e-15 * rng.normal(size=far.shape)
    height = np.einsum("ij,ij->i", side, normals) + 1e-17 * rng.normal(size=len(side))
    flat = corners - height[:, None, None] * normals[:, None]
    area, _ = rounding._disc(flat, normals, np.full(len(flat), 20.0))
    assert area == pytest.approx(areas, abs=1e-9)


@settings(max_examples=8, deadline=None)
@given(st.integers(0, 10_000), st.floats(0.2, 0.9))
def test_triangles_have_no_part_in_it(seed: int, radius: float) -> None:
    """A box whose faces are divided at random: its old vertices keep their normals."""
    rng = np.random.default_rng(seed)
    box = surface_of(trimesh.creation.box((1.0, 1.5, 0.4)).subdivide()).mesh
    other = box
    for _ in range(3):
        other, _ = halved(other, rng.random(len(other.edges)) < 0.1)
    before, after = (rounded(surface_of_arrays(x), radius).normals for x in (box, other))
    assert after[: len(before)] == pytest.approx(before, abs=1e-7)


def surface_of_arrays(mesh: TriangleMesh) -> Surface:
    return mesh_surface(mesh.points, mesh.corners)


@settings(max_examples=4, deadline=None)
@given(st.integers(0, 10_000), st.floats(0.1, 0.4), st.floats(0.15, 0.5))
def test_halving_edges_changes_nothing(seed: int, radius: float, longest: float) -> None:
    """The whole faces are looked at in place of their triangles: the same means."""
    rng = np.random.default_rng(seed)
    hull = trimesh.convex.convex_hull(rng.normal(size=(20, 3)))
    box = trimesh.creation.box((1.0, 1.5, 0.02))  # both sides of a thin wall
    mesh = (hull, box)[seed % 2]
    fine = mesh_surface(
        np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64), max_edge_m=longest
    )
    assert fine.divided is not None
    by_triangles = rounded(replace(fine, divided=None), radius)
    assert rounded(fine, radius).normals == pytest.approx(by_triangles.normals, abs=1e-9)


def test_many_faces_around_a_vertex(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fewer vertices are then rounded together, to the same normals; too many are refused."""
    part = surface_of(trimesh.creation.box((1, 1, 1)).subdivide().subdivide())
    usual = rounded(part, 0.6).normals
    monkeypatch.setattr(rounding, "_AROUND", 20)
    assert rounded(part, 0.6).normals == pytest.approx(usual)
    with pytest.raises(OutOfTime):
        rounded(part, 0.6, Deadline.after(0.0))
    monkeypatch.setattr(rounding, "_MOST_AROUND", 1000)
    with pytest.raises(InputError, match="a smaller radius, or larger triangles") as caught:
        rounded(part, 0.6)
    assert caught.value.field == "task.edge_radius_m"


@pytest.mark.parametrize(("radius", "said"), [(0.0142, 0), (0.0141, 1)])
def test_long_triangles_beside_sharp_edges_are_said(radius: float, said: int) -> None:
    """From half the radius on: the diagonals of squares of 5 mm have 7.07 mm."""
    box = surface_of(trimesh.creation.box((0.01, 0.01, 0.01)).subdivide())
    notes = note_on_triangles(box, radius)
    assert len(notes) == said
    assert all("up to 7.1 mm long" in n and "(max_edge_m = 0.00705 under" in n for n in notes)


def test_a_mesh_in_a_scene_has_the_radius_of_the_tool() -> None:
    """By default the contact radius; a key replaces it; a simple shape keeps its own normals."""
    scene = shipped("wok", 500)
    task = scene.setup.task
    assert task.edge_radius_m is None and task.rounding_m == task.contact_radius_m == 0.005
    assert "edge_radius_m" not in task.model_dump()
    shape = scene.covered()
    assert not shape.faceted
    mesh = scene.with_object(trimesh.creation.box((0.02, 0.02, 0.02)).subdivide_to_size(0.004))
    given = scene.setup.varied(task=task.model_copy(update={"edge_radius_m": 0.01}))
    wider = mesh.with_setup(given)
    assert given.task.model_dump()["edge_radius_m"] == 0.01
    part = mesh.object.surface()
    for asked, radius in ((mesh, 0.005), (wider, 0.01)):
        assert (asked.covered().normals == rounded(part, radius).normals).all()
