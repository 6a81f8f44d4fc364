"""Disjoint trees between terminals on the border of a cell."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pytest

from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition.borders import ClosedMesh
from cellcolor.lab.families.meshes import grid_faces
from cellcolor.painting.trees import Trees


def grid(size: int) -> ClosedMesh:
    """A square of size by size vertices, numbered row by row."""
    places = [[x, y, 0.0] for y in range(size) for x in range(size)]
    vertices, faces = np.array(places), np.array(grid_faces(size, size))
    return ClosedMesh(LabelledSurface("grid", ("a",), vertices, faces, ((0,),) * size**2))


def grown(vertices: Iterable[int], mesh: ClosedMesh, terminals: list[list[int]]) -> dict[int, int]:
    around: dict[int, list[int]] = {}
    for a, b in mesh.third:
        around.setdefault(a, []).append(b)
    return Trees(vertices, around, mesh.third, lambda _a, _b: False, terminals).grown()


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


def without(size: int, low: int, high: int) -> list[int]:
    """The vertices of a square grid with a square hole, both ends of its rows included."""
    hole = {(x, y) for x in range(low, high + 1) for y in range(low, high + 1)}
    return [y * size + x for y in range(size) for x in range(size) if (x, y) not in hole]


@pytest.mark.parametrize(
    ("size", "hole", "terminals"),
    [
        # Shortest ways would shut the others in: long detours round their pieces are needed.
        (7, (2, 3), [[6, 31], [45, 10], [13, 22]]),
        (9, (3, 5), [[44, 58], [80, 24], [4, 33]]),
        (8, (2, 5), [[0, 38], [2, 14], [61, 30]]),
        # The way of one sub-cell would shut another one in whatever it costs: its turn is later.
        (7, (2, 3), [[6, 32], [42, 18], [13, 29]]),
        (8, (3, 4), [[8, 21], [39, 18], [31, 42]]),
        (7, (3, 4), [[0, 39], [27, 30], [35, 18], [42, 16]]),
    ],
)
def test_ways_to_a_hole_leave_each_other_room(
    size: int, hole: tuple[int, int], terminals: list[list[int]]
) -> None:
    """Each sub-cell from the outer border to the hole; drawn by random search."""
    found = grown(without(size, *hole), grid(size), terminals)
    for number, own in enumerate(terminals):
        assert {found[v] for v in own} == {number}
        assert connected(size, found, number)


def test_trees_end_with_their_deadline() -> None:
    mesh = grid(7)
    around: dict[int, list[int]] = {}
    for a, b in mesh.third:
        around.setdefault(a, []).append(b)
    with pytest.raises(OutOfTime):
        Trees(range(49), around, mesh.third, lambda _a, _b: False, [[1, 5]], Deadline(0.0)).grown()
