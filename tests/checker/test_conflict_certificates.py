"""Segments that would have to cross: held against all colorings of small meshes, and forged."""

from __future__ import annotations

import copy
import itertools
import random
from typing import Any

import networkx as nx
import pytest
from exhaustive_minima import minimum
from hypothesis import assume, given, reject
from hypothesis import strategies as st
from library import INSTANCES
from meshes import drawn, surfaces
from rooms import can_pass, crossed_rings
from vertex_minima import vertex_minimum

import cellcolor
from cellcolor.checker.certificates import BoundVerdict, verify_bound
from cellcolor.checker.crossing_segments import TwoRegions
from cellcolor.checker.groups import regions_of_cells
from cellcolor.data.bounds import Bound
from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose, decomposition_of
from cellcolor.errors import InputError
from cellcolor.lab.families import LARGE, blobs, planar_graph
from examples import examples

RED, BLUE = 0, 1
LABELS = {"R": [RED], "B": [BLUE], "M": [RED, BLUE], ".": []}
# Red above and below, blue to the left and to the right of a middle that has both.
CROSS = drawn(".R. BMB .R.", LABELS)


def verdict(instance: Instance, bound: Bound) -> BoundVerdict:
    return verify_bound(instance, bound, regions_of_cells(instance))


def two_regions(surface: LabelledSurface) -> list[tuple[TwoRegions, tuple[int, ...]]]:
    """Each pair of a red region and a blue one, with the cell of every vertex."""
    made = decomposition_of(surface, None)
    regions = regions_of_cells(made.instance)
    every = sorted(set().union(*regions))
    cells = {r: frozenset(c for c, own in enumerate(regions) if r in own) for r in every}
    return [
        (
            TwoRegions(made.instance, (RED, BLUE), (cells[a], cells[b]), lambda _: None),
            made.vertex_cell,
        )
        for a, b in itertools.product(every, every)
        if a[0] == RED and b[0] == BLUE
    ]


def together(
    surface: LabelledSurface, colors: tuple[int | None, ...], color: int
) -> list[set[int]]:
    """The vertices of each segment of a color, by networkx."""
    graph = nx.Graph()
    graph.add_nodes_from(v for v, own in enumerate(colors) if own == color)
    graph.add_edges_from(
        (a, b)
        for a, b in surface.left_of
        if colors[a] == colors[b] == color and color not in surface.cracked(a, b)
    )
    return list(nx.connected_components(graph))


@examples(40)
@given(st.data())
def test_what_must_cross_is_connected_by_no_coloring(data: st.DataObject) -> None:
    """All colorings of the vertices that have both colors, at most eight of them."""
    rows = data.draw(st.integers(3, 4))
    letters = data.draw(st.lists(st.sampled_from("RRBBM."), min_size=4 * rows, max_size=4 * rows))
    shared = [place for place, letter in enumerate(letters) if letter == "M"]
    for place in shared[8:]:
        letters[place] = "R"
    surface = drawn(" ".join("".join(letters[4 * r : 4 * r + 4]) for r in range(rows)), LABELS)
    claims = []
    for two, cell_of in two_regions(surface):
        red, blue = (sorted(own - other) for own, other in (two.cells, two.cells[::-1]))
        pairs = itertools.product(itertools.combinations(red, 2), itertools.combinations(blue, 2))
        claims += [(*ends, cell_of) for ends in pairs if two.must_cross(*ends)]
    if not claims:
        return
    choices = [own or (None,) for own in surface.vertex_colors]
    for colors in itertools.product(*choices):
        segments = [together(surface, colors, color) for color in (RED, BLUE)]
        for one, other, cell_of in claims:
            joined = [
                any(set(pair) <= {cell_of[v] for v in segment} for segment in found)
                for pair, found in zip((one, other), segments, strict=True)
            ]
            assert not all(joined)


def test_four_areas_around_a_hub() -> None:
    ((two, cell_of),) = two_regions(CROSS)
    above, left, right, below = (cell_of[v] for v in (1, 3, 5, 7))
    assert two.must_cross((above, below), (left, right))
    # Neighbors need not cross, and a cell with both colors is no end.
    assert not two.must_cross((above, above), (left, right))
    assert not two.must_cross((above, cell_of[4]), (left, right))
    assert not two.must_cross((left, right), (above, below))


@examples(20)
@given(seed=st.integers(0, 10**6), cells=st.integers(3, 8), colors=st.integers(2, 4))
def test_every_bound_by_conflicts_is_verified(seed: int, cells: int, colors: int) -> None:
    instance = planar_graph(seed, cells, cells + 4, colors)
    for bound in cellcolor.solve(instance, workers=1).solution.bounds or ():
        if bound.kind in ("cover", "conflicts"):
            assert verdict(instance, bound).outcome == "verified"


