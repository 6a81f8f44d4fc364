"""Raster paths stay on the mesh and go over all of it; the fewest changes of branch along one."""

from __future__ import annotations

import itertools
import sys
from collections.abc import Callable

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from shipped import TOP, shipped

from cellcolor.arrays import Array
from cellcolor.data.surface import LabelledSurface
from cellcolor.frontend import build_surface
from cellcolor.lab.families.meshes import grid_faces

sys.path.append(str(TOP / "benchmarks"))
from path_first import Raster, counted, fewest_lift_offs, raster

ROWS = st.lists(st.lists(st.booleans(), min_size=3, max_size=3).filter(any), min_size=1, max_size=6)
ANGLES = (0.0, 0.4, 1.0, np.pi / 2, 2.5)
SPACING = 0.02


@given(ROWS)
def test_no_choice_of_branches_changes_less_often(valid: list[list[bool]]) -> None:
    """Against every choice of one valid branch for each point."""
    choices = itertools.product(*[[b for b in range(3) if row[b]] for row in valid])
    changes = (sum(a != b for a, b in itertools.pairwise(choice)) for choice in choices)
    assert len(fewest_lift_offs(np.array(valid))) == min(changes)


@pytest.mark.second
def test_the_square_needs_no_change() -> None:
    path, reached, changes = counted(build_surface(shipped("square", 200)), 0.5)
    assert len(path.points) == len(reached) and reached.mean() > 0.95 and not len(changes)


def square() -> trimesh.Trimesh:
    """400 mm wide, in triangles of 20 mm."""
    side = np.linspace(-0.2, 0.2, 21)
    places = np.array([[x, y, 0.0] for y in side for x in side])
    return trimesh.Trimesh(places, grid_faces(21, 21), process=False)


def path_over(
    mesh: trimesh.Trimesh, angle: float, reachable: Callable[[Array], Array] | None = None
) -> Raster:
    """A raster over the vertices that a test of their places (n, 3) lets through."""
    surface = LabelledSurface(
        "mesh", ("a",), mesh.vertices, mesh.faces, ((0,),) * len(mesh.vertices)
    )
    there = np.ones(len(mesh.vertices), bool) if reachable is None else reachable(mesh.vertices)
    return raster(surface, mesh.vertex_normals, there, angle, SPACING)


@pytest.mark.parametrize("angle", ANGLES)
def test_a_square(angle: float) -> None:
    """Straight passes at the spacing; seen from the middle, so that none is longer than needed."""
    path = path_over(square(), angle)
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
