"""Graphs in the text format of IMCGS; the files here are this project's own."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from relabelled import isomorphic

from cellcolor.data.imcgs import read_imcgs
from cellcolor.data.instance import Instance
from cellcolor.errors import InputError
from cellcolor.lab.families import planar_graph
from examples import examples

TWO_CELLS = """2 4
0 1 2
1 2
2 3
2

-1 0
-1 0
0 1
-1 1
"""


def text_of(graph: Instance) -> str:
    """A graph of cells with one loop each, written as the format has it."""
    place = {edge.id: number for number, edge in enumerate(graph.edges)}
    lines = [f"{len(graph.cells)} {len(graph.edges)}"]
    for cell in graph.cells:
        (loop,) = cell.loops
        lines.append(" ".join(str(place[abs(dart)]) for dart in loop))
        lines.append(" ".join(str(color) for color in cell.colors))
    lines += ["", *(f"{edge.right} {edge.left}" for edge in graph.edges)]
    return "\n".join(lines)


def read(folder: Path, text: str, *corrections: str) -> Instance:
    file = folder / "graph.txt"
    file.write_text(text, encoding="utf-8")
    return read_imcgs(file, corrections)


def test_read(tmp_path: Path) -> None:
    graph = read(tmp_path, TWO_CELLS)
    assert graph.name == "graph" and graph.colors == ("c1", "c2")
    assert [cell.colors for cell in graph.cells] == [(0, 1), (1,)]
    assert [cell.loops for cell in graph.cells] == [((1, 2, 3),), ((-3, 4),)]
    assert [(e.left, e.right) for e in graph.edges] == [(0, -1), (0, -1), (0, 1), (1, -1)]
    assert graph.meta == {"made_by": "cellcolor import graph.txt"}


@examples(30)
@given(st.integers(0, 10**6), st.integers(2, 9), st.integers(0, 8), st.booleans())
def test_a_graph_comes_back(
    tmp_path_factory: pytest.TempPathFactory, seed: int, cells: int, more: int, self_edges: bool
) -> None:
    made = planar_graph(seed, cells, cells - 1 + more, 3, self_edges=self_edges)
    every_color = tuple(replace(edge, colors=None) for edge in made.edges)
    # The format does not tell of a color that no cell has.
    assume({color for cell in made.cells for color in cell.colors} == {0, 1, 2})
    graph = replace(made, edges=every_color)
    back = read(tmp_path_factory.mktemp("read"), text_of(graph))
    assert isomorphic(graph, back)


def test_corrections(tmp_path: Path) -> None:
    """As in the one file that is public: a cell that does not exist, and one that is another."""
    wrong = TWO_CELLS.replace("-1 1\n", "-1 0\n").replace("-1 0\n-1 0\n0", "0 7\n-1 0\n0")
    with pytest.raises(InputError) as caught:
        read(tmp_path, wrong)
    assert "line 7: edge 0 lies beside cell 7, which does not exist" in str(caught.value)
    with pytest.raises(InputError) as caught:
        read(tmp_path, wrong, "0=-1,0")
    expected = "line 10: edge 3 lies between -1 and 0 here, but in the lists of cells: 1"
    assert expected in str(caught.value)
    graph = read(tmp_path, wrong, "0=-1,0", "3=1,-1")
    assert graph.sha256 == read(tmp_path, TWO_CELLS).sha256
    made_by = "cellcolor import graph.txt --correct 0=-1,0 --correct 3=1,-1"
    assert graph.meta == {"made_by": made_by}


@pytest.mark.parametrize(
    ("correction", "text"),
    [
        ("3", "correct: must be written like 16=-1,0, is '3'"),
        ("3=-2,0", "correct: must be written like"),
        ("3=0,1,2", "correct: must be written like"),
        ("9=0,1", "correct: there is no edge 9"),
        ("3=0,5", "line 10: edge 3 lies beside cell 5"),
        ("3=-1,-1", "line 10: edge 3 has the outside (-1) on both sides"),
    ],
)
def test_corrections_refused(tmp_path: Path, correction: str, text: str) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, TWO_CELLS, correction)
    assert text in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        (TWO_CELLS, "", "line 1: must have two numbers"),
        ("2 4", "2", "line 1: must have two numbers"),
        ("2 4", "-2 4", "line 1: must have two numbers"),
        ("2 4", "2 5", "line 10: is the last of 9 lines with numbers"),
        ("2 4", "999999999 999999999", "line 10: is the last of 9 lines with numbers"),
        ("2 4", "2 4 x", "line 1: 'x' is not a whole number"),
        ("0 1 2\n1 2", "0 1.5 2\n1 2", "line 2: '1.5' is not a whole number"),
        ("2 3\n", f"2 {'3' * 5000}\n", "line 4: '333"),
        ("2 3\n", "2 4\n", "line 4: cell 1 has an edge 4, which does not exist"),
        ("2 3\n", "2 3 3\n", "line 10: edge 3 lies between -1 and 1 here, but in the lists of"),
        ("2 3\n", "2\n", "line 10: edge 3 lies between -1 and 1 here, but in the lists of cells: "),
        ("\n1 2\n", "\n2 2\n", "line 3: colors must be different numbers from 0 on"),
        ("\n1 2\n", "\n-1 2\n", "line 3: colors must be different numbers from 0 on"),
        ("0 1\n-1 1", "0 1 1\n-1 1", "line 9: must have the two cells beside edge 2"),
        ("0 1\n-1 1", "0 2\n-1 1", "line 9: edge 2 lies beside cell 2, which does not exist"),
        ("0 1\n-1 1", "-1 -1\n-1 1", "line 9: edge 2 has the outside (-1) on both sides"),
    ],
)
def test_refused(tmp_path: Path, old: str, new: str, text: str) -> None:
    assert old in TWO_CELLS
    with pytest.raises(InputError) as caught:
        read(tmp_path, TWO_CELLS.replace(old, new, 1))
    assert str(caught.value).startswith(f"{tmp_path / 'graph.txt'}: {text}")
    assert "\n" not in str(caught.value)


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        read_imcgs(tmp_path / "none.txt")
    (tmp_path / "bytes.txt").write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match="not UTF-8 text"):
        read_imcgs(tmp_path / "bytes.txt")
