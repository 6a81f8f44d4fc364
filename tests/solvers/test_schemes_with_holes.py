"""All optimal schemes of cells with several loops, which know no seams."""

from __future__ import annotations

import itertools
import random
from pathlib import Path

import holes
import pytest
from commands import run
from hypothesis import assume, given
from hypothesis import strategies as st
from library import PAPER
from relabelled import turned
from rooms import graph, petal_cells

from cellcolor.checker.division import check_scheme
from cellcolor.checker.scheme_rules import can_be_drawn
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, SchemeKey, number_segments, scheme_key
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs
from cellcolor.solvers.checked import enumerate_schemes, solve
from cellcolor.solvers.interface import Options
from examples import examples

SEEDS = st.integers(0, 10**6)
RED, BLUE = 0, 1


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


def test_the_annulus() -> None:
    """Why it has three segments says its ``meta``."""
    instance = Instance.read(PAPER / "annulus.json")
    segments, expected = holes.optimal_schemes(instance)
    assert (segments, len(expected)) == (3, 3)
    assert schemes_of(instance) == expected


@examples(6)
@given(seed=SEEDS, islands=st.integers(1, 2))
def test_however_loops_are_turned(seed: int, islands: int) -> None:
    """The very same schemes, not only as many: there are no seams in them."""
    surface = blobs(seed, size=8, colors=2, coverage=(0.8, 1.0), rim=2, islands=islands)
    instance = decompose(surface)
    assume(1 < len(instance.cells) < 9)
    assert schemes_of(turned(instance, random.Random(seed))) == schemes_of(instance)


def test_from_the_command_line(tmp_path: Path) -> None:
    """Schemes are written without seams, and ``check`` reads them so."""
    target = tmp_path / "annulus.jsonl"
    assert run("solve", PAPER / "annulus.json", "--all", "-o", target) == 0
    assert len(target.read_text().splitlines()) == 1 + 3
    assert run("check", PAPER / "annulus.json", target) == 0


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


def around(loops: list[list[int]], colors: list[int]) -> Instance:
    """A red and blue cell with a cell of one color across each of its darts 1, 2, …"""
    return graph(((RED, BLUE), *loops), *petal_cells(*colors))


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
        ([[1, 2, 3], [4]], [RED] * 4, [[1, 2], [3, 4]], "separates equal colors"),
        ([[1, 2], [3]], [RED, RED, BLUE], [[1, 2], [3]], "fewer than two darts in state 1"),
    ],
)
def test_what_is_a_scheme(
    loops: list[list[int]], colors: list[int], blocks: list[list[int]], reason: str | None
) -> None:
    instance = around(loops, colors)
    report = check_scheme(instance, divided(instance, *blocks))
    assert report.valid, report.problems
    assert report.is_scheme == (reason is None)
    assert reason is None or reason in report.not_canonical[0]


def test_three_bands_in_the_wrong_order_cannot_be_drawn() -> None:
    """From loop to loop bands keep their order: loops run in opposite senses round them."""
    colors = [RED, BLUE, RED, BLUE, RED, BLUE, RED, BLUE]
    for far, drawn in (([8, 7, 6, 5], True), ([6, 5, 8, 7], True), ([5, 6, 7, 8], False)):
        instance = around([[1, 2, 3, 4], far], colors)
        report = check_scheme(instance, divided(instance, [1, 5], [2, 6], [3, 7], [4, 8]))
        assert report.valid == drawn, far
        if not drawn:
            assert report.problems == (
                "cells[0].subcells: cannot be drawn without crossing each other",
            )
