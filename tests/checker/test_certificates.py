"""Certificates of lower bounds: verified without a solver, and not when they are forged."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES
from meshes import drawn, surfaces

import cellcolor
from cellcolor.checker.certificates import verify_bound
from cellcolor.checker.claimed_numbers import claims
from cellcolor.checker.division import check_solution
from cellcolor.checker.groups import regions_of_cells, regions_on_surface
from cellcolor.data.bounds import Bound
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decomposition_of
from cellcolor.lab.families import planar_graph
from cellcolor.solvers import checked
from examples import examples

SEEDS = st.integers(0, 10**6)
THREE = drawn("AAB CAB CCB", {"A": [0, 1], "B": [1, 2], "C": [0, 2]})
"""Any two of its three cells share a color, and no color is in all of them: two are needed."""


def touched_by(instance: Instance) -> list[set[int]]:
    """The cells of every color region, by networkx."""
    found = []
    for color in range(len(instance.colors)):
        graph = nx.Graph()
        graph.add_nodes_from(cell.id for cell in instance.cells if color in cell.colors)
        graph.add_edges_from(
            (edge.left, edge.right)
            for edge in instance.edges
            if color in instance.joinable(edge.id)
        )
        found += list(nx.connected_components(graph))
    return found


def enough(instance: Instance, cells: Sequence[int], regions: int) -> bool:
    """Whether so many color regions touch all of the cells, by trying them all."""
    every = touched_by(instance)
    return any(
        set(cells) <= set().union(*chosen)
        for chosen in itertools.combinations(every, min(regions, len(every)))
    )


@examples(30)
@given(seed=SEEDS, cells=st.integers(1, 8), colors=st.integers(1, 4))
def test_a_certificate_proves_its_bound(seed: int, cells: int, colors: int) -> None:
    instance = planar_graph(seed, cells, cells + 3, colors)
    solution = cellcolor.solve(instance, workers=1).solution
    (bound,) = [bound for bound in solution.bounds or () if bound.kind == "cover"]
    assert bound.certificate is not None
    assert not enough(instance, bound.certificate["cells"], bound.value - 1)
    assert verify_bound(instance, bound, regions_of_cells(instance)).outcome == "verified"


@examples(40)
@given(seed=SEEDS, cells=st.integers(1, 7), colors=st.integers(1, 4), data=st.data())
def test_what_some_cells_prove_and_what_not(
    seed: int, cells: int, colors: int, data: st.DataObject
) -> None:
    """Any cells and any number: verified exactly where trying all regions says so."""
    instance = planar_graph(seed, cells, cells + 3, colors)
    chosen = data.draw(st.lists(st.sampled_from(range(len(instance.cells))), min_size=1))
    value = data.draw(st.integers(1, 5))
    verdict = verify_bound(
        instance, Bound("cover", value, "surface", {"cells": chosen}), regions_of_cells(instance)
    )
    expected = "refused" if enough(instance, chosen, value - 1) else "verified"
    assert verdict.outcome == expected
    assert bool(verdict.reason) == (expected == "refused")


@examples(30)
@given(surfaces())
def test_the_mesh_says_what_the_graph_says(surface: LabelledSurface) -> None:
    """Two cells share a color region on the mesh exactly where they do on the graph."""
    decomposition = decomposition_of(surface, None)
    made = decomposition.instance
    graph = regions_of_cells(made)
    mesh = regions_on_surface(surface, decomposition.vertex_cell)
    assert [{color for color, _ in own} for own in mesh] == [set(c.colors) for c in made.cells]
    for one, other in itertools.combinations(range(len(made.cells)), 2):
        for color in set(made.cells[one].colors) & set(made.cells[other].colors):
            shared = [
                any(region[0] == color for region in own[one] & own[other]) for own in (graph, mesh)
            ]
            assert shared[0] == shared[1]


@pytest.mark.parametrize(
    ("certificate", "reason"),
    [
        ({"cells": [0, 9]}, "there is no cell 9"),
        ({"cells": [0, -1]}, "there is no cell -1"),
        ({"cells": "all"}, "cells: Input should be a valid array"),
        ({"cells": [True]}, "cells[0]: Input should be a valid integer, is true"),
        ({}, "cells: is missing"),
        ({"cells": [0, 1, 2], "hubs": []}, "hubs: unknown key"),
        ({"cells": []}, "fewer than 2 color regions touch all of the cells []"),
        ({"cells": [0, 1]}, "fewer than 2 color regions touch all of the cells [0, 1]"),
    ],
)
def test_a_forged_certificate_is_refused(certificate: dict[str, object], reason: str) -> None:
    instance = cellcolor.decompose(THREE)
    bound = Bound("cover", 2, "surface", certificate)
    verdict = verify_bound(instance, bound, regions_of_cells(instance))
    assert (verdict.outcome, verdict.reason) == ("refused", reason)
    solution = cellcolor.solve(instance).solution
    report = check_solution(instance, replace(solution, bounds=(bound,)))
    assert report.problems == (f"bounds[0].certificate: {reason}",)


def test_where_no_two_cells_are_strangers_choices_are_tried_up_to_the_budget() -> None:
    instance = cellcolor.decompose(THREE)
    solution = cellcolor.solve(instance).solution
    (bound,) = solution.bounds or ()
    assert bound.value == 2 and bound.certificate == {"cells": [0, 1, 2]}
    regions = regions_of_cells(instance)
    # Each of the two colors of a first cell leaves the cell that lacks it untouched.
    assert verify_bound(instance, bound, regions).tried == 2
    assert verify_bound(instance, bound, regions, budget=1).outcome == "budget exceeded"


def test_a_deadline_ends_it_as_the_budget_does() -> None:
    instance = cellcolor.decompose(THREE)
    (bound,) = cellcolor.solve(instance).solution.bounds or ()
    late = verify_bound(instance, bound, regions_of_cells(instance), deadline=Deadline(0.0))
    assert late.outcome == "budget exceeded"


def test_a_certificate_that_is_not_verified_in_time_is_not_handed_out(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Nobody has seen it prove its bound, and a refused one would make the solution invalid."""
    monkeypatch.setattr(checked, "FEW_STEPS", 1)
    instance = cellcolor.decompose(THREE)
    (bound,) = cellcolor.solve(instance).solution.bounds or ()
    assert bound.value == 2 and bound.certificate is None


