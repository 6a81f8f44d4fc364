"""Paintings judged without the checker and the graph, and random divisions to be painted."""

from __future__ import annotations

import random

import networkx as nx
import numpy as np
from random_divisions import random_division, random_seams

from cellcolor.data.instance import Instance
from cellcolor.data.solution import InstanceReference, Solution, count_segments
from cellcolor.data.surface import LabelledSurface
from cellcolor.painting.paint import Painted


def random_solution(instance: Instance, strands: int, rng: random.Random) -> Solution:
    """A division drawn at random as a solution: legal to draw, whatever it costs."""
    seams = random_seams(instance, 2, rng)
    division = random_division(instance, seams, strands, rng)
    segments = count_segments(division)
    return Solution(
        InstanceReference(instance.name, instance.sha256), "surface", strands, "by chance",
        "feasible", segments, max(0, segments - 1), 0, 0, False, seams, division, 0.0,
    )  # fmt: skip


def assert_whole(surface: LabelledSurface, painted: Painted, solution: Solution) -> None:
    """Every segment is one connected set of vertices in a color that all of them have.

    Flooded here over the refined mesh, with neither the checker nor the graph.
    """
    fine = painted.surface
    assert fine.vertex_colors[: len(surface.vertices)] == surface.vertex_colors
    assert np.allclose(painted.interpolated(surface.vertices), fine.vertices)
    assert solution.cells is not None and solution.segments is not None
    color = {sub.segment: sub.color for cell in solution.cells for sub in cell.subcells}
    cracks = {(crack.i, crack.j): crack.colors for crack in fine.cracks}
    members: dict[int, nx.Graph[int]] = {}
    for vertex, segment in enumerate(painted.segment_of.tolist()):
        own = fine.vertex_colors[vertex]
        assert (segment == -1) == (not own)
        if own:
            assert color[segment] in own
            assert painted.plan.vertex_colors[vertex] == color[segment]
            members.setdefault(segment, nx.Graph()).add_node(vertex)
    for a, b in fine.left_of:
        segment = int(painted.segment_of[a])
        if segment == -1 or segment != painted.segment_of[b]:
            continue
        if color[segment] not in cracks.get((min(a, b), max(a, b)), ()):
            members[segment].add_edge(a, b)
    assert all(nx.is_connected(graph) for graph in members.values())
    # What hangs on seams only is no part of the surface; all else is painted.
    assert len(members) <= solution.segments
    assert painted.segments == len(members) - sum(len(group) - 1 for group in painted.merged)
