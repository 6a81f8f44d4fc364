"""The model's variables.

Every dart in state 1 points at another dart: across its edge, along its sub-cell to the next dart
in state 1, or nowhere when it is the root of its segment. Pointers without a cycle
make a forest, and every tree of it is one segment.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from ortools.sat.python import cp_model

from cellcolor.solvers.cpsat.model.dart_graph import DartGraph


@dataclass(frozen=True, slots=True)
class Variables:
    """Literals and ranks, by dart index (see ``DartGraph``).

    Attributes:
        joined: per edge (its lower dart) and color: the edge is joined in that color, and the
            join is counted. Joins that only close a cycle of sub-cells are never counted.
        up: per dart: its sub-cell's parent lies across it.
        forward: per two darts of a cell, in list order: they are neighbours within one sub-cell,
            and the first points at the second.
        backward: likewise, and the second points at the first.
        root: per dart: it is the root of its segment.
        alone: per cell: it has no dart in state 1, and is a segment of its own.
        rank: per dart: falls along every pointer, strictly across edges.
        bridges: per two darts on loops of one cell that no seam connects: they are in one
            sub-cell, and the first points at the second (see ``loops_apart``).
    """

    joined: dict[tuple[int, int], cp_model.IntVar]
    up: list[cp_model.IntVar]
    forward: dict[tuple[int, int], cp_model.IntVar]
    backward: dict[tuple[int, int], cp_model.IntVar]
    root: list[cp_model.IntVar]
    alone: list[cp_model.IntVar]
    rank: list[cp_model.IntVar]
    bridges: dict[tuple[int, int], cp_model.IntVar] = field(default_factory=dict)

    def links(self, one: int, other: int) -> tuple[cp_model.IntVar, ...]:
        """The literals that link two darts, none if they share no color."""
        pair = (one, other)
        return (self.forward[pair], self.backward[pair]) if pair in self.forward else ()


def make_variables(model: cp_model.CpModel, graph: DartGraph) -> Variables:
    """Add the variables of a dart graph to an empty model."""
    darts = range(len(graph.darts))
    edges = graph.edges
    joined = {
        (edge, color): model.new_bool_var(f"joined_{edge}_{color}")
        for edge in edges
        for color in sorted(graph.darts[edge].colors)
    }
    pairs = [
        (one, other)
        for cell in graph.lists
        for place, one in enumerate(cell)
        for other in cell[place + 1 :]
        if graph.darts[one].colors & graph.darts[other].colors
    ]
    return Variables(
        joined,
        [model.new_bool_var(f"up_{dart}") for dart in darts],
        {pair: model.new_bool_var("forward_{}_{}".format(*pair)) for pair in pairs},
        {pair: model.new_bool_var("backward_{}_{}".format(*pair)) for pair in pairs},
        [model.new_bool_var(f"root_{dart}") for dart in darts],
        [model.new_bool_var(f"alone_{cell}") for cell in range(len(graph.lists))],
        [model.new_int_var(0, len(edges), f"rank_{dart}") for dart in darts],
    )
