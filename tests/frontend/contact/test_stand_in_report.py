"""By how much hulls are off, on shapes of which that is known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from cellcolor.errors import InputError
from cellcolor.frontend.arm.body import MeshBody, mesh_body
from cellcolor.frontend.setup import MeshCollision

pytestmark = pytest.mark.second


def reported(mesh: trimesh.Trimesh, chosen: MeshCollision) -> MeshBody:
    vertices, faces = np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64)
    return mesh_body("link", 1, Path("folder/link.stl"), vertices, faces, chosen)


@pytest.mark.parametrize(("apart", "warned"), [(0.039, False), (0.042, True)])
def test_the_hull_of_a_groove_is_off_by_half_its_width(apart: float, warned: bool) -> None:
    """Halfway between two boxes the hull is as far from both."""
    boxes = [trimesh.creation.box((0.05, 0.1, 0.08)) for _ in range(2)]
    boxes[1].apply_translation((0.05 + apart, 0, 0))
    report = reported(trimesh.util.concatenate(boxes), "hull")
    assert apart / 2 - 0.0005 <= report.off_m <= apart / 2
    assert str(report).startswith("'link': convex hull of link.stl, up to ")
    assert (report.warning is not None) == warned


def test_the_hull_of_what_is_convex_is_the_mesh() -> None:
    assert reported(trimesh.creation.icosphere(radius=0.1), "hull").off_m < 1e-6


def test_the_mesh_itself_is_not_off() -> None:
    report = reported(trimesh.creation.torus(0.1, 0.02), "exact")
    assert report.off_m == 0 and report.warning is None
    assert str(report) == "'link': link.stl, as it is"


def test_of_an_open_mesh_that_is_said() -> None:
    ring = trimesh.creation.cylinder(radius=0.1, height=0.1)
    ring.update_faces(np.abs(ring.face_normals[:, 2]) < 0.5)
    assert str(reported(ring, "exact")).endswith("what is all inside it goes unnoticed")


def test_a_flat_mesh_has_no_hull() -> None:
    flat = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(InputError, match="lies in a plane"):
        reported(flat, "hull")
    assert reported(flat, "exact").chosen == "exact"
