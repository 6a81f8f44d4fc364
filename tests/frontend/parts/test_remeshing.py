"""Remeshing: lengths, sharp edges, borders and the deviation, against other computations."""

from __future__ import annotations

import subprocess
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import trimesh
from shipped import TOP

pytest.importorskip("gpytoolbox", reason="the extra 'parts' is not installed")

from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import InputError
from cellcolor.frontend.parts import remeshing, surface
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.mesh_file import read_mesh
from cellcolor.frontend.parts.repairing import repair_mesh
from cellcolor.frontend.parts.shapes import grid_mesh

pytestmark = pytest.mark.slow


def lengths(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    return np.linalg.norm(vertices[faces] - np.roll(vertices[faces], 1, axis=1), axis=2)


def test_a_part_with_sharp_edges() -> None:
    """The bracket, in millimeters, to edges of 6 mm: its sharp corners stay."""
    vertices, faces = read_mesh(TOP / "instances" / "parts" / "bracket.obj")
    made = repair_mesh(vertices, faces, 0.001, edge_length_m=0.006)
    found = lengths(made.vertices, made.faces)
    assert 5.5 < np.median(found) < 6.5 and found.max() < 15
    assert made.area_m2 == pytest.approx(made.area_before_m2, rel=1e-3)
    assert (abs(np.ptp(made.vertices, axis=0) - np.ptp(vertices, axis=0)) < 1e-6).all()
    mesh_surface(made.vertices, made.faces, 0.001)
    # The deviation once more, by trimesh's own search over all faces for a few points.
    assert made.deviation is not None
    old = trimesh.Trimesh(vertices, faces, process=False)
    some = made.vertices[::40]
    _, distance, _ = trimesh.proximity.closest_point_naive(old, some)
    assert distance.max() / 1000 <= made.deviation.greatest_back + 1e-9
    assert 0 < made.deviation.mean_back < made.deviation.greatest_back < 0.002
    assert 0 < made.deviation.mean < made.deviation.greatest < 0.002
    assert "remeshed to edges of about 6 mm" in str(made)


@pytest.mark.parametrize("length", [0.003, 0.005])
def test_a_part_whose_sharp_edges_fold(length: float) -> None:
    """A thin ring: remeshed faces lie back on others, on some meshes so that normals cancel out."""
    ring = trimesh.creation.annulus(0.048, 0.05, 0.002, sections=24)
    made = repair_mesh(np.array(ring.vertices), np.array(ring.faces), edge_length_m=length)
    new = trimesh.Trimesh(made.vertices, made.faces, process=False)
    assert new.is_watertight and new.is_winding_consistent
    assert np.degrees(new.face_adjacency_angles.max()) < 150
    # What is said of the deviation is of the mesh that is handed out.
    assert made.deviation is not None
    _, distance, _ = trimesh.proximity.closest_point_naive(ring, made.vertices[::7])
    assert distance.max() <= made.deviation.greatest_back + 1e-9 < length
    _, distance, _ = trimesh.proximity.closest_point_naive(new, ring.vertices)
    assert distance.max() <= made.deviation.greatest + 1e-9 < 1.5 * length


def test_holes_torn_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """A remesher that loses a face; nothing is handed out with a hole that was not there."""
    ball = trimesh.creation.icosphere(2)
    ask = remeshing.run_alone

    def losing(*asked: Any) -> Any:
        ended = ask(*asked)
        points, corners = ended.value
        return replace(ended, value=(points, corners[1:]))

    monkeypatch.setattr(remeshing, "run_alone", losing)
    with pytest.raises(InputError, match="tore holes into the mesh; shorter edges") as caught:
        repair_mesh(np.array(ball.vertices), np.array(ball.faces), edge_length_m=0.4)
    assert caught.value.field == "edge_length_m"


def test_a_coarse_border_is_halved_and_stays_where_it_is() -> None:
    """A square of two triangles: its border and area stay, its edges become 50 mm."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    made = repair_mesh(corners, np.array([[0, 1, 2], [0, 2, 3]]), edge_length_m=0.05)
    assert made.area_m2 == pytest.approx(1.0) and made.holes == 1
    assert lengths(made.vertices, made.faces).max() < 0.11
    assert made.deviation is not None and made.deviation.greatest < 1e-9


def test_a_mesh_with_more_vertices_than_fit_is_made_coarser(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An open one, whose border is fine enough: only what comes out has to fit."""
    grid, faces = grid_mesh(1.0, 1.0, 1000, 0.0, 0)
    flat = np.column_stack([grid, np.zeros(len(grid))])
    monkeypatch.setattr(surface, "MOST_VERTICES", 700)
    with pytest.raises(InputError, match="at most 700 fit"):
        repair_mesh(flat, faces)
    made = repair_mesh(flat, faces, edge_length_m=0.06)
    assert len(made.vertices) < 600 and made.area_m2 == pytest.approx(1.0)


@pytest.mark.parametrize(("length", "message"), [(1e-4, "gives about 115,470,054"), (2.0, "10 to")])
def test_what_would_be_too_many_or_too_few(length: float, message: str) -> None:
    """Refused before anything is begun."""
    grid, faces = grid_mesh(1.0, 1.0, 100, 0.0, 0)
    flat = np.column_stack([grid, np.zeros(len(grid))])
    with pytest.raises(InputError, match=message) as caught:
        repair_mesh(flat, faces, edge_length_m=length)
    assert caught.value.field == "edge_length_m"


def test_the_deadline_ends_the_other_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """A second after it was begun; it would take many."""
    grid, faces = grid_mesh(1.0, 1.0, 40_000, 0.0, 0)
    flat = np.column_stack([grid, 0.1 * np.sin(9 * grid[:, 0])])
    children = []
    begin = subprocess.Popen

    def noted(*arguments: Any, **options: Any) -> Any:
        children.append(begin(*arguments, **options))
        return children[-1]

    monkeypatch.setattr(subprocess, "Popen", noted)
    said: list[str] = []
    with pytest.raises(OutOfTime):
        remeshing.remeshed(flat, faces, 0.004, Deadline.after(1.5), said.append)
    assert said[-1].startswith("remeshing to about ")
    (child,) = children
    assert child.returncode is not None
