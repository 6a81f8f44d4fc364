"""OBJ files of all habits are one mesh; what no mesh file may have."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
import trimesh
from dirty import BOX, OUTWARD, obj
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from cellcolor.deadline import NEVER
from cellcolor.errors import InputError
from cellcolor.frontend.parts.mesh_file import MeshObject, read_mesh, read_obj, triangulated
from cellcolor.mesh.triangle_mesh import TriangleMesh

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def read(tmp_path: Path, text: str) -> tuple[list[list[float]], list[list[int]]]:
    file = tmp_path / "mesh.obj"
    file.write_text(text)
    vertices, faces = read_obj(file, NEVER)
    return vertices.tolist(), faces.tolist()


def test_materials_objects_and_groups_are_one_mesh(tmp_path: Path) -> None:
    """A box of which every face has a group, a material and texture corners of its own."""
    lines = obj(BOX, OUTWARD).splitlines()
    faces = [line.split()[1:] for line in lines if line.startswith("f")]
    text = "\n".join([line for line in lines if line.startswith("v")] + ["vt 0 0", "vt 1 0"])
    for number, (a, b, c) in enumerate(faces):
        text += f"\no part{number}\ng group{number}\nusemtl color{number % 2}\ns off"
        text += f"\nf {a}/{1 + number % 2}/1 {b}//1 {c}/2"
    (tmp_path / "box.obj").write_text(f"mtllib none.mtl\n{text}\n")
    (tmp_path / "plain.obj").write_text("\n".join(lines))
    parted, plain = (
        MeshObject(file=str(tmp_path / name), meters_per_unit=0.1).surface()
        for name in ("box.obj", "plain.obj")
    )
    assert np.array_equal(parted.vertices, plain.vertices)
    assert np.array_equal(parted.faces, plain.faces)


@pytest.mark.parametrize(
    "face",
    ["f 1 2 3 4", "f -4 -3 -2 -1", "f 1/1 2/2 3/3 4/4 # a comment", "f 1 2 \\\n 3 4"],
)
def test_four_corners(tmp_path: Path, face: str) -> None:
    assert read(tmp_path, SQUARE + face)[1] == [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("f 1 2 5", "no vertex 5"),
        ("f 1 2 0", "no vertex 0"),
        ("f -5 1 2", "no vertex -5"),
        ("f 1 2", "three corners"),
        ("f 1 2 x", "'x'"),
        ("v 1 2", "three coordinates"),
        ("v 1 2 z", "'z'"),
        (f"f 1 2 {'9' * 5000}", "digits"),
    ],
)
def test_faults_name_the_line(tmp_path: Path, line: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        read(tmp_path, SQUARE + line + "\n")
    assert (caught.value.file, caught.value.field) == (str(tmp_path / "mesh.obj"), "line 5")


L = [(-1.0, -1.0), (1.0, -1.0), (1.0, 0.0), (0.0, 0.0), (0.0, 1.0), (-1.0, 1.0)]  # area 3


def outline_in_space(turns: float, first: int) -> str:
    """The L turned about an axis that is none of the file's, as one face from some corner on."""
    axis = np.array([1.0, 2.0, 2.0]) / 3
    points = Rotation.from_rotvec(turns * axis).apply([(*point, 0.0) for point in L])
    face = " ".join(str(1 + (first + k) % 6) for k in range(6))
    return "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist()) + f"f {face}\n"


@pytest.mark.parametrize("first", range(6))
@pytest.mark.parametrize("turns", [0.0, 1.0, 2.5])
def test_a_concave_face_is_filled_and_nothing_else(
    tmp_path: Path, turns: float, first: int
) -> None:
    file = tmp_path / "ngon.obj"
    file.write_text(outline_in_space(turns, first))
    mesh = TriangleMesh(*read_mesh(file))
    assert len(mesh.corners) == 4
    assert mesh.areas.sum() == pytest.approx(3.0)  # 2 x 2 less 1 x 1
    assert np.linalg.norm(mesh.area_vectors.sum(axis=0)) == pytest.approx(6.0)  # all wound alike


