"""The side file: what `build` keeps of every vertex and branch."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from cellcolor.cli import main
from cellcolor.data.surface import LabelledSurface
from cellcolor.frontend import Reason, build_surface
from cellcolor.frontend.sidefile import side_file


def test_build_writes_it_beside_the_surface(scene: Callable[..., Path], tmp_path: Path) -> None:
    file = scene(target_vertices=200)
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


def test_same_result_same_bytes(scene: Callable[..., Path]) -> None:
    result = build_surface(scene(target_vertices=50))
    assert side_file(result) == side_file(result)


def test_side_file_of_another_build(
    scene: Callable[..., Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """As a kill between two renames can leave it: as many vertices, other colors."""
    pytest.importorskip("matplotlib")
    for name, height in (("low", -0.04), ("high", 0.1)):
        file = scene(target_vertices=50, position_m=[0.465, -0.15, height])
        assert main(["build", str(file), "-o", str(tmp_path / f"{name}.json")]) == 0
    (tmp_path / "low.reasons.npz").replace(tmp_path / "high.reasons.npz")
    show = ["show", str(tmp_path / "high.json"), "--reason", "-o", str(tmp_path / "x.png")]
    assert main(show) == 2
    assert "another surface" in capsys.readouterr().err
    assert not (tmp_path / "x.png").exists()
