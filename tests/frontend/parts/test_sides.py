"""Shells are known by what lies behind their faces, and their sides are told apart."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from cellcolor.frontend.parts.cover import facing, note_on_shell, shell_sides, thickness
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.mesh.triangle_mesh import TriangleMesh


def mesh_of(shape: trimesh.Trimesh) -> TriangleMesh:
    return TriangleMesh(np.asarray(shape.vertices), np.asarray(shape.faces, dtype=np.int64))


SHEET = trimesh.creation.box((0.4, 0.3, 0.002))
PIPE = trimesh.creation.annulus(0.098, 0.1, 0.3, sections=64)


def two_sheets(apart: float) -> trimesh.Trimesh:
    """The inner and the outer skin of something, two open components."""
    points = np.array([[0, 0, 0], [0.3, 0, 0], [0.3, 0.2, 0], [0, 0.2, 0]])
    up, down = np.array([[0, 1, 2], [0, 2, 3]]), np.array([[2, 1, 0], [3, 2, 0]])
    both = np.concatenate([points, points - [0, 0, apart]])
    return trimesh.Trimesh(both, np.concatenate([up, down + 4]), process=False)


@pytest.mark.parametrize(
    ("shape", "thick"), [(SHEET, 0.002), (PIPE, 0.002), (two_sheets(0.004), 0.004)]
)
def test_shells(shape: trimesh.Trimesh, thick: float) -> None:
    mesh = mesh_of(shape)
    assert thickness(mesh) == pytest.approx(thick, rel=0.05)
    sides = shell_sides(mesh)
    assert sides is not None
    assert not (sides[0] & sides[1]).any()


@pytest.mark.parametrize(
    "shape",
    [
        trimesh.creation.box((0.4, 0.3, 0.05)),
        trimesh.creation.icosphere(2, 0.1),
        trimesh.creation.cylinder(0.1, 0.3),
        two_sheets(0.004).submesh([[0, 1]])[0],  # an open sheet has one side
        two_sheets(-0.004),  # two sheets that look at each other: the outsides are between
        two_sheets(0.1),
    ],
)
def test_what_is_no_shell(shape: trimesh.Trimesh) -> None:
    assert thickness(mesh_of(shape)) is None


def test_the_outer_side_is_the_larger_one() -> None:
    mesh = mesh_of(PIPE)
    sides = shell_sides(mesh)
    assert sides is not None
    around = np.linalg.norm(mesh.points[mesh.corners[sides[0]]][..., :2], axis=2)
    assert np.allclose(around, 0.1)
    assert np.linalg.norm(facing(mesh, sides[0])) < 1e-9


def test_both_sides_to_be_covered_are_said() -> None:
    (note,) = note_on_shell(mesh_surface(SHEET.vertices, np.asarray(SHEET.faces)))
    assert "shell, 2 mm thick" in note and "[cover]" in note
