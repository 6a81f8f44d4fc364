"""By how much hulls and capsules are off, on shapes of which that is known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from cellcolor.errors import InputError
from cellcolor.frontend.arm.body import Body, StandIn, mesh_bodies
from cellcolor.frontend.arm.capsules import capsule_around
from cellcolor.frontend.contact.stand_in_report import StandInReport, report_on
from cellcolor.frontend.setup import MeshCollision

pytestmark = pytest.mark.second


def reported(mesh: trimesh.Trimesh, chosen: MeshCollision) -> StandInReport:
    vertices, faces = np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64)
    return report_on(mesh_bodies("link", 1, Path("folder/link.stl"), vertices, faces, chosen))


def test_the_hull_of_a_groove_is_off_by_half_its_width() -> None:
    """Two boxes 40 mm apart: halfway between them the hull is 20 mm from both."""
    boxes = [trimesh.creation.box((0.05, 0.1, 0.08)) for _ in range(2)]
    boxes[1].apply_translation((0.09, 0, 0))
    report = reported(trimesh.util.concatenate(boxes), "hull")
    assert report.contains and report.shapes == 1
    assert report.error_m - report.known_to_m <= 0.02 <= report.error_m
    assert report.known_to_m < 0.002
    assert str(report).startswith("'link': convex hull of link.stl, contains it, at most 2")


def test_the_hull_of_what_is_convex_is_the_mesh() -> None:
    report = reported(trimesh.creation.icosphere(radius=0.1), "hull")
    assert report.contains and report.error_m <= report.known_to_m


def test_the_mesh_itself_is_not_off() -> None:
    report = reported(trimesh.creation.torus(0.1, 0.02), "exact")
    assert report.error_m == 0 and report.contains
    assert str(report) == "'link': link.stl, as it is"


def test_of_an_open_mesh_that_is_said() -> None:
    ring = trimesh.creation.cylinder(radius=0.1, height=0.1)
    ring.update_faces(np.abs(ring.face_normals[:, 2]) < 0.5)
    assert str(reported(ring, "exact")).endswith("what is all inside it goes unnoticed")


def test_a_capsule_around_a_cylinder_is_off_at_its_ends() -> None:
    """Of a cylinder of radius r and length l >> r the ends of a capsule are some of r beyond."""
    report = reported(trimesh.creation.cylinder(radius=0.05, height=0.6, sections=48), "capsules")
    assert report.contains
    assert 0.02 < report.error_m < 0.06


@pytest.mark.slow
def test_capsules_are_not_off_where_they_overlap() -> None:
    """Of an L two capsules follow the arms; what of one is inside the other does not count."""
    arms = [trimesh.creation.capsule(height=0.4, radius=0.05, count=(12, 12)) for _ in range(2)]
    arms[1].apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (0, 1, 0)))
    cross = trimesh.util.concatenate(arms)
    report = reported(cross, "capsules")
    vertices, faces = np.array(cross.vertices), np.array(cross.faces, dtype=np.int64)
    body = Body("link", 1, *capsule_around(vertices), flat=False)
    one = report_on(StandIn("link", Path("link.stl"), "capsules", vertices, faces, (body,)))
    assert report.contains and report.shapes >= 2
    assert report.error_m < 0.5 * one.error_m


@pytest.mark.slow
def test_faces_are_cut_between_capsules() -> None:
    """A square plate of 12 faces: a capsule around whole ones goes 0.2 m off."""
    report = reported(trimesh.creation.box((0.4, 0.4, 0.02)), "capsules")
    assert report.contains
    assert report.error_m < 0.1


@pytest.mark.parametrize(("gap", "held"), [(-0.001, True), (0.001, False)])
def test_a_face_between_capsules_is_held_if_they_meet(gap: float, held: bool) -> None:
    """A bar: both ends are in a capsule, and the middle if these overlap."""
    bar = trimesh.creation.box((0.4, 0.02, 0.02))
    vertices, faces = np.array(bar.vertices), np.array(bar.faces, dtype=np.int64)
    radius = 0.05
    inner = gap / 2 + np.sqrt(radius**2 - 2 * 0.01**2)  # where the ball meets the bar's edges
    bodies = tuple(
        Body("link", 1, np.array([side * inner, 0, 0]), np.array([side * 0.2, 0, 0]), radius, False)
        for side in (-1, 1)
    )
    report = report_on(StandIn("link", Path("link.stl"), "capsules", vertices, faces, bodies))
    assert report.contains == held


def test_a_flat_mesh_has_no_hull() -> None:
    sheet = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 1, 2]])
    with pytest.raises(InputError, match="'exact'") as caught:
        reported(sheet, "hull")
    assert caught.value.file == "folder/link.stl"


@pytest.mark.parametrize(("gap", "said"), [(0.1, True), (0.03, False)])
def test_a_hull_that_is_far_off_is_warned_of(gap: float, said: bool) -> None:
    """Two plates apart by a gap: the middle of it is half of it off the mesh."""
    plates = [trimesh.creation.box((0.3, 0.3, 0.01)) for _ in range(2)]
    plates[1].apply_translation([0, 0, gap + 0.01])
    both = trimesh.util.concatenate(plates)
    report = reported(both, "hull")
    assert (report.warning is not None) == said
    if report.warning is not None:
        assert "more than 4" in report.warning and '"exact"' in report.warning
    assert reported(both, "exact").warning is None