@pytest.mark.parametrize("binary", [True, False])
def test_a_concave_face_of_a_ply_file(tmp_path: Path, binary: bool) -> None:
    kind = "binary_little_endian" if binary else "ascii"
    head = f"ply\nformat {kind} 1.0\nelement vertex 6\n"
    head += "".join(f"property float {axis}\n" for axis in "xyz")
    head += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    face = [2, 3, 4, 5, 0, 1]
    lines = "".join(f"{x} {y} 0\n" for x, y in L) + f"6 {' '.join(map(str, face))}\n"
    packed = np.array([(*point, 0.0) for point in L], dtype="<f4").tobytes()
    packed += b"\x06" + np.array(face, dtype="<i4").tobytes()
    file = tmp_path / "ngon.ply"
    file.write_bytes(head.encode() + (packed if binary else lines.encode()))
    assert TriangleMesh(*read_mesh(file)).areas.sum() == pytest.approx(3.0)


@settings(deadline=None, max_examples=100)
@given(st.lists(st.floats(0.2, 1.0), min_size=4, max_size=40))
def test_stars_are_filled(radii: list[float]) -> None:
    """Around the middle no triangle of a star leaves it, so its area is the sum of theirs."""
    angles = 2 * np.pi * np.arange(len(radii)) / len(radii)
    points = (
        np.column_stack([np.cos(angles), np.sin(angles), 0 * angles]) * np.array(radii)[:, None]
    )
    area = np.sin(2 * np.pi / len(radii)) * np.sum(radii * np.roll(radii, 1)) / 2
    corners, sizes = np.arange(len(radii)), np.array([len(radii)])
    found = TriangleMesh(points, triangulated(points, corners, sizes, str))
    assert found.areas.sum() == pytest.approx(area)


@pytest.mark.parametrize(("degrees", "refused"), [(0, False), (25, False), (35, True), (80, True)])
def test_a_face_that_is_far_from_flat_is_named(
    degrees: float, refused: bool, tmp_path: Path
) -> None:
    """A square folded along its diagonal: each half is so far off the whole."""
    half = np.radians(degrees)
    aside = np.array([0, np.cos(half), np.sin(half)])
    points = np.array([[-1, 0, 0], -aside * [0, 1, -1], [1, 0, 0], aside])
    rows = ["v {} {} {}".format(*point) for point in points.tolist()]
    file = tmp_path / "folded.obj"
    file.write_text("\n".join([*rows, "f 1 2 3 4"]))
    if not refused:
        assert len(read_mesh(file)[1]) == 2
        return
    with pytest.raises(
        InputError, match=f"4 corners is far from flat.* {degrees} degrees"
    ) as caught:
        read_mesh(file)
    assert caught.value.field == "line 5"


def test_a_face_that_crosses_itself_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="face of 4 corners crosses itself") as caught:
        read(tmp_path, SQUARE + "f 1 2 3\nf 1 3 2 4\n")
    assert caught.value.field == "line 6"


def test_a_fold_is_named_by_a_face_of_the_file(tmp_path: Path) -> None:
    """Two faces on each other have no normal in the middle of an edge that is halved."""
    file = tmp_path / "fold.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.1 1 0\nf 1 2 3\nf 2 1 4\n")
    with pytest.raises(InputError, match=r"no normal at \(0.5, 0, 0\) m") as caught:
        MeshObject(file=str(file), meters_per_unit=1.0, max_edge_m=0.6).surface()
    assert caught.value.field in ("faces[0]", "faces[1]")


@pytest.mark.parametrize(
    ("suffix", "place"),
    [(".obj", "line 4"), (".stl", "faces[1]"), (".ply", "vertices[3]")],
)
@pytest.mark.parametrize("wrong", ["nan", "inf"])
def test_a_coordinate_that_is_no_number(
    suffix: str, place: str, wrong: str, tmp_path: Path
) -> None:
    """The fourth vertex, which only the second face has."""
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, float(wrong), 0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    file = tmp_path / f"part{suffix}"
    if suffix == ".obj":
        lines = ["v " + " ".join(map(str, point)) for point in points.tolist()]
        file.write_text("\n".join([*lines, "f 1 2 3", "f 1 3 4"]))
    else:
        trimesh.Trimesh(points, faces, process=False).export(file)
    with warnings.catch_warnings(), pytest.raises(InputError, match="not a finite") as caught:
        warnings.simplefilter("error")
        read_mesh(file)
    assert (caught.value.file, caught.value.field) == (str(file), place)
