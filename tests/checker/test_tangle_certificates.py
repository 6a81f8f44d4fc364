"""Tangles in certificates: held against paths and colorings on meshes, and one thing changed."""

from __future__ import annotations

import itertools
import json
from typing import Any

import pytest
from hypothesis import assume, given, reject
from hypothesis import strategies as st
from rooms import (
    BLUE,
    GREEN,
    ISLAND_BETWEEN,
    RED,
    ROUND_A_PETAL,
    can_be_drawn,
    crossed_rings,
    room,
    rooms,
)
from vertex_minima import vertex_minimum

import cellcolor
from cellcolor.checker.certificates import BoundVerdict, verify_bound
from cellcolor.checker.color_regions import regions_of_cells
from cellcolor.checker.crossing_segments import TwoRegions
from cellcolor.checker.tangles import Tangled, cannot_be_drawn, is_connected
from cellcolor.data.bounds import Bound
from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose, decomposition_of
from cellcolor.errors import InputError
from cellcolor.lab.families import LARGE, MEDIUM
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.bounds.merged_surface import merge_cells
from cellcolor.solvers.bounds.tangles import Tangles, Touching
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options
from examples import examples

Segment = dict[str, Any]


def segment(color: int, *groups: list[list[int]], avoided: tuple[int, ...] = ()) -> Segment:
    return {"color": color, "groups": list(groups), "avoided": list(avoided)}


def claim(value: int, cells: list[int], tangles: list[list[Segment]], **part: object) -> Bound:
    tangled = [{"segments": segments} for segments in tangles]
    whole = {"value": value, "cells": cells, "tangles": tangled} | part
    return Bound("conflicts", value, "surface", json.loads(json.dumps({"parts": [whole]})))


def verdict(instance: Instance, bound: Bound) -> BoundVerdict:
    return verify_bound(instance, bound, regions_of_cells(instance))


def uncounted(_: int) -> None:
    """However much work it is."""


# Petals 1 and 3 are red, 2 and 5 blue, 4 and 6 green; 5 and 6 are on the island.
THREE = [
    segment(RED, [[1]], [[3]]),
    segment(BLUE, [[2]], [[5]]),
    segment(GREEN, [[4]], [[6]]),
]
PETALS = [1, 2, 3, 4, 5, 6]


def test_three_segments_that_fit_two_at_a_time() -> None:
    assert verdict(ISLAND_BETWEEN, claim(4, PETALS, [THREE])).outcome == "verified"
    assert verdict(ISLAND_BETWEEN, claim(4, PETALS, [])).outcome == "refused"
    assert verdict(ISLAND_BETWEEN, claim(5, PETALS, [THREE])).outcome == "refused"
    for left_out in range(3):
        two = [own for number, own in enumerate(THREE) if number != left_out]
        said = verdict(ISLAND_BETWEEN, claim(4, PETALS, [two]))
        assert (said.outcome, "could be drawn" in said.reason) == ("refused", True)


def in_turn(petals: Instance) -> list[list[Segment]]:
    """Each two pairs of petals that follow in turn around the hub: neither segment passes the
    petals of the other, if it touches none of them."""
    found = []
    for one, other in itertools.permutations(range(len(petals.colors)), 2):
        own, its = ([c.id for c in petals.cells[1:] if x in c.colors] for x in (one, other))
        for near, far in itertools.product(*(itertools.combinations(c, 2) for c in (own, its))):
            if near[0] < far[0] < near[1] < far[1]:
                two = segment(one, *([[c]] for c in near), avoided=tuple({*far} & {*own}))
                two_others = segment(other, *([[c]] for c in far), avoided=tuple({*near} & {*its}))
                found.append([two, two_others])
    return found


def test_what_a_segment_avoids_it_may_touch_after_all() -> None:
    """Red, from petal 2 to 4, goes round 6, or parts blue, from 3 to 6. If it goes round, it
    touches 6 and parts the green petals 1 and 5."""
    every = in_turn(ROUND_A_PETAL)
    assert verdict(ROUND_A_PETAL, claim(4, PETALS, every)).outcome == "verified"
    assert verdict(ROUND_A_PETAL, claim(5, PETALS, every)).outcome == "refused"
    never = [two for two in every if not any(own["avoided"] for own in two)]
    said = verdict(ROUND_A_PETAL, claim(4, PETALS, never))
    assert (said.outcome, said.reason[:24]) == ("refused", "fewer than 4 segments to")


