"""Drawings of the topological graph, read back and held against it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from library import PAPER
from numpy.typing import NDArray
from pages import (
    DRAWN,
    saved,
    show,
    traces,
)

from cellcolor.data.instance import Instance


class TestGraph:
    @pytest.mark.parametrize(
        "name", ["ring", "three-loops", "crossing-zeros", "crack-partial", "annulus"]
    )
    def test_darts_stand_around_their_cell_in_cyclic_order(self, name: str, tmp_path: Path) -> None:
        path = PAPER / f"{name}.json"
        show(path, "--graph", "-o", tmp_path / "x.html")
        places: dict[str, NDArray[np.float64]] = {}
        for trace in traces(tmp_path / "x.html"):
            if trace.get("mode") == "text":
                at = np.stack([np.asarray(trace["x"]), np.asarray(trace["y"])], axis=1)
                places |= dict(zip(trace["text"], at, strict=True))
        instance = Instance.read(path)
        darts = [f"{dart:+d}" for cell in instance.cells for loop in cell.loops for dart in loop]
        assert places.keys() == {str(cell.id) for cell in instance.cells} | set(darts)
        for cell in instance.cells:
            around = {}
            for dart in (dart for loop in cell.loops for dart in loop):
                x, y = places[f"{dart:+d}"] - places[str(cell.id)]
                around[dart] = np.arctan2(y, x)
            order = sorted(around, key=lambda dart: float(around[dart]))
            for loop in cell.loops:
                own = [dart for dart in order if dart in loop]
                start = own.index(loop[0])
                assert tuple(own[start:] + own[:start]) == loop

    def test_one_line_for_each_joinable_color(self, tmp_path: Path) -> None:
        path = PAPER / "crack-partial.json"
        show(path, "--graph", "-o", tmp_path / "x.html")
        instance = Instance.read(path)
        lines = [
            (trace["name"], trace["line"].get("dash"))
            for trace in traces(tmp_path / "x.html")
            if trace.get("mode") == "lines" and trace["name"]
        ]
        wanted = []
        for edge in instance.edges:
            colors = instance.joinable(edge.id)
            wanted += [(f"{c}: {instance.colors[c]}", None) for c in colors]
            wanted += [] if colors else [("dead edge", "4px")]
        assert sorted(lines, key=str) == sorted(wanted, key=str)
        assert {dash for _, dash in lines} == {None, "4px"}
        assert list(dict.fromkeys(lines)) == sorted(set(lines), key=str)  # the legend's order

    def test_a_surface_and_a_graph_without_cells(self, tmp_path: Path) -> None:
        show(saved(DRAWN, tmp_path), "--graph", "-o", tmp_path / "x.svg")
        assert "drawn: 4 cells" in (tmp_path / "x.svg").read_text()
        empty = tmp_path / "empty.json"
        empty.write_text(Instance("empty", (), (), ()).to_json())
        show(empty, "--graph", "-o", tmp_path / "empty.png")
        assert (tmp_path / "empty.png").stat().st_size > 0
