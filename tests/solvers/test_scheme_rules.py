"""Both searches list just the schemes that the definition names (docs/semantics.md, section 3).

Each of the graphs below has other schemes for a search without one of the rules.
"""

from __future__ import annotations

import itertools
import random
from typing import Any

import exhaustive_minima
import holes
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from library import PAPER
from relabelled import turned
from rooms import BLUE, GREEN, RED, graph, petal_cells

from cellcolor.checker.division import check_scheme
from cellcolor.checker.scheme_rules import can_be_drawn
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, SchemeKey, number_segments, scheme_key
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs, planar_graph
from cellcolor.solvers.checked import enumerate_schemes, solve
from cellcolor.solvers.cpsat import CpSatSolver
from cellcolor.solvers.dfs import ReferenceSolver
from cellcolor.solvers.interface import Options
from examples import examples

BOTH = RED, BLUE
ALL = RED, BLUE, GREEN


def drawn(seed: int, self_edges: bool = False) -> Instance:
    return planar_graph(seed, 4 + seed % 3, 7, 3, self_edges=self_edges)


ONE_LOOP = {
    "crossing-zeros": Instance.read(PAPER / "crossing-zeros.json"),
    # The same, its list beginning between the two darts that may show either color.
    "crossing-zeros, turned": graph(
        (BOTH, (4, 5, 6, 1, 2, 3)),
        *(((RED,), (-3, -2)), ((BLUE,), (-5, -4)), ((RED,), (-1,)), ((BLUE,), (-6,))),
    ),
    "drawn 2": drawn(2),
    "drawn 4": drawn(4),
    "drawn 4, self-edges": drawn(4, self_edges=True),
    "drawn 6": drawn(6),
    # Two red sub-cells, the first and the last around a cell, are joined by way of another cell.
    "round the end": graph(
        (BOTH, (1, 2, 3, 4, 5, 6)),
        *(((RED,), (-1, -6)), ((RED,), (-2,)), ((BLUE,), (-3,)), ((BLUE,), (-4,))),
        ((RED,), (-5,)),
    ),
    # The same with blue around the end: red is taken up again after another red sub-cell.
    "inside": graph(
        (BOTH, (1, 2, 3, 4, 5, 6)),
        *(((RED,), (-1, -4)), ((BLUE,), (-2,)), ((BLUE,), (-3,)), ((RED,), (-5,)), ((RED,), (-6,))),
    ),
    # A crack that ends in the cell, for red only.
    "crack": graph(
        (BOTH, (1, 2, 6, -6, 3, 4)), *petal_cells(RED, BLUE, RED, BLUE), cracks={6: (BLUE,)}
    ),
    # A crack for blue around a red cell.
    "crack around": graph(
        (BOTH, (1, 6, 2, -6, 3, 4, 5)), *petal_cells(RED, RED, BLUE, BLUE, RED), cracks={6: (RED,)}
    ),
}
HOLES = {
    "two and two": holes.holed(0, 4, 2, 2),
    "two and two, in turn": holes.holed(4, 4, 2, 2),
    "on two loops": holes.holed(25, 5, 2, 3),
    "on three loops": holes.holed(0, 5, 3, 2),
    "a loop in either": holes.holed(20, 5, 3, 2),
    "annulus": Instance.read(PAPER / "annulus.json"),
    "crack": graph(
        (BOTH, (1, 2, 5, -5), (3, 4)), *petal_cells(RED, BLUE, RED, BLUE), cracks={5: (BLUE,)}
    ),
    # Three bands from loop to loop would cross: not all colors can be connected.
    "bands": graph(
        (ALL, (1, 2, 3, 4), (5, 6, 7)), *petal_cells(BLUE, GREEN, GREEN, RED, GREEN, RED, BLUE)
    ),
    # Darts 3 and 4 need not be joined. Then 3, the last of a loop, shows red, and 4, the first of
    # the other, blue.
    "last and first": graph(
        (BOTH, (1, 2, 3), (4, 5, 6)),
        *(((RED,), (-1,)), ((BLUE,), (-2, -3)), ((RED,), (-4, -5)), ((BLUE,), (-6,))),
    ),
}


def listed(solver: CpSatSolver | ReferenceSolver, instance: Instance, segments: int) -> list[Any]:
    return [scheme_key(d) for d in solver.optimal_schemes(instance, Options(), segments)]


