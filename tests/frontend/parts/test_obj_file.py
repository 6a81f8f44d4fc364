"""OBJ files of all habits are one mesh."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from dirty import BOX, OUTWARD, obj

from cellcolor.deadline import NEVER
from cellcolor.errors import InputError
from cellcolor.frontend.parts.mesh_file import load_mesh, read_obj

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
    parted, plain = (load_mesh(tmp_path / name, 0.1) for name in ("box.obj", "plain.obj"))
    assert np.array_equal(parted.vertices, plain.vertices)
    assert np.array_equal(parted.faces, plain.faces)


@pytest.mark.parametrize(
    "face",
    ["f 1 2 3 4", "f -4 -3 -2 -1", "f 1/1 2/2 3/3 4/4 # a comment", "f 1 2 \\\n 3 4"],
)
def test_four_corners(tmp_path: Path, face: str) -> None:
    assert read(tmp_path, SQUARE + face)[1] == [[0, 1, 2], [0, 2, 3]]


def test_what_a_vertex_has_besides_its_place_is_left(tmp_path: Path) -> None:
    text = "v 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nf 1 2 3\n"
    assert read(tmp_path, text)[0] == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


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
