"""The cost of a painting (paper, section V-A), counted in segments and taken at its word."""

from __future__ import annotations

import pytest
from exhaustive_minima import minimum
from library import PAPER
from meshes import drawn
from reference import SOLVER, segments

from cellcolor.data.cells_and_edges import twin
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, count_segments, number_segments
from cellcolor.deadline import NEVER
from cellcolor.decomposition import decompose
from cellcolor.lab.families import planar_graph
from cellcolor.solvers.dfs.graph import Graph
from cellcolor.solvers.dfs.search import DepthFirstSearch
from cellcolor.solvers.interface import Options


def literal_cost(division: Division) -> int:
    """What ``Δcost = 1 - j`` adds up to when j counts distinct solved *cells*.

    A sub-cell is a cell here, since the paper divides a cell "into a set of cells with less edges".
    Each adds 1 and takes off the number of distinct ones that it joins and that were solved before
    it, so that the order does not matter: the sum is the number of sub-cells less the number of
    joined pairs. That is the number of segments only where no joined sub-cells close a circle.
    """
    subcells = [subcell for cell in division for subcell in cell.subcells]
    holder = {dart: number for number, own in enumerate(subcells) for dart in own.darts}
    pairs = {frozenset((one, holder[twin(dart)])) for dart, one in holder.items()}
    return len(subcells) - sum(len(pair) == 2 for pair in pairs)


def test_literal_cost_counts_a_cycle_as_less_than_nothing() -> None:
    """Three cells around a corner, painted alike: one segment, but 3 sub-cells - 3 pairs = 0."""
    instance = Instance.read(PAPER / "triple-junction.json")
    answer = SOLVER.minimize(instance, Options())
    assert answer.division is not None
    assert segments(instance, answer) == 1
    assert literal_cost(answer.division) == 0


def test_literal_cost_counts_pairs_not_edges() -> None:
    """Two cells joined across two edges are one pair ("Right" of the cost figure): 2 - 1."""
    instance = Instance.read(PAPER / "ring.json")
    division = SOLVER.minimize(instance, Options()).division
    assert division is not None
    assert sorted(len(s.darts) for cell in division for s in cell.subcells) == [0, 2, 2]
    assert literal_cost(division) == 2


def test_literal_cost_prefers_a_circle_to_a_division_with_fewer_segments() -> None:
    """r is red, R red or green, b blue, a and c are red or blue (c also green).

    Blue a and c connect the two b: one red and one blue segment. Red ones connect nothing that is
    not connected without them, so there are 3 segments. But r, R, a and c are joined in six pairs
    then: 4 - 6, and 2 for the two b.
    """
    labels = {"r": [0], "R": [0, 2], "b": [1], "a": [0, 1], "c": [0, 1, 2]}
    instance = decompose(drawn("rbR raR rcR rbR rrR", labels))
    graph = Graph(instance, 1)
    (part,) = graph.parts()
    cells = [graph.cell(cell, 0)[0] for cell in part]
    everything = DepthFirstSearch(graph, cells, NEVER).paintings()
    costs = []
    for painting in everything:
        blocks = {
            cell.id: [(color, [cell.darts[i] for i in darts]) for color, darts in scheme.subcells]
            for cell, scheme in zip(cells, painting.schemes, strict=True)
        }
        division = number_segments([blocks[cell.id] for cell in instance.cells])
        assert count_segments(division) == painting.cost
        costs.append((literal_cost(division), painting.cost))
    assert min(cost for _, cost in costs) == minimum(instance) == 2
    assert min(costs) == (0, 3)
    assert {literal for literal, cost in costs if cost == 2} == {2}


@pytest.mark.parametrize("seed", [1, 149, 150, 156, 250])
def test_the_cost_so_far_may_fall(seed: int) -> None:
    """A branch that costs as much as the best one so far may still come to the minimum."""
    instance = planar_graph(seed, 5, 8, 3)
    assert segments(instance, SOLVER.minimize(instance, Options())) == minimum(instance) == 1