@pytest.mark.parametrize("name", ONE_LOOP)
@pytest.mark.parametrize("solver", [CpSatSolver(), ReferenceSolver()])
def test_the_schemes_of_the_definition(solver: CpSatSolver | ReferenceSolver, name: str) -> None:
    segments, schemes = exhaustive_minima.optimal_schemes(ONE_LOOP[name])
    found = listed(solver, ONE_LOOP[name], segments)
    assert len(found) == len(schemes) and set(found) == schemes


@pytest.mark.parametrize("name", HOLES)
def test_the_schemes_of_the_definition_with_holes(name: str) -> None:
    segments, schemes = holes.optimal_schemes(HOLES[name])
    found = listed(CpSatSolver(), HOLES[name], segments)
    assert len(found) == len(schemes) and set(found) == schemes


SEEDS = st.integers(0, 10**6)


def schemes_of(instance: Instance) -> set[SchemeKey]:
    """All that there are, each seen by the checker and none twice."""
    options = Options(workers=2)
    segments = solve(instance, options).segments
    assert segments is not None
    found = [scheme_key(d) for d in enumerate_schemes(instance, options, "cp-sat", segments)]
    assert len(set(found)) == len(found)
    return set(found)


@examples(12)
@given(seed=SEEDS, darts=st.integers(3, 6), loops=st.integers(2, 3), colors=st.integers(2, 3))
def test_against_every_division(seed: int, darts: int, loops: int, colors: int) -> None:
    instance = holes.holed(seed, darts, loops, colors)
    _, expected = holes.optimal_schemes(instance)
    assert schemes_of(instance) == expected


@examples(6)
@given(seed=SEEDS, islands=st.integers(1, 2))
def test_however_loops_are_turned(seed: int, islands: int) -> None:
    """The very same schemes, not only as many: there are no seams in them."""
    surface = blobs(seed, size=8, colors=2, coverage=(0.8, 1.0), rim=2, islands=islands)
    instance = decompose(surface)
    assume(1 < len(instance.cells) < 9)
    assert schemes_of(turned(instance, random.Random(seed))) == schemes_of(instance)


@examples(40)
@given(
    labels=st.lists(st.integers(0, 3), min_size=2, max_size=7),
    places=st.lists(st.integers(0, 2), min_size=7, max_size=7),
)
def test_what_can_be_drawn(labels: list[int], places: list[int]) -> None:
    """The checker cuts cells open, the brute force looks for an embedding of genus 0."""
    loops: list[list[int]] = [[], [], []]
    for dart, place in zip(range(len(labels)), places, strict=False):
        loops[place].append(dart)
    blocks = frozenset(
        frozenset(dart for dart, label in enumerate(labels) if label == own) for own in set(labels)
    )
    assume(max(map(len, blocks)) < 6)
    expected = holes.can_be_drawn(tuple(map(tuple, loops)), blocks)
    assert can_be_drawn([[labels[dart] for dart in loop] for loop in loops]) == expected


def divided(instance: Instance, *blocks: list[int]) -> Division:
    """The first cell in blocks, each in the color of its darts' other sides."""
    color = {cell.id: cell.colors[0] for cell in instance.cells}
    joined = set(itertools.chain(*blocks))
    return number_segments(
        [
            [(color[block[0]], tuple(block)) for block in blocks],
            *(
                [(color[dart], (-dart,) if dart in joined else ())]
                for dart in range(1, len(instance.cells))
            ),
        ]
    )


@pytest.mark.parametrize(
    ("loops", "colors", "blocks", "reason"),
    [
        # Two bands from loop to loop, and what is between them: all in turn.
        ([[1, 2], [3, 4]], [RED, BLUE, RED, BLUE], [[1, 3], [2, 4]], None),
        # A closed curve between a red loop and a blue one, and between two red ones.
        ([[1, 2], [3, 4]], [RED, RED, BLUE, BLUE], [[1, 2], [3, 4]], None),
        ([[1, 2], [3, 4]], [RED] * 4, [[1, 2], [3, 4]], "no chain of loops connects them"),
        # From loop to loop bands keep their order: loops run in opposite senses round them.
        (
            [[1, 2, 3, 4], [5, 6, 7, 8]],
            [RED, BLUE] * 4,
            [[1, 5], [2, 6], [3, 7], [4, 8]],
            "cannot be drawn without crossing each other",
        ),
    ],
)
def test_what_is_a_scheme(
    loops: list[list[int]], colors: list[int], blocks: list[list[int]], reason: str | None
) -> None:
    instance = graph(((RED, BLUE), *loops), *petal_cells(*colors))
    report = check_scheme(instance, divided(instance, *blocks))
    assert report.is_scheme == (reason is None)
    assert reason is None or reason in (*report.problems, *report.not_canonical)[0]
