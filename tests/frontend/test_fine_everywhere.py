"""Fine at borders only is as good as fine everywhere."""

from __future__ import annotations

from dataclasses import replace

from relabelled import isomorphic
from shipped import shipped

from cellcolor.deadline import NEVER
from cellcolor.decomposition import decomposition_of
from cellcolor.frontend.build import result_of
from cellcolor.frontend.parts.surface import bisected
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.stage_clock import StageClock
from cellcolor.frontend.stages import judged, with_finer_borders
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

LONGEST = 0.012


def test_a_tenth_of_the_vertices_gives_the_same_minimum_and_graph() -> None:
    """The square, from one coarse mesh bisected at borders and everywhere."""
    plain = shipped("square", 60)
    keys = {"border_length_m": LONGEST}
    prepared = prepare(plain.varied(setup=plain.setup.varied(continuity=keys)))
    clock = StageClock(NEVER, None)
    sparse = result_of(*with_finer_borders(prepared, clock), clock).surface
    mesh = prepared.surface
    while (marked := mesh.lengths(mesh.edges()) > LONGEST).any():
        mesh = bisected(mesh, marked, "continuity.border_length_m")
    prepared = replace(prepared, surface=mesh)
    dense = result_of(prepared, judged(prepared, clock).stages, clock).surface
    assert len(dense.vertices) >= 10 * len(sparse.vertices)
    first, second = (decomposition_of(surface).instance for surface in (sparse, dense))
    assert len(first.cells) == 3  # some cells are covered by two configurations, some by one
    assert isomorphic(first, second)
    minima = [solve(instance, Options()) for instance in (first, second)]
    assert [m.segments for m in minima] == [m.lower_bound for m in minima] == [1, 1]
