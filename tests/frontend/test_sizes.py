"""What is too large is refused with its number before memory is spent on it."""

from __future__ import annotations

import re
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from dirty import BOX, OUTWARD, obj
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.cli import main
from cellcolor.errors import InputError
from cellcolor.frontend import build_surface
from cellcolor.frontend.contact.obstacle import BoxObstacle
from cellcolor.frontend.parts import mesh_file, surface
from cellcolor.frontend.parts.mesh_file import MeshObject
from cellcolor.frontend.parts.surface import refine
from cellcolor.frontend.scene import Scene
from cellcolor.mesh.triangle_mesh import TriangleMesh

Varied = Callable[..., Scene]


def with_object(file: Path, table: str) -> Path:
    """The scene's file with another object table."""
    text = file.read_text()
    start, end = text.index("[object]"), text.index("[placement]")
    file.write_text(f"{text[:start]}[object]\n{table}\n\n{text[end:]}")
    return file


MESH = 'kind = "mesh"\nfile = "box.obj"\n'
STRIP = 'kind = "rectangle"\nsize_x_m = 1e6\nsize_y_m = 1e-6\ntarget_vertices = 1000'
TOO_LARGE = {
    # Six sides of 0.1 m x 0.1 m in triangles of at most sqrt(3)/4 um^2, two for a vertex.
    "a micrometer": ({}, f"{MESH}meters_per_unit = 0.1\nmax_edge_m = 1e-6", "max_edge_m", 7e10),
    # The same box in millimeters, read as meters: 100 m, at 5 mm.
    "wrong unit": ({}, f"{MESH}meters_per_unit = 100.0\nmax_edge_m = 0.005", "max_edge_m", 2.8e9),
    "many vertices": (
        {}, 'kind = "rectangle"\nsize_x_m = 1.0\nsize_y_m = 1.0\ntarget_vertices = 100000000',
        "object.target_vertices", None,
    ),
    "a strip": ({}, STRIP, "target_vertices", 6e7),
    "points": ({"validity_spacing_m": 1e-7}, None, "continuity.validity_spacing_m", None),
    "probes": ({"probe_spacing_m": 1e-8}, None, "continuity.probe_spacing_m", None),
}  # fmt: skip


@pytest.mark.parametrize("name", TOO_LARGE)
def test_refused_with_the_number(
    name: str, scene_file: Callable[..., Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    setup, table, field, needed = TOO_LARGE[name]
    (tmp_path / "box.obj").write_text(obj(BOX, OUTWARD))
    file = scene_file(setup=setup, target_vertices=50)
    if table is not None:
        with_object(file, table)
    tracemalloc.start()
    code = main(["build", str(file), "-o", str(tmp_path / "out.json")])
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    (line,) = capsys.readouterr().err.splitlines()
    assert code == 2 and field in line and not (tmp_path / "out.json").exists()
    assert peak < 100e6
    numbers = [
        float(text.replace(",", "")) for text in re.findall(r"\d[\d.,]*(?:e[+-]?\d+)?", line)
    ]
    if needed is not None:
        assert any(0.8 * needed < number < 1.3 * needed for number in numbers), line


def test_a_mesh_with_too_many_vertices(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "box.obj").write_text(obj(BOX, OUTWARD))
    monkeypatch.setattr(surface, "MOST_VERTICES", 7)
    with pytest.raises(InputError, match="8 vertices, at most 7") as caught:
        MeshObject(file=str(tmp_path / "box.obj"), meters_per_unit=1.0).surface()
    assert caught.value.file == str(tmp_path / "box.obj")
    # Where corners are still to be told apart, that many faces are enough to know.
    trimesh.Trimesh(BOX, OUTWARD).export(tmp_path / "box.stl")
    monkeypatch.setattr(mesh_file, "MOST_VERTICES", 3)
    with pytest.raises(InputError, match="there are 12, at most 3 vertices"):
        MeshObject(file=str(tmp_path / "box.stl"), meters_per_unit=1.0).surface()


@given(st.integers(0, 2**32 - 1), st.sampled_from([0.5, 0.2, 0.05]))
def test_what_is_refused_would_have_been_too_much(seed: int, longest: float) -> None:
    """The estimate is no more than what halving gives, so nothing that fits is refused."""
    corners = np.random.default_rng(seed).uniform(0, 1, (4, 3))
    faces = np.array([[0, 1, 2], [1, 0, 3]])
    vertices = refine(TriangleMesh(corners, faces), longest)[0].points
    most = surface.MOST_VERTICES
    try:
        surface.MOST_VERTICES = len(vertices)
        assert len(refine(TriangleMesh(corners, faces), longest)[0].points) == len(vertices)
        surface.MOST_VERTICES = len(vertices) - 1
        if len(vertices) > 4:
            with pytest.raises(InputError, match="vertices"):
                refine(TriangleMesh(corners, faces), longest)
    finally:
        surface.MOST_VERTICES = most


def test_a_mesh_too_coarse_for_what_stands_there(scene: Varied) -> None:
    """Four vertices, and an obstacle in the middle that is narrower than the edges are long."""
    square = 0.3 * np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]) - [0.15, 0.15, 0]
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    coarse = scene(position_m=(0.45, 0.1, 0.1)).with_object((square, faces))
    (warning,) = build_surface(coarse).report.warnings
    assert "0.424 m" in warning and "'tool_body' is 0.04 m wide" in warning
    # A plate's width is not its thickness.
    plate = BoxObstacle(size_m=(0.002, 0.03, 0.2), position_m=(0.45, 0.1, 0.3))
    (warning,) = build_surface(coarse.with_obstacle(plate)).report.warnings
    assert "obstacle[0] is 0.03 m wide" in warning
    finer, _ = refine(TriangleMesh(square, faces), 0.04)
    fine = coarse.with_object((finer.points, finer.corners))
    assert build_surface(fine).report.warnings == ()
