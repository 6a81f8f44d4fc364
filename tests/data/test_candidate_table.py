"""The side file: what `build` keeps of every vertex and branch."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from reasons import Reason
from shipped import SCENES, WOK, shipped, wok_file

from cellcolor.cli import main
from cellcolor.data.candidate_table import CandidateTable
from cellcolor.data.surface import LabelledSurface
from cellcolor.frontend import build_surface


def test_build_writes_it_beside_the_surface(tmp_path: Path) -> None:
    file = wok_file(tmp_path, target_vertices=200)
    assert main(["build", str(file), "-o", str(tmp_path / "wok.json")]) == 0
    surface = LabelledSurface.read(tmp_path / "wok.surface.json")
    result = build_surface(file)
    with np.load(tmp_path / surface.meta["side_file"], allow_pickle=False) as side:
        assert side["branches"].tolist() == list(result.branches)
        assert side["reason_names"].tolist() == [reason.text for reason in Reason]
        assert np.array_equal(side["reasons"], result.reasons)
        assert np.array_equal(side["configurations"], result.configurations, equal_nan=True)
        for vertex, colors in enumerate(surface.vertex_colors):
            row = side["node_color"][vertex]
            assert sorted(row[row >= 0].tolist()) == list(colors)
    assert not list(tmp_path.glob(".*"))


def test_more_colors_than_sixteen_bits_tell(tmp_path: Path) -> None:
    """A noisy surface can have a color for each vertex; files with 16 bits stay readable."""
    result = build_surface(shipped("wok", 50))
    surface = replace(result.surface, meta={"side_file": "many.npz"})
    numbers = np.arange(result.node_color.size).reshape(result.node_color.shape) + 70_000
    (tmp_path / "many.npz").write_bytes(replace(result.candidates, node_color=numbers).to_bytes())
    assert np.array_equal(
        CandidateTable.beside(surface, tmp_path / "many.json").node_color, numbers
    )
    with np.load(tmp_path / "many.npz") as side:
        old = dict(side) | {"node_color": result.node_color.astype(np.int16)}
    np.savez_compressed(tmp_path / "many.npz", **old)
    read = CandidateTable.beside(surface, tmp_path / "many.json").node_color
    assert np.array_equal(read, result.node_color) and read.min() == -1


def test_stored_side_files_are_read_by_name() -> None:
    """The shipped ones are of before tests were objects: the code of a blocked tip came last."""
    surface = LabelledSurface.read(SCENES / "wok.surface.json")
    stored = CandidateTable.beside(surface, SCENES / "wok.surface.json")
    built = build_surface(WOK).candidates
    assert stored.reason_names[-1] == "tip blocked" != built.reason_names[-1]
    assert set(stored.reason_names) == set(built.reason_names)
    names = [np.array(table.reason_names)[table.reasons] for table in (stored, built)]
    assert (names[0] == names[1]).all()


def test_what_is_written_is_read(tmp_path: Path) -> None:
    table = build_surface(shipped("wok", 50)).candidates
    (tmp_path / "side.npz").write_bytes(table.to_bytes())
    assert CandidateTable.read(tmp_path / "side.npz") == table


def test_side_file_of_another_build(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """As a kill between two renames can leave it: as many vertices, other colors."""
    for name, height in (("low", -0.04), ("high", 0.1)):
        file = wok_file(tmp_path, target_vertices=50, position_m=[0.465, -0.15, height])
        assert main(["build", str(file), "-o", str(tmp_path / f"{name}.json")]) == 0
    (tmp_path / "low.reasons.npz").replace(tmp_path / "high.reasons.npz")
    show = ["show", str(tmp_path / "high.json"), "--view", "reasons", "-o", str(tmp_path / "x.png")]
    assert main(show) == 2
    assert "another surface" in capsys.readouterr().err
    assert not (tmp_path / "x.png").exists()
