"""Cells with several live loops for solvers that know cells with one: seams as edges.

A seam makes one cyclic list of two loops of a cell, and each of its strands is an edge with the
cell on both sides (docs/semantics.md, section 5). So an instance with as many strands as are ever
needed is an instance in which every cell has one live loop, and its minimum is the same.
"""

from __future__ import annotations

from dataclasses import replace

from cellcolor.data.darts import DartName, Strand
from cellcolor.data.instance import Cell, Edge, Instance
from cellcolor.data.solution import Seam, number_segments
from cellcolor.solvers.cpsat.model.dart_graph import dart_graph, seams_of
from cellcolor.solvers.interface import Answer

__all__ = ["Seamed"]


class Seamed:
    """An instance with the strands of its seams as edges.

    Args:
        instance: the one to be solved.

    Attributes:
        instance: the one with a single live loop in each cell.
        seams: those that are edges there.
    """

    def __init__(self, instance: Instance) -> None:
        colors = [frozenset(cell.colors) for cell in instance.cells]
        once = dict.fromkeys(instance.live_edges, 1)
        self.seams: tuple[Seam, ...] = seams_of(instance, colors, once, None)
        graph = dart_graph(instance, colors, once, self.seams)
        virtual = {seam.id for seam in self.seams}
        edges = {
            edge: replace(instance.edge(edge), colors=tuple(instance.joinable(edge)))
            for edge in instance.live_edges
        }
        self._name: dict[int, Strand] = {}
        number = {(edge, 1): edge for edge in edges}
        for dart in graph.darts:
            edge, strand = dart.name
            if edge in virtual:
                new = max([*edges, 0]) + 1
                edges[new] = Edge(new, dart.cell, dart.cell, instance.cells[dart.cell].colors)
                number[edge, strand] = new
                self._name[new] = dart.name
        cells = []
        for cell, darts in zip(instance.cells, graph.lists, strict=True):
            names = [graph.darts[dart].name for dart in darts]
            loop = tuple(number[abs(d), s] * (1 if d > 0 else -1) for d, s in names)
            cells.append(Cell(cell.id, cell.colors, (loop,) if loop else ()))
        ordered = tuple(edges[edge] for edge in sorted(edges))
        self.instance = replace(instance, cells=tuple(cells), edges=ordered, known=None)

    def answer(self, found: Answer) -> Answer:
        """What a solver answers to the instance with seams as edges, for the one without."""
        if found.division is None:
            return found
        blocks = [
            [(own.color, [self._named(dart) for dart in own.darts]) for own in cell.subcells]
            for cell in found.division
        ]
        return replace(found, division=number_segments(blocks), seams=self.seams)

    def _named(self, dart: DartName) -> DartName:
        assert isinstance(dart, int)  # one strand an edge
        if abs(dart) not in self._name:
            return dart
        seam, strand = self._name[abs(dart)]
        return (seam if dart > 0 else -seam), strand
