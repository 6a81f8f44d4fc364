"""The side file: what `build` keeps of every vertex and branch."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from cellcolor.cli import main
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError
from cellcolor.frontend import Reason, build_surface
from cellcolor.frontend.sidefile import write_side_file


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


def test_same_result_same_bytes(scene: Callable[..., Path], tmp_path: Path) -> None:
    result = build_surface(scene(target_vertices=50))
    for name in ("a.npz", "b.npz"):
        write_side_file(result, tmp_path / name)
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_a_place_that_cannot_be_written(scene: Callable[..., Path], tmp_path: Path) -> None:
    result = build_surface(scene(target_vertices=50))
    (tmp_path / "taken.npz").mkdir()
    with pytest.raises(InputError) as caught:
        write_side_file(result, tmp_path / "taken.npz")
    assert caught.value.file == str(tmp_path / "taken.npz")
    assert not list(tmp_path.glob(".*"))
