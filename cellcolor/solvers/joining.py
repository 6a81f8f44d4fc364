"""Joining what has equal colors, for solvers and planners that only know colors."""

from __future__ import annotations

from collections.abc import Sequence

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Seam
from cellcolor.solvers.cpsat.dart_graph import dart_graph
from cellcolor.solvers.cpsat.painting import canonical, division_of, painting_of


def joined(
    instance: Instance, division: Division, seams: Sequence[Seam] = (), strands: int = 1
) -> Division:
    """The scheme of a division: edges between equal joinable colors are joined.

    A division in which some edge in state 0 has to show one joinable color on both sides is refused
    by the checker (docs/semantics.md, section 3, rule 5). Joining these edges repairs it. Sub-cells
    of equal color without anything between them become one, and what is superfluous goes; there
    are no more segments than before (section 8).

    Args:
        division: legal otherwise; cells may be painted whole, without any joined edge.
        seams: those that its darts refer to.
        strands: for each live edge.
    """
    graph = dart_graph(instance, dict.fromkeys(instance.live_edges, strands), seams)
    return division_of(graph, canonical(graph, painting_of(graph, division)), strands)
