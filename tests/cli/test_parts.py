"""``cellcolor inspect`` and ``cellcolor repair``: what they print, write and refuse."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from dirty import DIRTY, obj

import cellcolor
from cellcolor.cli import main
from cellcolor.door.starting_part import part_keys_of
from cellcolor.frontend.parts.mesh_file import MeshObject


def stored(folder: Path, name: str) -> Path:
    vertices, faces = DIRTY[name]()
    file = folder / f"{name}.obj"
    file.write_text(obj(vertices, faces.tolist()))
    return file


def test_an_inspection_changes_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = stored(tmp_path, "fin")
    assert main(["inspect", str(file)]) == 0
    out, err = capsys.readouterr()
    assert err == "" and list(tmp_path.iterdir()) == [file]
    assert out.startswith("fin.obj\n  triangles        1,282, 644 vertices\n")
    assert "1 edge of 3 faces or more: (-0.05707, 0.08172, 0.004054)" in out
    assert "usable as it is  no: faces[1280]: edge 0-532 is not manifold" in out
    assert "1 component dropped" in out and out.endswith("and then it is usable\n")
    assert str(cellcolor.inspect(file)) == out.strip()


def test_as_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = stored(tmp_path, "millimeters")
    assert main(["inspect", str(file), "--json", "-o", str(tmp_path / "x.html")]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["unit"] == "mm" and document["merged_vertices"] == 1038
    assert document["high_m"] == pytest.approx([0.1, 0.05, 0.03])
    assert document["holes"] == {"count": 0, "first": []}
    assert document["refusal"].startswith("vertices[") and document["refusal_after_repair"] is None
    assert b"sharp edges" in (tmp_path / "x.html").read_bytes()
    assert main(["inspect", str(file), "--unit", "m", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["high_m"] == pytest.approx([100, 50, 30])
    assert main(["inspect", str(file), "--unit", "in", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["high_m"] == pytest.approx([2.54, 1.27, 0.762])
    for unit, meters in (("cm", "0.01"), ("in", "0.0254"), ("mm", "0.001"), ("m", "1.0")):
        looked = replace(cellcolor.inspect(file, unit=unit), refusal_after_repair=None)
        assert part_keys_of(file, tmp_path, looked, None, None)[0]["meters_per_unit"] == meters


def test_a_repaired_mesh_is_one_that_scenes_take(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, out = stored(tmp_path, "holes"), tmp_path / "made.obj"
    assert main(["repair", str(file), "-o", str(out), "--fill-holes", "0.2"]) == 0
    text = capsys.readouterr().out
    assert "5 holes filled with 20 faces (+0.00293 m^2)" in text
    assert text.endswith(f"wrote {out}, meters_per_unit = 1\n")
    surface = MeshObject(file=str(out), meters_per_unit=1.0).surface()
    expected = cellcolor.repair(file, fill_holes_m=0.2)
    assert np.allclose(surface.vertices, expected.vertices, atol=1e-9)
    assert (surface.faces == expected.faces).all()
    # An older result is replaced, nothing else is.
    assert main(["repair", str(file), "-o", str(out), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["holes"] == 5
    other = tmp_path / "other.obj"
    other.write_text("v 0 0 0\n")
    assert main(["repair", str(file), "-o", str(other)]) == 2
    assert other.read_text() == "v 0 0 0\n"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["inspect", "nothing.obj"], "no such mesh file"),
        (["inspect", "part.step"], "not a mesh format known here"),
        (["inspect", "part.obj", "-o", "part.jpg"], "must end in .html, .png or .svg"),
        (["repair", "part.obj", "-o", "part.stl"], "must end in .obj"),
        (["repair", "part.obj", "-o", "part.obj"], "part.obj"),
        (["repair", "part.obj", "-o", "made.obj"], "unit: its greatest extent is 5, which could"),
        (["repair", "part.obj", "-o", "made.obj", "--unit", "m"], "faces: none is left"),
        (["repair", "part.obj", "-o", "made.obj", "--fill-holes", "0"], "--fill-holes"),
    ],
)
def test_refusals_are_one_line(
    arguments: list[str],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "part.obj").write_text("v 0 0 0\nv 5 0 0\nv 2 0 0\nf 1 2 3\n")
    (tmp_path / "part.step").write_text("ISO-10303-21;\n")
    assert main(arguments) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1 and message in err
    assert {file.name for file in tmp_path.iterdir()} == {"part.obj", "part.step"}


def test_out_of_time(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = stored(tmp_path, "components")
    for command in (["inspect", str(file)], ["repair", str(file), "-o", str(tmp_path / "x.obj")]):
        assert main([*command, "--time-limit", "0.001"]) == 3
        assert "the time limit came first" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == [file]


def test_values_in_python() -> None:
    """What has vertices and faces is taken as well; units are asked for where they are open."""
    vertices, faces = DIRTY["inverted"]()
    found = cellcolor.inspect((vertices, faces))
    assert found.inside_out == 1 and found.name == "part"
    made = cellcolor.repair((vertices * 40, faces), unit="mm")
    assert made.meters_per_unit == 0.001
    with pytest.raises(cellcolor.InputError, match="could be meters as well") as caught:
        cellcolor.repair((vertices * 40, faces))
    assert caught.value.field == "unit"
    with pytest.raises(cellcolor.InputError, match="must be one of m, mm, cm, in, is 'inch'"):
        cellcolor.inspect((vertices, faces), unit="inch")
