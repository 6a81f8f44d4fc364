"""Generated and read surfaces: shape, orientation, and what is refused."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.parts.mesh_file import MeshObject
from cellcolor.frontend.parts.placement import Placement
from cellcolor.frontend.parts.shapes import CapObject, PipeObject, disc_mesh, grid_mesh
from examples import examples


def double_areas(points: Array, faces: Array) -> Array:
    a, b, c = (points[faces[:, k]] for k in range(3))
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


@given(st.integers(7, 3000), st.floats(0, 0.25), st.integers(0, 10**6))
@examples(25)
def test_disc_is_a_counter_clockwise_disc(target: int, jitter: float, seed: int) -> None:
    points, faces = disc_mesh(target, jitter, seed)
    assert (double_areas(points, faces) > 0).all()
    ends = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, uses = np.unique(ends, axis=0, return_counts=True)
    rim = np.unique(edges[uses == 1])
    assert len(points) - len(edges) + len(faces) == 1
    assert np.allclose(np.linalg.norm(points[rim], axis=1), 1)
    assert len(rim) == (uses == 1).sum()
    # No other possible size is nearer to the target.
    k = np.arange(1, 60)
    assert abs(len(points) - target) == np.abs(1 + 3 * k * (k + 1) - target).min()


@given(
    st.floats(0.1, 10),
    st.floats(0.1, 10),
    st.integers(7, 3000),
    st.floats(0, 0.25),
    st.integers(0, 10**6),
)
@examples(25)
def test_grid_is_a_counter_clockwise_rectangle(
    width: float, height: float, target: int, jitter: float, seed: int
) -> None:
    points, faces = grid_mesh(width, height, target, jitter, seed)
    areas = double_areas(points, faces)
    assert (areas > 0).all() and areas.sum() / 2 == pytest.approx(width * height)
    assert np.unique(faces).tolist() == list(range(len(points)))
    box = np.vstack([points.min(axis=0), points.max(axis=0)])
    assert np.allclose(box, [[0, 0], [width, height]])
    if 0.5 < width / height < 2 and target > 100:
        assert 0.8 < len(points) / target < 1.25


def test_pipe() -> None:
    sizes = {"radius_m": 0.083, "length_m": 0.315, "arc_rad": np.pi}
    half = PipeObject(**sizes, target_vertices=2000, jitter=0.15, seed=1).surface()
    assert np.allclose(np.hypot(half.vertices[:, 0], half.vertices[:, 2]), 0.083)
    assert half.vertices[:, 2].min() == pytest.approx(0, abs=1e-12)
    assert abs(half.vertices[:, 1]).max() == pytest.approx(0.315 / 2)
    assert half.vertices[np.argmax(half.vertices[:, 2]), 2] == pytest.approx(0.083, rel=1e-3)
    mesh = trimesh.Trimesh(half.vertices, half.faces, process=False)
    outward = mesh.triangles_center * [1, 0, 1]
    assert ((mesh.face_normals * outward).sum(axis=1) > 0).all()
    assert mesh.area == pytest.approx(np.pi * 0.083 * 0.315, rel=0.01)
    nearest = (mesh.vertex_normals * half.normals).sum(axis=1)
    assert nearest.min() > 0.98


@pytest.mark.parametrize("half_angle", [0.3, 1.134, np.pi / 2, 2.5])
def test_cap(half_angle: float) -> None:
    cap = CapObject(
        radius_m=0.2, half_angle_rad=half_angle, target_vertices=2000, jitter=0.15, seed=3
    ).surface()
    assert np.allclose(np.linalg.norm(cap.vertices, axis=1), 0.2)
    assert np.allclose(cap.normals, cap.vertices / 0.2)
    assert np.arccos(cap.normals[:, 2]).max() == pytest.approx(half_angle)
    # Seen from outside the faces run counter-clockwise, and the area is the cap's.
    mesh = trimesh.Trimesh(cap.vertices, cap.faces, process=False)
    assert ((mesh.face_normals * mesh.triangles_center).sum(axis=1) > 0).all()
    assert mesh.area == pytest.approx(2 * np.pi * 0.2**2 * (1 - np.cos(half_angle)), rel=0.01)
    assert cap.mesh.vertex_areas.sum() == pytest.approx(mesh.area)
    assert np.array_equal(cap.mesh.edges, np.unique(np.sort(mesh.edges_unique, axis=1), axis=0))


def test_placement_is_extrinsic_xyz() -> None:
    cap = CapObject(radius_m=0.2, half_angle_rad=1.0, target_vertices=100, jitter=0.1).surface()
    place = Placement(position_m=(1.0, 2.0, 3.0), rpy_rad=(0.3, -0.5, 0.8))
    turn = Rotation.from_euler("xyz", [0.3, -0.5, 0.8])
    placed = cap.placed(place)
    assert np.allclose(placed.vertices, turn.apply(cap.vertices) + np.array([1, 2, 3]))
    assert np.allclose(placed.normals, turn.apply(cap.normals))


TETRA = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
OUTWARD = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]


def write_obj(file: Path, vertices: Array, faces: list[list[int]]) -> Path:
    lines = ["v " + " ".join(map(str, v)) for v in np.asarray(vertices).tolist()]
    lines += ["f " + " ".join(str(k + 1) for k in face) for face in faces]
    file.write_text("\n".join(lines) + "\n")
    return file


@pytest.mark.parametrize(
    ("vertices", "faces", "element", "message"),
    [
        (TETRA, [face[::-1] for face in OUTWARD], "faces", "inside out"),
        (TETRA, [OUTWARD[0], OUTWARD[1][::-1]], r"faces\[", "winds the other way"),
        (TETRA, [*OUTWARD, [0, 1, 2]], r"faces\[", "not manifold"),
        (np.vstack([TETRA, [[0, 0, -1]]]), [[0, 1, 2], [0, 3, 4]], "vert", "fan|pinch"),
        (np.vstack([TETRA, [[5, 5, 5]]]), OUTWARD, r"vertices\[4\]", "belongs to no face"),
        (np.vstack([TETRA, TETRA[:1]]), [*OUTWARD[1:], [4, 2, 1]], r"vertices\[4\]", "vertex 0"),
        (np.vstack([TETRA[:3], [[2, 0, 0]]]), [[0, 1, 2], [1, 0, 3]], r"faces\[1\]", "no area"),
        (TETRA[:3], [[0, 1, 2], [0, 2, 1]], r"vertices\[0\]", "no normal"),
        (np.where(TETRA == 1, np.nan, TETRA), OUTWARD, "line 2", "finite"),
        (TETRA[:3], [], "faces", "there are none"),
    ],
)  # fmt: skip
def test_bad_meshes_are_refused(
    tmp_path: Path, vertices: Array, faces: list[list[int]], element: str, message: str
) -> None:
    file = write_obj(tmp_path / "bad.obj", vertices, faces)
    with pytest.raises(InputError, match=message) as caught:
        MeshObject(file=str(file), meters_per_unit=1.0).surface()
    assert caught.value.file == str(file)
    assert re.match(element, caught.value.field or "")


def test_unreadable_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such mesh file"):
        MeshObject(file=str(tmp_path / "none.stl"), meters_per_unit=1.0).surface()
    other = tmp_path / "mesh.step"
    other.write_text("x")
    with pytest.raises(InputError, match="not a mesh format"):
        MeshObject(file=str(other), meters_per_unit=1.0).surface()
    broken = tmp_path / "broken.ply"
    broken.write_text("ply\nformat ascii 1.0\nelement vertex 3\n")
    with pytest.raises(InputError) as caught:
        MeshObject(file=str(broken), meters_per_unit=1.0).surface()
    assert caught.value.file == str(broken)


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply"])
def test_mesh_files(tmp_path: Path, suffix: str) -> None:
    cap = CapObject(radius_m=200.0, half_angle_rad=1.2, target_vertices=500, jitter=0.1).surface()
    file = tmp_path / f"cap.{suffix}"
    trimesh.Trimesh(cap.vertices, cap.faces, process=False).export(file)
    read = MeshObject(file=str(file), meters_per_unit=0.001).surface()
    assert (len(read.vertices), len(read.faces)) == (len(cap.vertices), len(cap.faces))
    assert np.allclose(np.linalg.norm(read.vertices, axis=1), 0.2, atol=1e-6)
    # Normals from the faces point outward, near the sphere's own.
    assert ((read.normals * read.vertices).sum(axis=1) / 0.2 > 0.98).all()
