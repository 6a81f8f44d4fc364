"""The minimum does not depend on names, starting darts, the order of loops, seams or mirrors."""

from __future__ import annotations

import random

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from library import PAPER
from relabelled import mirrored, renamed, turned
from rooms import graph, petal_cells

from cellcolor.checker.division import check_division
from cellcolor.data.instance import Instance
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options
from examples import examples

SEEDS = st.integers(0, 10**6)


def minimum_of(instance: Instance, strands: int) -> int:
    """The minimum with so many strands an edge, its division seen by the checker."""
    space = "paper" if strands == 1 else "surface"
    found = solve(instance, Options(search_space=space, strands=strands))
    assert found.cells is not None
    assert check_division(instance, found.cells, found.seams, strands).valid
    assert found.lower_bound == found.segments or strands > 1
    return len({sub.segment for cell in found.cells for sub in cell.subcells})


def same_minimum(instance: Instance, seed: int, strands: int = 1) -> None:
    rng = random.Random(seed)
    expected = minimum_of(instance, strands)
    assert minimum_of(turned(instance, rng), strands) == expected
    assert minimum_of(renamed(instance, rng), strands) == expected
    assert minimum_of(mirrored(instance), strands) == expected


@pytest.mark.parametrize("name", ["annulus", pytest.param("three-loops", marks=pytest.mark.slow)])
@examples(4)
@given(seed=SEEDS)
def test_cells_with_several_loops(name: str, seed: int) -> None:
    same_minimum(Instance.read(PAPER / f"{name}.json"), seed)


@examples(12)
@given(seed=SEEDS, islands=st.integers(0, 2), cracks=st.integers(0, 2), strands=st.integers(1, 2))
def test_random_surfaces(seed: int, islands: int, cracks: int, strands: int) -> None:
    """Islands make cells with several loops, cracks cells that touch themselves."""
    surface = blobs(
        seed, size=8, colors=2, coverage=(0.8, 1.0), rim=3, islands=islands, cracks=cracks
    )
    instance = decompose(surface)
    assume(1 < len(instance.cells) < 12)
    same_minimum(instance, seed, strands)


@examples(10)
@given(seed=SEEDS)
def test_a_closed_surface_with_several_loops(seed: int) -> None:
    """A sphere: one cell of two colors around patches, each patch a loop of its own."""
    rng = random.Random(seed)
    patches = [rng.randrange(2) for _ in range(rng.randint(1, 4))]
    loops = ((edge,) for edge in range(1, len(patches) + 1))
    instance = graph(((0, 1), *loops), *petal_cells(*patches))
    # Discs in a sphere do not hinder each other: every color's patches can be joined.
    assert minimum_of(instance, 1) == len(set(patches))
    same_minimum(instance, seed)