@pytest.mark.parametrize("avoided", [(), (1,), (3,), (5,)])
def test_cells_that_have_to_be_avoided(avoided: tuple[int, ...]) -> None:
    """Red passes petal 6, which it does not say that it avoids; 1, 3 and 5 it never touches."""
    two = [segment(BLUE, [[3]], [[6]]), segment(RED, [[2]], [[4]], avoided=avoided)]
    assert verdict(ROUND_A_PETAL, claim(0, [], [two])).outcome == "refused"
    two = [segment(BLUE, [[3]], [[6]]), segment(RED, [[2]], [[4]], avoided=(6,))]
    assert verdict(ROUND_A_PETAL, claim(0, [], [two])).outcome == "verified"


def test_a_segment_does_not_pass_what_it_avoids() -> None:
    """A tangle of one: true, and it proves nothing, since the segment may touch the cell."""
    alone = [segment(RED, [[2]], [[4]], avoided=(0,))]
    assert verdict(ROUND_A_PETAL, claim(2, PETALS, [alone])).outcome == "verified"
    assert verdict(ROUND_A_PETAL, claim(3, PETALS, [alone])).outcome == "refused"


def with_handle(outer: tuple[int, ...], inner: tuple[int, ...]) -> Instance:
    """The room with the island, and a handle that leads from its border to a hole in it."""
    return Instance(
        "handle",
        ISLAND_BETWEEN.colors,
        (Cell(0, (RED, BLUE, GREEN), (outer, inner, (-7,))), *ISLAND_BETWEEN.cells[1:]),
        (*ISLAND_BETWEEN.edges, Edge(7, 0, 0)),
    )


def test_a_handle_leads_past() -> None:
    outer, inner = ISLAND_BETWEEN.cells[0].loops
    for instance in (with_handle((*outer, 7), inner), with_handle(outer, (*inner, 7))):
        said = verdict(instance, claim(4, PETALS, [THREE]))
        assert (said.outcome, "could be drawn" in said.reason) == ("refused", True)


@pytest.mark.parametrize(
    ("segments", "reason"),
    [
        ([], "could be drawn"),
        ([segment(RED)], "names no cells"),
        ([segment(RED, [])], "names no cells"),
        ([segment(RED, [[]])], "names no cells"),
        ([segment(RED, [[1], []])], "names no cells"),
        ([segment(BLUE, [[1]], [[3]])], "color 1 is not available in cell 1"),
        ([segment(7, [[1]])], "color 7 is not available in cell 1"),
        ([segment(RED, [[1]], [[2]])], "cell 2 is not in the color region of cell 1"),
        ([segment(RED, [[1]], [[3]], avoided=(2,))], "cell 2 is not in the color region"),
        ([segment(RED, [[1]], [[3]], avoided=(3,))], "avoids what it touches"),
        ([segment(RED, [[1, 3]])], "not connected in color 0"),
        ([segment(RED, [[70]])], "there is no cell 70"),
        ([segment(RED, [[-1]])], "there is no cell -1"),
        ([segment(RED, [[1]], [[1]], [[3]]), segment(RED, [[1]], [[3]])], "could be drawn"),
        ([{"color": RED, "groups": [[["1"]]]}], "groups[0][0][0]"),
        ([{"color": RED}], "groups"),
    ],
)
def test_faults_have_names(segments: list[Segment], reason: str) -> None:
    said = verdict(ISLAND_BETWEEN, claim(4, PETALS, [THREE, segments]))
    assert said.outcome == "refused" and reason in said.reason


def test_a_part_with_hubs_has_no_tangles() -> None:
    said = verdict(ISLAND_BETWEEN, claim(4, PETALS, [THREE], hubs=[0]))
    assert (said.outcome, "tangles" in said.reason) == ("refused", True)


