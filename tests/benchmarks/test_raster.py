"""Raster paths stay on the mesh, go over all of it, and part only where it falls apart."""

from __future__ import annotations

import sys

import numpy as np
import pytest
import trimesh
from shipped import TOP

from cellcolor.arrays import Array
from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families.meshes import grid_faces

sys.path.append(str(TOP / "benchmarks"))
from raster import Raster, raster

ANGLES = (0.0, 0.4, 1.0, np.pi / 2, 2.5)
SPACING = 0.02


def labelled(mesh: trimesh.Trimesh) -> LabelledSurface:
    colors = ((0,),) * len(mesh.vertices)
    return LabelledSurface("mesh", ("a",), mesh.vertices, mesh.faces, colors)


def square() -> trimesh.Trimesh:
    """400 mm wide, in triangles of 20 mm."""
    side = np.linspace(-0.2, 0.2, 21)
    places = np.array([[x, y, 0.0] for y in side for x in side])
    return trimesh.Trimesh(places, grid_faces(21, 21), process=False)


def steps(path: Raster) -> Array:
    """The middles of all steps along the path."""
    middles = (path.points[1:] + path.points[:-1]) / 2
    kept = np.ones(len(middles), dtype=bool)
    kept[path.starts[1:] - 1] = False
    return np.asarray(middles[kept])


@pytest.mark.parametrize("angle", ANGLES)
def test_a_square(angle: float) -> None:
    """Straight passes at the spacing; seen from the middle, so that none is longer than needed."""
    mesh = square()
    up = np.tile([0.0, 0.0, 1.0], (len(mesh.vertices), 1))
    everywhere = np.ones(len(up), dtype=bool)
    path = raster(labelled(mesh), up, everywhere, angle, SPACING)
    assert path.starts.tolist() == [0]
    assert np.allclose(path.normals, [0, 0, 1])
    far = np.random.default_rng(1).uniform(-0.2, 0.2, (500, 2))
    away = np.linalg.norm(far[:, None] - path.points[None, :, :2], axis=2).min(axis=1)
    # Half a spacing to a pass or to the border, which may cut a corner off, and half a step.
    assert away.max() < SPACING / 2 * np.sqrt(2) + 0.002
    length = np.linalg.norm(np.diff(path.points, axis=0), axis=1)
    assert length.max() <= 0.0025 + 1e-12
    # Passes have the area divided by the spacing as their length; ways between add less than two
    # borders of the square.
    assert 0.95 * 0.16 / SPACING < length.sum() < 0.16 / SPACING + 2 * 1.6


@pytest.mark.parametrize("angle", ANGLES)
def test_a_closed_surface(angle: float) -> None:
    """Every step lies on the mesh, and normals are interpolated."""
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=0.1)
    path = raster(
        labelled(mesh), mesh.vertices / 0.1, np.ones(len(mesh.vertices), bool), angle, SPACING
    )
    assert path.starts.tolist() == [0]
    for place in steps(path)[::31]:
        on_each = trimesh.triangles.closest_point(
            mesh.triangles, np.tile(place, (len(mesh.faces), 1))
        )
        assert np.linalg.norm(on_each - place, axis=1).min() < 1e-9
    assert np.einsum("ij,ij->i", path.normals, path.points / 0.1).min() > 0.98
    assert np.allclose(np.linalg.norm(path.normals, axis=1), 1.0)


@pytest.mark.parametrize("angle", ANGLES)
def test_what_is_out_of_reach_is_gone_round(angle: float) -> None:
    mesh = square()
    up = np.tile([0.0, 0.0, 1.0], (len(mesh.vertices), 1))
    away = np.linalg.norm(mesh.vertices, axis=1)
    path = raster(labelled(mesh), up, away > 0.1, angle, SPACING)
    assert path.starts.tolist() == [0]
    # Triangles with a vertex in the disc are left out, so steps keep off it but for their chords.
    assert np.linalg.norm(steps(path), axis=1).min() > 0.1 * np.cos(0.15)


def test_a_surface_in_two_parts() -> None:
    mesh = square()
    up = np.tile([0.0, 0.0, 1.0], (len(mesh.vertices), 1))
    apart = np.abs(mesh.vertices[:, 0]) > 0.05
    beside, across = (raster(labelled(mesh), up, apart, a, SPACING) for a in (0.0, np.pi / 2))
    # Along the gap one part comes after the other; across it every pass is parted.
    numbers = sorted(len(path.starts) for path in (beside, across))
    assert numbers[0] == 2 and numbers[1] > 10
    for path in (beside, across):
        assert np.abs(steps(path)[:, 0]).min() > 0.05
