"""Mesh files of links as they come."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import trimesh

from cellcolor.errors import InputError
from cellcolor.frontend.arm.link_mesh import load_link_mesh

UNITS = (0.001, 0.001, 0.001)


def written(folder: Path, suffix: str) -> tuple[Path, trimesh.Trimesh]:
    """A box of 10 x 20 x 30 units beside the origin; returns it in m, if a unit is 1 mm."""
    mesh = trimesh.creation.box((10, 20, 30))
    mesh.apply_translation((100, 0, 0))
    file = folder / f"link{suffix}"
    mesh.export(file)
    return file, mesh.apply_scale(0.001)


@pytest.mark.parametrize("suffix", [".stl", ".STL", ".obj", ".dae"])
def test_formats(tmp_path: Path, suffix: str) -> None:
    if suffix == ".dae":
        pytest.importorskip("collada")
    file, mesh = written(tmp_path, suffix.lower())
    vertices, faces = load_link_mesh(file.rename(file.with_suffix(suffix)), UNITS)
    assert len(vertices) == 8 and len(faces) == 12  # corners are shared, in STL as well
    read = trimesh.Trimesh(vertices, faces, process=False)
    assert np.allclose(read.bounds, mesh.bounds, atol=1e-9)
    assert read.is_watertight and read.volume == pytest.approx(mesh.volume)


def test_the_unit_of_a_collada_file_counts(tmp_path: Path) -> None:
    pytest.importorskip("collada")
    file, mesh = written(tmp_path, ".dae")
    text = file.read_text()
    file.write_text(re.sub("<up_axis>", '<unit name="inch" meter="0.0254"/><up_axis>', text))
    vertices, _ = load_link_mesh(file, UNITS)
    assert np.allclose(vertices.min(axis=0), 0.0254 * mesh.bounds[0], atol=1e-9)


def test_a_mirrored_mesh_has_its_outside_outside(tmp_path: Path) -> None:
    file, mesh = written(tmp_path, ".stl")
    vertices, faces = load_link_mesh(file, (-0.001, 0.001, 0.001))
    read = trimesh.Trimesh(vertices, faces, process=False)
    assert read.volume == pytest.approx(mesh.volume)
    assert np.allclose(read.bounds[:, 0], [-0.105, -0.095])


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.stl", b"", "cannot be read as a mesh|no triangles"),
        ("a.obj", b"v 0 0 0\n", "cannot be read as a mesh|no triangles"),
        ("a.dae", b"<COLLADA", "cannot be read as a mesh|pycollada"),
        ("a.ply", b"ply", "not a mesh format known here"),
    ],
)
def test_what_cannot_be_read_is_refused(
    tmp_path: Path, name: str, content: bytes, message: str
) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=message) as caught:
        load_link_mesh(tmp_path / name, UNITS)
    assert caught.value.file == str(tmp_path / name)
    assert "\n" not in str(caught.value)
