"""Small pictures of graphs: whole, within the picture, and the same every time."""

from __future__ import annotations

import re
import sys
import xml.etree.ElementTree as ElementTree

import pytest
from library import INSTANCES, PAPER

from cellcolor.data.cells_and_edges import OUTSIDE, Cell
from cellcolor.data.instance import Instance
from cellcolor.lab.families import hub
from cellcolor.pictures.picture import LINES

sys.path.append(str(INSTANCES.parent / "docs"))
from thumbnail import thumbnail

SVG = "{http://www.w3.org/2000/svg}"
GRAPHS = [
    Instance("nothing", (), (), ()),
    Instance("one cell", ("any",), (Cell(0, (0,), ()),), ()),
    hub(0, 12, 4),
    Instance.read(PAPER / "crack-partial.json"),  # an edge with one cell on both sides
    Instance.read(PAPER / "crack-separates.json"),  # dead
    Instance.read(INSTANCES / "random" / "torus_0.json"),  # no plane graph
]


@pytest.mark.parametrize("graph", GRAPHS, ids=lambda graph: graph.name)
def test_every_cell_and_every_pair_of_neighbors_is_drawn(graph: Instance) -> None:
    text = thumbnail(graph)
    assert thumbnail(graph) == text
    root = ElementTree.fromstring(text)
    dots, lines = root.findall(f"{SVG}circle"), root.findall(f"{SVG}path")
    assert len(dots) == len(graph.cells)
    pairs: dict[frozenset[int], bool] = {}
    for edge in graph.edges:
        pair = frozenset((edge.left, edge.right))
        if OUTSIDE not in pair and len(pair) == 2:
            pairs[pair] = pairs.get(pair, False) or bool(graph.joinable(edge.id))
    assert len(lines) == len(pairs)
    dashed = [line for line in lines if line.get("stroke-dasharray")]
    assert len(dashed) == list(pairs.values()).count(False)
    for cell, dot in zip(graph.cells, dots, strict=True):
        assert (dot.get("fill") in LINES) == (len(cell.colors) == 1)
    numbers = [float(n) for dot in dots for n in (dot.get("cx", ""), dot.get("cy", ""))]
    numbers += [float(n) for line in lines for n in re.findall(r"[\d.]+", line.get("d", ""))]
    assert all(0 <= number <= 160 for number in numbers)
    assert len({(dot.get("cx"), dot.get("cy")) for dot in dots}) == len(dots)
