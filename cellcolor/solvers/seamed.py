"""Cells with several live loops for solvers that know cells with one: seams as edges.

A seam makes one cyclic list of two loops of a cell, and each of its strands is an edge with the
cell on both sides (docs/semantics.md, section 5). So an instance with as many strands as are ever
needed is an instance in which every cell has one live loop, and its minimum is the same.
"""

from __future__ import annotations

from dataclasses import replace

from cellcolor.data.cells_and_edges import Cell, DartName, Edge, Strand
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Seam, number_segments
from cellcolor.errors import TooLarge
from cellcolor.solvers.cpsat.dart_graph import dart_graph, wide_enough_seams

MOST_STRANDS = 10_000
"""The models grow with the square of the darts of a cell, so that none would have more."""


class Seamed:
    """An instance with the strands of its seams as edges; as it is if it needs no seams.

    Raises:
        TooLarge: the seams would have too many strands.

    Attributes:
        instance: the one with a single live loop in each cell.
        seams: those that are edges there.
    """

    def __init__(self, instance: Instance) -> None:
        self.instance = instance
        self.seams: tuple[Seam, ...] = ()
        self._name: dict[int, Strand] = {}
        if instance.most_live_loops < 2:
            return
        once = dict.fromkeys(instance.live_edges, 1)
        self.seams = wide_enough_seams(instance, once)
        strands = sum(seam.strands for seam in self.seams)
        if strands > MOST_STRANDS:
            message = f"the seams need {strands} strands, {MOST_STRANDS} at most become edges"
            raise TooLarge(message)
        graph = dart_graph(instance, once, self.seams)
        virtual = {seam.id for seam in self.seams}
        edges = {
            edge: replace(instance.edge(edge), colors=tuple(instance.joinable(edge)))
            for edge in instance.live_edges
        }
        last = max(edges)
        number = {(edge, 1): edge for edge in edges}
        for dart in graph.darts:
            edge, strand = dart.name
            if edge in virtual:  # and not the other side of it
                last += 1
                edges[last] = Edge(last, dart.cell, dart.cell)
                number[edge, strand] = last
                self._name[last] = dart.name
        cells = []
        for cell, darts in zip(instance.cells, graph.lists, strict=True):
            names = [graph.darts[dart].name for dart in darts]
            loop = tuple(number[abs(d), s] * (1 if d > 0 else -1) for d, s in names)
            cells.append(Cell(cell.id, cell.colors, (loop,) if loop else ()))
        ordered = tuple(edges[edge] for edge in sorted(edges))
        self.instance = replace(instance, cells=tuple(cells), edges=ordered, known=None)

    def division(self, found: Division) -> Division:
        """A division of the instance with seams as edges, for the one without."""
        return number_segments(
            [
                [(own.color, [self._named(dart) for dart in own.darts]) for own in cell.subcells]
                for cell in found
            ]
        )

    def _named(self, dart: DartName) -> DartName:
        assert isinstance(dart, int)  # one strand an edge
        if abs(dart) not in self._name:
            return dart
        seam, strand = self._name[abs(dart)]
        return (seam if dart > 0 else -seam), strand
