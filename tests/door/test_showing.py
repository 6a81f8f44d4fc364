"""``show`` and ``plot``: the same pictures as on the command line, from values and in notebooks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from library import PAPER
from meshes import drawn

import cellcolor
from cellcolor import InputError
from cellcolor.cli import main

NAMES = {"A": [0], "B": [0, 1], "C": [1, 2], "-": []}
SURFACE = drawn("AABBCC AABBCC AA--CC", NAMES)


@pytest.mark.parametrize("suffix", ["html", "png", "svg"])
def test_a_value_gives_the_same_bytes_as_its_file(suffix: str, tmp_path: Path) -> None:
    source = tmp_path / "s.json"
    source.write_text(SURFACE.to_json(), encoding="utf-8")
    shown, plotted = tmp_path / f"a.{suffix}", tmp_path / f"b.{suffix}"
    assert main(["show", str(source), "-o", str(shown)]) == 0
    drawing = SURFACE.plot(str(plotted))
    assert shown.read_bytes() == plotted.read_bytes()
    again = tmp_path / f"c.{suffix}"
    drawing.save(again)
    assert again.read_bytes() == plotted.read_bytes()


def test_a_result_is_drawn_by_segment(tmp_path: Path) -> None:
    source, solved = tmp_path / "s.json", tmp_path / "solution.json"
    source.write_text(SURFACE.to_json(), encoding="utf-8")
    result = cellcolor.solve(SURFACE)
    result.save(solved)
    assert main(["show", str(source), str(solved), "-o", str(tmp_path / "a.svg")]) == 0
    drawing = result.plot(tmp_path / "b.svg")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
    assert str(drawing) == "test: 2 segments, 1 lift-off" or "2 segments" in str(drawing)
    cellcolor.show(SURFACE, tmp_path / "c.svg", solution=str(solved))
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "c.svg").read_bytes()


@pytest.mark.parametrize(
    ("view", "option"),
    [
        ({"color": 1}, ["--color", "1"]),
        ({"color": "blue"}, ["--color", "blue"]),
        ({"view": "graph"}, ["--view", "graph"]),
    ],
    ids=str,
)
def test_views_are_those_of_the_command_line(
    view: dict[str, Any], option: list[str], tmp_path: Path
) -> None:
    source = tmp_path / "s.json"
    source.write_text(SURFACE.to_json(), encoding="utf-8")
    assert main(["show", str(source), *option, "-o", str(tmp_path / "a.svg")]) == 0
    SURFACE.plot(tmp_path / "b.svg", **view)
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
    cellcolor.solve(SURFACE).plot(tmp_path / "c.svg", **view)
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "c.svg").read_bytes()


def test_an_instance_is_drawn_as_far_as_it_is_known(tmp_path: Path) -> None:
    """With a surface that it names by cell, without one as a graph."""
    instance = cellcolor.decompose(SURFACE)
    assert main(["build", str(_saved(tmp_path)), "-o", str(tmp_path / "i.json")]) == 0
    named = cellcolor.show(tmp_path / "i.json")
    assert str(named) == str(SURFACE.plot())
    graph = instance.plot()
    assert str(graph) == str(cellcolor.show(instance, view="graph")) != str(named)
    assert str(cellcolor.solve(instance).plot()) == str(graph)
    assert str(cellcolor.show("hub_24")) == str(cellcolor.read("hub_24").plot())  # type: ignore[union-attr]


def _saved(folder: Path) -> Path:
    file = folder / "s.surface.json"
    file.write_text(SURFACE.to_json(), encoding="utf-8")
    return file


def test_a_notebook_shows_a_page_that_loads_nothing() -> None:
    drawing = SURFACE.plot()
    page = drawing._repr_html_()
    assert page.startswith('<iframe srcdoc="') and page.endswith("</iframe>")
    inside = page.removeprefix('<iframe srcdoc="').partition('"')[0]
    assert "&lt;script" in inside and "class View" in inside
    assert "src=&quot;http" not in inside
    assert len(repr(drawing)) < 200


@pytest.mark.parametrize(
    ("view", "text"),
    [
        ({"color": "pink"}, "no 'pink' among 0 'red'"),
        ({"color": 7}, "no 7 among 0 'red'"),
        ({"color": -1}, "no -1 among 0 'red'"),
        ({"vertex": 0, "color": 0}, "one of color, vertex, solution and plan at a time"),
        ({"view": "graph", "color": 0}, "color: the picture graph does not take it"),
        ({"view": "reasons"}, "reasons: are known only for a scene, or for a surface's file"),
        ({"vertex": 0}, "branch: the picture arm needs it"),
        ({"view": "nonsense"}, "view: there is no 'nonsense'; there are arm, cells"),
        ({"vertex": 0, "branch": 0}, "has an arm"),
    ],
    ids=str,
)
def test_what_cannot_be_shown_is_refused(view: dict[str, Any], text: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        SURFACE.plot(tmp_path / "x.svg", **view)
    assert text in str(caught.value) and "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_a_surface_of_another_solution_is_refused() -> None:
    other = cellcolor.solve(PAPER / "ring.surface.json")
    with pytest.raises(InputError, match="no valid solution of"):
        cellcolor.show(SURFACE, solution=other.solution)


@pytest.mark.parametrize("vertex", ["0", 1.5, -1, 10**6])
def test_what_is_no_vertex_is_refused(vertex: Any) -> None:
    from shipped import shipped

    with pytest.raises(InputError, match=rf"vertex: {vertex!r} is not among 0 to "):
        cellcolor.show(shipped("wok", 50), vertex=vertex, branch=0)
