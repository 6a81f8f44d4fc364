"""The constraint groups of the model: the defining ones are needed, the others change nothing."""

from __future__ import annotations

from dataclasses import replace

import pytest
from dart_graphs import graph_of
from exhaustive_minima import minimum
from library import INSTANCES, PAPER
from ortools.sat.python import cp_model
from rooms import hub

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.lab.families import planar_graph
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.model.constraints import DEFINING, REDUNDANT, Group
from cellcolor.solvers.cpsat.model.full import full_model

RED, BLUE = 0, 1


def effort(instance: Instance, groups: tuple[Group, ...], limit: float) -> tuple[bool, int]:
    """Whether one worker proves the minimum within so many deterministic seconds; its conflicts."""
    built = full_model(graph_of(instance), color_regions(instance), groups)
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    solver.parameters.random_seed = 0
    solver.parameters.max_deterministic_time = limit
    return solver.solve(built.model) == cp_model.OPTIMAL, solver.num_conflicts


def model_minimum(instance: Instance, groups: tuple[Group, ...], strands: int = 1) -> int:
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    built = full_model(graph_of(instance, strands), color_regions(instance), groups)
    assert solver.solve(built.model) == cp_model.OPTIMAL
    return round(solver.objective_value)


TRIPLE = Instance.read(PAPER / "triple-junction.json")

MIXED = Instance(
    "a petal of both colors between a red and a blue one",
    ("red", "blue"),
    tuple(replace(c, colors=(RED, BLUE)) if c.id == 2 else c for c in hub(RED, RED, BLUE).cells),
    hub(RED, RED, BLUE).edges,
)


@pytest.mark.parametrize(
    ("group", "instance", "segments"),
    [
        # The middle petal, joined in both colors, would join the other two to one sub-cell.
        ("one_color", MIXED, 2),
        # Without pointers a cell joined on two sides need not be divided, nor have a root.
        ("one_pointer", hub(RED, BLUE), 2),
        # So would links between darts that are joined in different colors.
        ("equal_colors", MIXED, 2),
        # Red and blue petals in turn: only one color can be joined through the hub.
        ("no_crossing", hub(RED, BLUE, RED, BLUE), 3),
        # Cells without a joined dart cost a segment each.
        ("roots", hub(RED, BLUE), 2),
        # Three cells around a corner: their three joins would be a circle without a root.
        ("no_circles", TRIPLE, 1),
    ],
)
def test_every_defining_group_is_needed(group: str, instance: Instance, segments: int) -> None:
    assert minimum(instance) == segments
    assert model_minimum(instance, DEFINING) == segments
    rest = tuple(g for g in DEFINING if g.__name__ != group)
    assert len(rest) == len(DEFINING) - 1
    assert model_minimum(instance, rest) < segments


def feasible(instance: Instance, groups: tuple[Group, ...], *links: tuple[int, int]) -> bool:
    """Whether the first darts of cell 0 can be linked like this, the first of a pair pointing."""
    graph = graph_of(instance)
    built = full_model(graph, color_regions(instance), groups)
    for one, other in links:
        low, high = sorted((graph.lists[0][one], graph.lists[0][other]))
        built.model.add(built.variables.links(low, high)[one > other] == 1)
    solver = cp_model.CpSolver()
    return solver.solve(built.model) in (cp_model.OPTIMAL, cp_model.FEASIBLE)


def test_sub_cells_are_chains() -> None:
    """Without this group a sub-cell could be linked as a star, which is read as two sub-cells."""
    instance = hub(RED, RED, RED)
    rest = tuple(g for g in DEFINING if g.__name__ != "one_chain")
    assert feasible(instance, DEFINING, (2, 1), (1, 0))
    assert not feasible(instance, DEFINING, (2, 0), (1, 0))
    assert feasible(instance, rest, (2, 0), (1, 0))


@pytest.mark.parametrize("group", REDUNDANT, ids=lambda group: group.__name__)
def test_redundant_groups_change_no_minimum(group: Group) -> None:
    for seed in range(6):
        instance = planar_graph(seed, 5, 7, 3)
        assert model_minimum(instance, (*DEFINING, group)) == minimum(instance)


def test_strands_in_turn_change_no_minimum() -> None:
    rest = tuple(g for g in DEFINING + REDUNDANT if g.__name__ != "strands_in_turn")
    for seed in range(6):
        instance = planar_graph(seed, 4, 5, 3)
        plain = model_minimum(instance, rest, 2)
        assert model_minimum(instance, DEFINING + REDUNDANT, 2) == plain


def test_all_redundant_groups_together_change_no_minimum() -> None:
    for seed in range(20):
        instance = planar_graph(seed, 6, 10, 3)
        assert model_minimum(instance, DEFINING + REDUNDANT) == minimum(instance)


@pytest.mark.parametrize("name", ["cover", "forced_roots"])
def test_bounds_on_robot_scenes(name: str) -> None:
    """Each of the two lets one worker prove a scene that it cannot prove without both."""
    path = INSTANCES / "scenes" / "feasibility" / "hemisphere_flat_2000.surface.json"
    scene = decompose(LabelledSurface.read(path))
    group = next(g for g in REDUNDANT if g.__name__ == name)
    assert effort(scene, (*DEFINING, group), 0.4)[0]
    assert not effort(scene, DEFINING, 0.4)[0]


def test_strands_are_used_in_turn() -> None:
    """Two red corridors across one edge of two strands, or only its second strand."""
    instance = hub(RED)
    graph = graph_of(instance, 2)
    for used, expected in (((1,), True), ((2,), False), ((1, 2), False)):
        built = full_model(graph, color_regions(instance))
        names = {graph.darts[edge].name[1]: edge for edge in graph.edges}
        for strand, edge in names.items():
            built.model.add(built.variables.joined[edge, RED] == (strand in used))
        found = cp_model.CpSolver().solve(built.model)
        assert (found in (cp_model.OPTIMAL, cp_model.FEASIBLE)) == expected


def test_most_links_proves_hubs() -> None:
    instance = Instance.read(INSTANCES / "random" / "hub_24.json")
    rest = tuple(g for g in DEFINING + REDUNDANT if g.__name__ != "most_links")
    assert effort(instance, DEFINING + REDUNDANT, 2.0)[1] * 10 < effort(instance, rest, 2.0)[1]


@pytest.mark.parametrize("name", ["first_petal", "forced_roots"])
def test_only_the_first_petal_of_a_sub_cell_is_a_root(name: str) -> None:
    """Without that the first petal's dart can point at the second's, whose parent is its petal."""
    instance = hub(RED, RED, BLUE, BLUE)
    group = next(g for g in REDUNDANT if g.__name__ == name)
    assert not feasible(instance, (*DEFINING, group), (0, 1), (2, 3))
    assert feasible(instance, (*DEFINING, group), (1, 0), (3, 2))
    assert feasible(instance, DEFINING, (0, 1), (2, 3))
