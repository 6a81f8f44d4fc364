"""``cellcolor label``: joint solutions in files become a labelled surface."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cellcolor.cli import main
from cellcolor.data.surface import LabelledSurface

VERTICES = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]]
FACES = [[0, 1, 2]]
SOLUTIONS = [[[0.0, 1.0], [2.0, -1.0]], [[2.1, -1.0], [0.1, 1.0]], [[0.0, 1.1]]]
ARCHIVE = {
    "vertices": np.array(VERTICES),
    "faces": np.array(FACES),
    "configurations": np.concatenate([np.array(own) for own in SOLUTIONS]),
    "offsets": np.array([0, 2, 4, 5]),
}
OBJECT = {"vertices": VERTICES, "faces": FACES, "configurations": SOLUTIONS}
ROWS = "vertex,j1,j2\n" + "".join(
    f"{vertex},{one},{two}\n" for vertex, own in enumerate(SOLUTIONS) for one, two in own
)
MESH = "".join(f"v {x} {y} {z}\n" for x, y, z in VERTICES) + "f 1 2 3\n"


@pytest.mark.parametrize("ending", ["npz", "json", "csv"])
def test_a_file_of_joint_solutions_is_labelled(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], ending: str
) -> None:
    source, output, mesh = tmp_path / f"own.{ending}", tmp_path / "s.json", tmp_path / "mesh.obj"
    arguments = ["label", str(source), "-o", str(output)]
    if ending == "npz":
        np.savez(source, **ARCHIVE)  # type: ignore[arg-type]
    elif ending == "json":
        source.write_text(json.dumps(OBJECT))
    else:
        source.write_text(ROWS)
        mesh.write_text(MESH)
        arguments += ["--mesh", str(mesh)]
    assert main(arguments) == 0
    found = LabelledSurface.read(output)
    assert found.vertex_colors == ((0, 1), (0, 1), (0,))
    assert "own: 3 vertices, 1 triangle, 2 colors, 0 cracks" in capsys.readouterr().out
    assert main(["solve", str(output)]) == 0


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.npz", {"offsets": np.array([0, 2, 4])}, "offsets: has 3 entries, 3 vertices need 4"),
        ("a.npz", {"offsets": np.array([0, 2, 4, 4])}, "offsets: must rise from 0 to 5"),
        ("a.npz", {"offsets": np.array([0, 4, 2, 5])}, "offsets[2]: must rise from 0 to 5"),
        ("a.npz", {"offsets": np.array([0.0, 2, 4, 5])}, "offsets: must be whole numbers"),
        ("a.npz", {"names": np.array(["up"])}, "names: has 1 entries for 5 configurations"),
        ("a.npz", {"joints": np.array([1])}, "joints: is unknown"),
        ("a.npz", {"vertices": np.array(1.0)}, "vertices: has 0 dimensions, must have 2"),
        (
            "a.npz",
            {"configurations": np.full((5, 2), np.nan)},
            "configurations[0][0][0]: is not a finite",
        ),
        ("a.npz", "no archive", "is no archive of arrays"),
        ("a.json", '{"vertices": [], "faces": []}', "configurations: is missing"),
        ("a.json", '{"vertices": 1, "faces": [], "configurations": []}', "vertices: must be"),
        ("bare.csv", "vertex,j1\n0,1\n", "has no mesh: say which (--mesh)"),
        ("a.txt", "", "must end in .npz, .json or .csv"),
        ("a.csv", "x,y\n", "line 1: must begin with vertex"),
        ("a.csv", "vertex,j1\n0,1,2\n", "line 2: has 3 columns, line 1 has 2"),
        ("a.csv", "vertex,j1\n0,one\n", "line 2: is no row of numbers"),
        ("a.csv", "vertex,j1\n0,1\n7,1\n", "line 3: there is no vertex 7, the mesh has 3"),
    ],
)
def test_a_wrong_file_is_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, content: Any, message: str
) -> None:
    source, mesh, output = (tmp_path / file for file in (name, "mesh.obj", "s.json"))
    mesh.write_text(MESH)
    if isinstance(content, str):
        source.write_text(content)
    else:
        np.savez(source, **(ARCHIVE | content))
    options = ["--mesh", str(mesh)] if name == "a.csv" else []
    assert main(["label", str(source), "-o", str(output), *options]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{source}: {message}" in line
    assert not output.exists()
