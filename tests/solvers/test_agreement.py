"""The solvers agree on instances of every small family: minima, sets of schemes, vertex colorings.

Hypothesis draws the instances. The solvers share only their interface; the checker counts the
segments of every division; a search over the colorings of a mesh's vertices never sees the graph.
"""

from __future__ import annotations

from itertools import islice

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from vertex_minima import vertex_minimum

from cellcolor.data.instance import Instance
from cellcolor.data.solution import SchemeKey, scheme_key
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose
from cellcolor.lab.families import SMALL
from cellcolor.solvers.checked import enumerate_schemes, solve
from cellcolor.solvers.interface import Options
from examples import examples

pytestmark = pytest.mark.second

NAMES = ("cp-sat", "dfs", "cp-sat-model")
SEEDS = st.integers(0, 2**31 - 1)
ON_MESHES = [name for name, family in SMALL.items() if isinstance(family(0), LabelledSurface)]

MOST_SCHEMES = 3000
MOST_STATES = 6000
"""Sets of schemes, and partial colorings of a mesh, that are larger are not compared."""


def options(strands: int = 1) -> Options:
    space = "paper" if strands == 1 else "surface"
    return Options(space, strands, Deadline.after(60.0), workers=1)


def schemes_of(instance: Instance, solver: str, segments: int) -> set[SchemeKey]:
    """All optimal schemes that a solver lists, each once, if they are not too many."""
    listed = enumerate_schemes(instance, options(), solver, segments)
    found = [scheme_key(division) for division in islice(listed, MOST_SCHEMES + 1)]
    assert len(set(found)) == len(found), f"{solver} lists a scheme twice"
    assume(len(found) <= MOST_SCHEMES)
    return set(found)


@pytest.mark.parametrize("family", SMALL)
@examples(12)
@given(seed=SEEDS)
def test_minima_and_schemes(family: str, seed: int) -> None:
    made = SMALL[family](seed)
    instance = made if isinstance(made, Instance) else decompose(made)
    solutions = [solve(instance, options(), name) for name in NAMES]
    assert {solution.status for solution in solutions} == {"optimal"}
    (segments,) = {solution.segments for solution in solutions}
    assert segments is not None
    if instance.most_live_loops < 2:
        first, second = (schemes_of(instance, name, segments) for name in NAMES[:2])
        assert first == second


@pytest.mark.parametrize("family", ON_MESHES)
@examples(12)
@given(seed=SEEDS)
def test_no_vertex_coloring_beats_the_surface(family: str, seed: int) -> None:
    """A coloring of the vertices is a division of the surface.

    So it has no fewer segments than a bound for the surface says, nor than the best division. It
    may need several corridors across an edge.
    """
    surface = SMALL[family](seed)
    assert isinstance(surface, LabelledSurface)
    instance = decompose(surface)
    assume(len(instance.cells) > 0)
    by_vertices = vertex_minimum(surface, MOST_STATES)
    assume(by_vertices is not None)
    for strands in (2, 4):
        found = solve(instance, options(strands))
        assert found.segments is not None and found.surface_lower_bound <= by_vertices
        if found.segments <= by_vertices:
            return
    raise AssertionError(f"{by_vertices} segments by vertices, {found.segments} in any division")