@pytest.mark.parametrize("seed", [5, 22])
def test_cells_that_the_other_segment_would_have_to_pass(seed: int) -> None:
    """Thin bands: some ways cross evenly, but only through cells that cannot be passed."""
    instance = cellcolor.decompose(blobs(seed, size=20, thin=True))
    solution = cellcolor.solve(instance).solution
    (bound,) = [b for b in solution.bounds or () if b.kind == "conflicts"]
    assert bound.value == solution.segments
    assert verdict(instance, bound).outcome == "verified"


@examples(30)
@given(mesh=crossed_rings(), data=st.data())
def test_what_must_cross_cannot_pass_around_a_handle(
    mesh: LabelledSurface, data: st.DataObject
) -> None:
    """Conflicts on a torus, against all paths over mesh vertices."""
    try:
        claims = two_regions(mesh)
    except InputError:
        reject()
    assume(claims)
    two, cell_of = data.draw(st.sampled_from(claims))
    red, blue = (sorted(own - other) for own, other in (two.cells, two.cells[::-1]))
    assume(len(red) > 1 and len(blue) > 1)
    for _ in range(6):
        one, other = (
            data.draw(st.lists(st.sampled_from(own), min_size=2, max_size=2, unique=True))
            for own in (red, blue)
        )
        if two.must_cross((one[0], one[1]), (other[0], other[1])):
            ends = [
                [{v for v, own in enumerate(cell_of) if own == cell} for cell in pair]
                for pair in (one, other)
            ]
            assert not can_pass(mesh, (RED, BLUE), *ends)


@examples(20)
@given(mesh=st.one_of(surfaces(), crossed_rings()))
def test_a_verified_bound_holds_on_the_mesh(mesh: LabelledSurface) -> None:
    """Against a sweep over vertex colorings, which knows no cells; nothing is taken on trust."""
    try:
        instance = decompose(mesh)
    except InputError:
        reject()
    assume(len(instance.cells) > 1)  # one cell of three colors takes the sweep half a minute
    minimum = vertex_minimum(mesh)
    for bound in cellcolor.solve(instance, workers=1).solution.bounds or ():
        if bound.certificate is not None:
            assert verdict(instance, bound).outcome == "verified"
            assert bound.value <= minimum
            more = Bound(bound.kind, minimum + 1, "surface", bound.certificate)
            assert verdict(instance, more).outcome == "refused"


def test_conflicts_around_handles_are_verified() -> None:
    made = LARGE["torus"](10)
    assert isinstance(made, LabelledSurface)
    instance = decompose(made)
    solution = cellcolor.solve(instance, time_limit=60).solution
    bound = next(b for b in solution.bounds or () if b.kind == "conflicts")
    assert (bound.value, verdict(instance, bound).outcome) == (solution.segments, "verified")


def conflicts_of(name: str) -> tuple[Instance, Bound]:
    """A graph, and the bound by conflicts of its stored solution."""
    instance = Instance.read(INSTANCES / name)
    solution = Solution.read(INSTANCES / "solutions" / f"{instance.name}.solution.json")
    return instance, next(b for b in solution.bounds or () if b.kind == "conflicts")


NAMES = ["paper/annulus.json", "paper/figeasycell4.json"]


NONSENSE = [None, True, 1.5, "0", [], {}, [[]], -1, 10**30, {"cells": [0]}]


def places(holder: Any) -> list[tuple[Any, Any]]:
    """Every place in some nested lists and objects: what holds it, and the key or index there."""
    found = []
    todo = [holder]
    while todo:
        inner = todo.pop()
        for key in sorted(inner) if isinstance(inner, dict) else range(len(inner)):
            found.append((inner, key))
            if isinstance(inner[key], (dict, list)):
                todo.append(inner[key])
    return found