def test_a_bound_of_another_kind_has_none() -> None:
    instance = cellcolor.decompose(THREE)
    for kind in ("crossings", "model", "search", "hubs", "whatever"):
        bound = Bound(kind, 3, "surface", {"cells": [0]})
        assert verify_bound(instance, bound, regions_of_cells(instance)).outcome == "no certificate"


HUB = {"value": 2, "cells": [0, 1], "conflicts": [], "hubs": [2]}
TANGLE = {"segments": [{"color": 0, "groups": [[[0]], [[2]]], "avoided": [1]}]}
PLAIN = {"value": 2, "cells": [0], "conflicts": []}
TANGLED = {"value": 2, "cells": [0, 1, 2], "conflicts": [], "tangles": [TANGLE]}


@pytest.mark.parametrize(
    ("kind", "steps", "parts"),
    [
        ("hubs", [], [HUB]),
        ("conflicts", [], [HUB]),
        ("conflicts", [], [TANGLED]),
        ("conflicts", [], [{**TANGLED, "tangles": []}]),
        ("conflicts", [], [PLAIN, TANGLED]),
        ("conflicts", [[0, 0, 1]], [PLAIN]),
    ],
)
def test_an_older_certificate_of_a_kind_that_is_gone_is_neither_verified_nor_refused(
    kind: str, steps: list[list[int]], parts: list[dict[str, object]]
) -> None:
    """Nothing verifies it any more; the solution stays valid, and its bound is a claim."""
    instance = cellcolor.decompose(THREE)
    bound = Bound(kind, 2, "surface", {"left_out": steps, "parts": parts})
    solution = replace(cellcolor.solve(instance).solution, bounds=(bound,))
    report = cellcolor.check(instance, Solution.from_document(solution.to_document()))
    assert report.valid
    assert [verdict.outcome for verdict in report.bounds] == ["no certificate"]
    assert claims(instance, solution, report.bounds)["lower_bound"] == 2


@pytest.mark.parametrize("name", ["wok", "half_pipe", "hemisphere_flat"])
def test_the_minima_of_the_scenes_are_verified_on_their_surfaces(name: str) -> None:
    surface = INSTANCES / "scenes" / f"{name}.surface.json"
    report = cellcolor.check(surface, cellcolor.solve(surface))
    assert report.valid
    assert max(v.bound.value for v in report.bounds if v.outcome == "verified") == report.segments
