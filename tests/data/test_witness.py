"""Cells that show why there cannot be fewer segments."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import networkx as nx
import pytest
from hypothesis import given
from library import PAPER
from meshes import drawn, surfaces

import cellcolor
from cellcolor import Instance, LabelledSurface
from cellcolor.data.bounds import Bound
from cellcolor.data.solution import witness_in_words
from examples import examples


def connected(instance: Instance, one: int, other: int) -> bool:
    """Whether one color reaches from one cell to the other, step by step over its live edges."""
    for color in set(instance.cells[one].colors) & set(instance.cells[other].colors):
        graph: nx.Graph[int] = nx.Graph()
        graph.add_nodes_from((one, other))
        graph.add_edges_from(
            (edge.left, edge.right)
            for edge in instance.edges
            if color in instance.joinable(edge.id)
        )
        if nx.has_path(graph, one, other):
            return True
    return False


@given(surfaces())
@examples(30)
def test_no_two_witnesses_can_share_a_segment(surface: LabelledSurface) -> None:
    result = cellcolor.solve(surface, workers=1)
    cells = result.solution.witness
    if cells:
        assert len(cells) == result.segments > 1  # type: ignore[operator]
        assert result.solution.proved_for_surface
        assert not any(connected(result.instance, *pair) for pair in combinations(cells, 2))


def test_there_is_none_without_a_proof() -> None:
    """Nor for more cells than somebody would look at, nor for a single segment."""
    instance = Instance.read(PAPER / "ring.json")
    solution = cellcolor.solve(instance).solution
    assert len(solution.witness) == 2
    assert replace(solution, proved_for_surface=False).witness == ()
    assert cellcolor.solve(drawn("AA AA", {"A": [0]})).solution.witness == ()
    many = drawn("AABBCCAABBCCAABBCCAABBCCAABBCC " * 2, {"A": [0], "B": [1], "C": [2]})
    found = cellcolor.solve(many)
    assert found.segments is not None and found.segments > 12
    assert found.solution.witness == ()


def test_it_is_the_certificate_that_names_them() -> None:
    """Whichever kind of bound has it; one that says nothing names none."""
    solution = cellcolor.solve(Instance.read(PAPER / "ring.json")).solution
    (cover,) = solution.bounds or ()
    assert cover.certificate is not None
    cells = tuple(cover.certificate["cells"])
    for kind, certificate, witness in (
        ("strangers", {"cells": cells}, cells),
        ("cover", {"cells": cells[:1]}, ()),
        ("cover", {"cells": 5}, ()),
        ("cover", {"cells": ["a", "b"]}, ()),
        ("own", {"cells": cells}, ()),
    ):
        bound = Bound(kind, 2, "surface", certificate)
        assert replace(solution, bounds=(bound,)).witness == witness


@pytest.mark.parametrize(
    ("art", "cells", "text"),
    [
        ("AABB", (0, 1), "cells 0 and 1 share no color"),
        ("AABBCC", (0, 1, 2), "no two of the cells 0, 1 and 2 share a color"),
        ("AABBAA", (0, 2), "cells 0 and 2 can share no segment"),
        ("AABBAACC", (0, 1, 2), "no two of the cells 0, 1 and 2 can be in one segment"),
    ],
)
def test_it_is_told_in_words(art: str, cells: tuple[int, ...], text: str) -> None:
    surface = drawn(f"{art} {art}", {"A": [0], "B": [1], "C": [2]})
    instance = cellcolor.decompose(surface)
    assert witness_in_words(instance, cells) == text
    assert witness_in_words(instance, ()) is None
