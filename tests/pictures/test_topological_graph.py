"""Drawings of the topological graph, read back and held against it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from library import PAPER
from pages import (
    show,
)

from cellcolor.data.instance import Instance
from cellcolor.pictures.topological_graph import draw_graph


@pytest.mark.parametrize(
    "name", ["ring", "three-loops", "crossing-zeros", "crack-partial", "annulus"]
)
def test_darts_stand_around_their_cell_in_cyclic_order(name: str) -> None:
    instance = Instance.read(PAPER / f"{name}.json")
    places = {text: at for text, at, _ in draw_graph(instance).texts}
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


def test_one_line_for_each_joinable_color() -> None:
    instance = Instance.read(PAPER / "crack-partial.json")
    lines = [(line.name, line.dashed) for line in draw_graph(instance).lines]
    wanted = []
    for edge in instance.edges:
        colors = instance.joinable(edge.id)
        wanted += [(f"{c}: {instance.colors[c]}", False) for c in colors]
        wanted += [] if colors else [("dead edge", True)]
    assert sorted(lines) == sorted(wanted)
    assert {dashed for _, dashed in lines} == {False, True}
    assert list(dict.fromkeys(lines)) == sorted(set(lines))  # the legend's order


def test_a_page_has_the_drawing_and_its_legend(tmp_path: Path) -> None:
    """It needs no script, and what is written in it stays text."""
    instance = replace(Instance.read(PAPER / "ring.json"), colors=("<b>", "blue", "green"))
    (tmp_path / "ring.json").write_text(instance.to_json())
    show(tmp_path / "ring.json", "--view", "graph", "-o", tmp_path / "x.html")
    page = (tmp_path / "x.html").read_text(encoding="utf-8")
    assert page.count("<svg") == 1 and "class View" not in page
    assert "0: &lt;b&gt;</span>" in page and "<b>" not in page
