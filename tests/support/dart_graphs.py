"""Dart graphs of whole instances, as the CP-SAT solver's tests look at them."""

from __future__ import annotations

from cellcolor.data.instance import Instance
from cellcolor.solvers.cpsat.dart_graph import DartGraph, dart_graph, wide_enough_seams


def graph_of(instance: Instance, strands: int = 1) -> DartGraph:
    """With seams as wide as they can have to be."""
    counts = {edge.id: strands for edge in instance.edges}
    return dart_graph(instance, counts, wide_enough_seams(instance, counts))
