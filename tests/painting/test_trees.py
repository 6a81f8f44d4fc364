"""Disjoint trees between terminals on the border of a cell."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pytest

from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition.borders import ClosedMesh
from cellcolor.lab.families.meshes import grid_faces
from cellcolor.painting.trees import TooNarrow, grow_trees


def grid(size: int) -> ClosedMesh:
    """A square of size by size vertices, numbered row by row."""
    places = [[x, y, 0.0] for y in range(size) for x in range(size)]
    vertices, faces = np.array(places), np.array(grid_faces(size, size))
    return ClosedMesh(LabelledSurface("grid", ("a",), vertices, faces, ((0,),) * size**2))


def grown(vertices: Iterable[int], mesh: ClosedMesh, terminals: list[list[int]]) -> dict[int, int]:
    around: dict[int, list[int]] = {}
    for a, b in mesh.third:
        around.setdefault(a, []).append(b)
    return grow_trees(vertices, around, mesh.third, lambda _a, _b: False, terminals)


def trees(size: int, terminals: list[list[int]]) -> dict[int, int]:
    return grown(range(size**2), grid(size), terminals)


def connected(size: int, found: dict[int, int], number: int) -> bool:
    """By flooding: vertices of a square grid whose squares are all parted the same way."""
    own = {vertex for vertex, tree in found.items() if tree == number}
    pairs = {pair for pair in grid(size).third if set(pair) <= own}
    reached = {min(own)}
    while more := {b for a, b in pairs if a in reached} - reached:
        reached |= more
    return reached == own


def test_nested_pairs_go_round_each_other() -> None:
    # On the lower row of a 7 by 7 grid: 1 and 5 round 2 and 4 round 3.
    found = trees(7, [[1, 5], [2, 4], [3]])
    assert {found[v] for v in (1, 5)} == {0}
    assert {found[v] for v in (2, 4)} == {1}
    assert found[3] == 2
    assert all(connected(7, found, number) for number in range(3))


def test_what_crosses_is_refused() -> None:
    # Corners of the square crosswise: no two disjoint trees connect them.
    with pytest.raises(TooNarrow):
        trees(7, [[0, 48], [6, 42]])


def test_too_few_rows_are_refused() -> None:
    # Three rows hold two nested trees over a middle one, two rows do not.
    found = grown(range(21), _strip(3), [[1, 5], [2, 4], [3]])
    assert len(set(found.values())) == 3
    with pytest.raises(TooNarrow):
        grown(range(14), _strip(2), [[1, 5], [2, 4], [3]])


def _strip(rows: int) -> ClosedMesh:
    places = [[x, y, 0.0] for y in range(rows) for x in range(7)]
    vertices, faces = np.array(places), np.array(grid_faces(rows, 7))
    return ClosedMesh(LabelledSurface("strip", ("a",), vertices, faces, ((0,),) * len(places)))


def test_one_vertex_for_two_is_refused() -> None:
    with pytest.raises(TooNarrow):
        trees(7, [[1, 5], [5, 6]])


def test_a_way_across_leaves_the_other_one_room() -> None:
    """Two sub-cells both reach a hole; the first must not shut the second one in."""
    inside = [v for v in range(49) if v not in (16, 17, 18, 23, 24, 25, 30, 31, 32)]
    # 8 and 9 are on the hole's lower left, 0 and 1 on the outer border.
    found = grown(inside, grid(7), [[0, 15], [1, 9], [48, 40]])
    assert all(connected(7, found, number) for number in range(3))
