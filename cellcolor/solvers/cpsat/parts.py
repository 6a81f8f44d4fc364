"""Parts of an instance that no segment connects, each solved on its own."""

from __future__ import annotations

from dataclasses import dataclass

from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Seam
from cellcolor.union_find import UnionFind

Loops = tuple[tuple[tuple[int, ...], ...], ...]
"""For each cell its loops with live darts, each as these darts, the longest first."""


def loops_of(instance: Instance) -> Loops:
    """The loops of an instance with live darts. All seams of a cell leave from the longest one."""
    return tuple(tuple(sorted(own, key=len, reverse=True)) for own in instance.live_loops)


@dataclass(frozen=True, slots=True)
class ConnectedPart:
    """A connected part of an instance, in the colors that are left of each cell.

    Attributes:
        instance: its cells, renumbered, and its live edges under their own ids. An edge to
            another part leads outside.
        cells: the cell of the whole instance that each one is.
        loops: the loops between which the cells' seams run: those that are live in the whole
            instance, so that a seam lies where other code expects it, whatever was left out here.
        seams: the seams of its cells, by the part's numbers of cells, without strands.
    """

    instance: Instance
    cells: list[int]
    loops: Loops
    seams: tuple[Seam, ...]


def seam_places(instance: Instance, loops: Loops) -> tuple[Seam, ...]:
    """Seams from the first live loop of every cell to its other live loops, without strands."""
    seams: list[Seam] = []
    number = max((edge.id for edge in instance.edges), default=0)
    for cell, (first, *others) in enumerate([found or ((),) for found in loops]):
        for loop in others:
            number += 1
            seams.append(Seam(number, cell, first[0], loop[0], 0))
    return tuple(seams)


def split(instance: Instance) -> list[ConnectedPart]:
    """The parts of an instance that live edges connect, the smallest first.

    Segments never reach from one into another, so their minima and bounds add up.
    """
    loops = loops_of(instance)
    seams = seam_places(instance, loops)
    live: dict[int, tuple[int, ...]] = {}
    connected = UnionFind(range(len(instance.cells)))
    for edge in instance.edges:
        if own := instance.joinable(edge.id):
            live[edge.id] = own
            connected.union(edge.left, edge.right)
    found = sorted(map(sorted, connected.sets()), key=len)
    number = {cell: place for cells in found for place, cell in enumerate(cells)}
    seams_of: dict[int, list[Seam]] = {}
    for seam in seams:
        seams_of.setdefault(seam.cell, []).append(seam)
    parts = []
    for cells in found:
        here = set(cells)
        own_edges = {abs(dart) for cell in cells for loop in loops[cell] for dart in loop}
        edges = []
        for edge_id in sorted(own_edges):
            edge = instance.edge(edge_id)
            sides = [number[s] if s in here else OUTSIDE for s in (edge.left, edge.right)]
            edges.append(Edge(edge_id, sides[0], sides[1], live.get(edge_id, ())))
        parts.append(
            ConnectedPart(
                Instance(
                    instance.name,
                    instance.colors,
                    tuple(
                        Cell(place, instance.cells[cell].colors, loops[cell])
                        for place, cell in enumerate(cells)
                    ),
                    tuple(edges),
                ),
                cells,
                tuple(loops[cell] for cell in cells),
                tuple(
                    Seam(seam.id, number[cell], seam.from_, seam.to, 0)
                    for cell in cells
                    for seam in seams_of.get(cell, ())
                ),
            )
        )
    return parts