def test_cells_without_loops() -> None:
    cells = tuple(Cell(number, own, ()) for number, own in enumerate([(0,), (1,), (0, 1)]))
    instance = Instance("no loops", ("a", "b"), cells, ())
    two = [segment(0, [[0]], [[0]]), segment(1, [[1]], [[1]])]
    assert "could be drawn" in verdict(instance, claim(4, [0, 1, 2], [two])).reason


def test_more_choices_than_the_budget() -> None:
    """Thirty groups of two areas each are 2^30 choices."""
    instance = room((RED, RED, BLUE, BLUE))
    many = [segment(RED, *([[[1], [2]]] * 30)), segment(BLUE, [[3]], [[4]])]
    bound = claim(3, [1, 2, 3, 4], [many])
    said = verify_bound(instance, bound, regions_of_cells(instance), 1_000)
    assert said.outcome in ("budget exceeded", "refused") and said.tried <= 1_100
    never = [segment(RED, [[1]], [[2]], avoided=(0,)), segment(RED, *([[[1], [2]]] * 30))]
    bound = claim(3, [1, 2, 3, 4], [never])
    said = verify_bound(instance, bound, regions_of_cells(instance), 1_000)
    assert (said.outcome, said.tried <= 1_100) == ("budget exceeded", True)
    said = verify_bound(instance, bound, regions_of_cells(instance), deadline=Deadline.after(0))
    assert said.outcome == "budget exceeded"


def tangled(draw: st.DrawFn, instance: Instance) -> list[tuple[Tangled, list[int]]]:
    """Two or three made-up segments, with areas of a cell or two, and what they avoid."""
    found = []
    regions = color_regions(instance)
    for _ in range(draw(st.integers(2, 3))):
        color, cells = draw(st.sampled_from(regions))
        small = sorted(cell for cell in cells if len(instance.cells[cell].colors) < 3)
        assume(len(small) > 1)
        groups = []
        for start in draw(st.lists(st.sampled_from(small), min_size=2, max_size=2, unique=True)):
            area = frozenset({start, draw(st.sampled_from(sorted(cells)))})
            fits = not any(area & g for g in groups) and is_connected(instance, color, area)
            groups.append(area if fits else frozenset({start}))
        left = sorted(cells - groups[0] - groups[1])
        avoided = draw(st.lists(st.sampled_from(left), max_size=2)) if left else []
        found.append(
            (Tangled(color, frozenset(cells) - set(avoided), tuple((g,) for g in groups)), avoided)
        )
    return found


def passes(mesh: LabelledSurface, segments: list[tuple[Tangled, list[int]]]) -> bool:
    """Whether such segments can be drawn as paths over mesh vertices."""
    cell_of = decomposition_of(mesh, None).vertex_cell

    def vertices(cells: Any) -> set[int]:
        return {v for v, own in enumerate(cell_of) if own in cells}

    return can_be_drawn(
        mesh,
        [
            (own.color, [vertices(area) for (area,) in own.groups], vertices(avoided))
            for own, avoided in segments
        ],
    )


@examples(40)
@given(mesh=rooms(6, 7), data=st.data())
def test_what_is_said_to_be_tangled_cannot_be_drawn(
    mesh: LabelledSurface, data: st.DataObject
) -> None:
    """Against all paths over mesh vertices, without cells, edges or parities."""
    instance = decompose(mesh)
    segments = data.draw(st.composite(tangled)(instance))
    if cannot_be_drawn(instance, [own for own, _ in segments], uncounted):
        assert not passes(mesh, segments)