def forged(certificate: dict[str, Any], cells: int, colors: int, seed: int) -> dict[str, Any]:
    """One thing changed: something else, one more, one missing, one twice, or by another name."""
    chance = random.Random(seed)
    changed = copy.deepcopy(certificate)
    parts = changed["parts"]
    part = chance.choice(parts)
    conflicts = part["conflicts"]
    holder, key = chance.choice(places(changed))
    match chance.randrange(11):
        case 0 if part["cells"]:
            part["cells"][chance.randrange(len(part["cells"]))] = chance.randrange(-1, cells + 1)
        case 1 if conflicts:
            ends = chance.choice(conflicts)[chance.choice(["one", "other"])]
            ends[chance.randrange(2)] = [chance.randrange(cells)]
        case 2 if conflicts:
            chance.choice(conflicts)["colors"][chance.randrange(2)] = chance.randrange(colors)
        case 3 if conflicts:
            conflict = copy.deepcopy(chance.choice(conflicts))
            conflict["one"], conflict["other"] = conflict["other"], conflict["one"]
            conflicts.append(conflict)
        case 4:
            holder[key] = copy.deepcopy(chance.choice(NONSENSE))
        case 5:
            del holder[key]
        case 6 if isinstance(holder, dict):
            holder[chance.choice(["Cells", "", "value "])] = holder.pop(key)
        case 7 if isinstance(holder, list):
            holder.extend([holder[key]] * chance.choice([1, 3000]))
        case 8:  # as if no color region lay in two
            parts[:] = [{"value": 1, "cells": [cell], "conflicts": []} for cell in range(cells)]
        case 9:  # as if the cover were not minimal
            part["cells"] = list(range(cells))
            part["value"] += 1
        case _:
            part["value"] += chance.randint(1, 3)
    return changed


@pytest.mark.parametrize("name", NAMES)
def test_whatever_is_changed_nothing_false_is_verified(name: str) -> None:
    """A changed certificate may still prove its number, but none above a division that exists."""
    instance, bound = conflicts_of(name)
    assert bound.certificate is not None
    fewest = bound.value  # a division has as many
    regions = regions_of_cells(instance)
    outcomes = []
    for seed in range(300):
        certificate = forged(bound.certificate, len(instance.cells), len(instance.colors), seed)
        for value in (bound.value, bound.value + 1, len(instance.cells) + 1):
            claim = Bound("conflicts", value, "surface", certificate)
            outcomes.append(verify_bound(instance, claim, regions, budget=2000).outcome)
            assert outcomes[-1] != "verified" or value <= fewest, seed
    assert outcomes.count("refused") > 600


@examples(30)
@given(seed=st.integers(0, 10**6), change=st.integers(0, 10**6))
def test_nothing_false_is_verified_on_random_graphs(seed: int, change: int) -> None:
    """Made-up conflicts, against the minimum by trying all divisions."""
    instance = planar_graph(seed, 4, 8, 3)
    assume(instance.most_live_darts <= 8)  # more take minutes to try all divisions of
    chance = random.Random(change)
    crossings = [
        {
            "colors": chance.sample(range(3), 2),
            "one": [[chance.randrange(4)], [chance.randrange(4)]],
            "other": [[chance.randrange(4)], [chance.randrange(4)]],
        }
        for _ in range(chance.randrange(4))
    ]
    fewest = minimum(instance)
    for conflicts in ([], crossings):
        part = {"value": fewest + 1, "cells": [0, 1, 2, 3], "conflicts": conflicts}
        certificate = {"parts": [part]}
        claim = Bound("conflicts", fewest + 1, "surface", certificate)
        assert verdict(instance, claim).outcome == "refused"


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"parts": []}, "the parts need fewer than 3 segments"),
        ({"parts": "none"}, "parts: Input should be a valid array"),
    ],
)
def test_faults_have_names(change: dict[str, Any], reason: str) -> None:
    instance, bound = conflicts_of("paper/figeasycell4.json")
    assert bound.certificate is not None
    claim = Bound("conflicts", bound.value, "surface", bound.certificate | change)
    assert reason in verdict(instance, claim).reason


def test_one_region_in_two_parts_is_refused() -> None:
    """The same cells twice would count the same segments twice."""
    instance, bound = conflicts_of("paper/figeasycell4.json")
    assert bound.certificate is not None
    twice = bound.certificate | {"parts": bound.certificate["parts"] * 2}
    claim = Bound("conflicts", 2 * bound.value, "surface", twice)
    assert verdict(instance, claim).reason == "one color region lies in two parts"


def test_a_conflict_of_cells_without_loops_is_refused() -> None:
    """Each is a closed surface by itself: no segment connects it with anything."""
    cells = tuple(Cell(number, own, ()) for number, own in enumerate([(0,), (1,), (0, 1)]))
    instance = Instance("no loops", ("a", "b"), cells, ())
    conflict = {"colors": [0, 1], "one": [[0], [0]], "other": [[1], [1]]}
    part = {"value": 4, "cells": [0, 1, 2], "conflicts": [conflict]}
    bound = Bound("conflicts", 4, "surface", {"parts": [part]})
    verdict = verify_bound(instance, bound, regions_of_cells(instance))
    assert (verdict.outcome, "need not cross" in verdict.reason) == ("refused", True)