@examples(30)
@given(mesh=crossed_rings(), data=st.data())
def test_what_must_cross_cannot_pass_around_a_handle(
    mesh: LabelledSurface, data: st.DataObject
) -> None:
    """Conflicts and tangles on a torus, against all paths over mesh vertices."""
    try:
        instance = decompose(mesh)
    except InputError:
        reject()
    regions = {color: [r for r in color_regions(instance) if r[0] == color] for color in range(3)}
    one, other = (
        (data.draw(st.sampled_from(regions[color])) for color in (RED, BLUE))
        if (regions[RED] and regions[BLUE])
        else reject()
    )
    two = TwoRegions(
        instance, (RED, BLUE), (frozenset(one[1]), frozenset(other[1])), lambda _: None
    )
    first, second = sorted(one[1] - other[1]), sorted(other[1] - one[1])
    assume(len(first) > 1 and len(second) > 1)
    for _ in range(6):
        pairs = [
            tuple(data.draw(st.lists(st.sampled_from(c), min_size=2, max_size=2, unique=True)))
            for c in (first, second)
        ]
        segments = [
            (Tangled(color, frozenset(cells), tuple((frozenset({c}),) for c in pair)), [])
            for color, (_, cells), pair in zip((RED, BLUE), (one, other), pairs, strict=True)
        ]
        must = two.must_cross(*pairs) or cannot_be_drawn(
            instance, [own for own, _ in segments], uncounted
        )
        assert not (must and passes(mesh, segments))


@examples(20)
@given(mesh=rooms(6, 7), data=st.data())
def test_every_tangle_of_the_solver_is_accepted(mesh: LabelledSurface, data: st.DataObject) -> None:
    """Segments that touch and avoid what is drawn; what the planner finds of them is verified."""
    instance = decompose(mesh)
    regions = color_regions(instance)
    merged = merge_cells(instance, {c.id: frozenset(c.colors) for c in instance.cells})
    cells_of = merged.cells()
    plan = []
    for number, (_, cells) in enumerate(regions):
        own = sorted({merged.merged_cell_of[c] for c in cells})
        touched = data.draw(st.sets(st.sampled_from(own), min_size=1, max_size=4))
        avoided = data.draw(st.sets(st.sampled_from(own), max_size=3)) - touched
        plan.append(Touching(number, tuple(sorted(touched)), frozenset(avoided)))
    for tangle in Tangles(merged, regions).find(plan, Deadline.after(60)):
        segments = [
            segment(
                regions[own.region][0],
                *([sorted(cells_of[m]) for m in sorted(group)] for group in own.groups),
                avoided=tuple(c for m in sorted(own.avoided) for c in sorted(cells_of[m])),
            )
            for own in tangle.segments
        ]
        assert verdict(instance, claim(0, [], [segments])).outcome == "verified"


@examples(20)
@given(mesh=st.one_of(rooms(6, 7), crossed_rings()))
def test_a_verified_bound_holds_on_the_mesh(mesh: LabelledSurface) -> None:
    """Against a sweep over vertex colorings, which knows no cells; nothing is taken on trust."""
    try:
        instance = decompose(mesh)
    except InputError:
        reject()
    found = solve(instance, Options())
    minimum = vertex_minimum(mesh)
    for bound in found.bounds or ():
        if bound.kind in ("cover", "conflicts", "hubs"):
            assert verdict(instance, bound).outcome == "verified" and bound.value <= minimum
            more = Bound("conflicts", minimum + 1, "surface", bound.certificate)
            assert verdict(instance, more).outcome == "refused"


def certified(instance: Instance) -> tuple[Bound, int | None]:
    solution = solve(instance, Options(deadline=Deadline.after(120)))
    return next(b for b in solution.bounds or () if b.kind == "conflicts"), solution.segments


def test_conflicts_around_handles_are_verified() -> None:
    instance = LARGE["torus"](10)
    assert isinstance(instance, LabelledSurface)
    graph = cellcolor.decompose(instance)
    bound, segments = certified(graph)
    assert (bound.value, verdict(graph, bound).outcome) == (segments, "verified")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("family", "seed"), [("rim", 26), ("thin", 40), ("64 × 64 points, 10 colors", 48)]
)
def test_minima_by_cells_that_are_avoided_are_verified(family: str, seed: int) -> None:
    made = MEDIUM[family](seed)
    instance = made if isinstance(made, Instance) else decompose(made)
    bound, segments = certified(instance)
    assert (bound.value, verdict(instance, bound).outcome) == (segments, "verified")
    assert bound.certificate is not None
    tangles = [tangle for part in bound.certificate["parts"] for tangle in part["tangles"]]
    assert any(own["avoided"] for tangle in tangles for own in tangle["segments"])
