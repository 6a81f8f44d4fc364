"""The search for the fewest segments of one part, stage by stage."""

from __future__ import annotations

from cellcolor.deadline import NEVER
from cellcolor.decomposition import decompose
from cellcolor.lab.families.medium import rim
from cellcolor.solvers.bounds.domination import drop_dominated, left_out
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.solvers.cpsat.parts import split
from cellcolor.solvers.cpsat.search import PartSearch
from cellcolor.solvers.interface import Options


def test_what_segments_avoid_proves_the_last_one() -> None:
    """Where segments two and three at a time may pass through each other's cells, six are not ruled
    out. But one that touches the cell between two of another color cannot get out of there."""
    instance = decompose(rim(26))
    (part,) = split(instance, drop_dominated(instance, left_out(instance)))
    options = Options()
    search = PartSearch(part, options, Runner(options), lambda: None)
    search.cover(NEVER)
    search.planning.route(NEVER)
    search.improving.drop(NEVER)
    assert (search.segments, search.surface_bound) == (7, 6)
    search.planning.avoid(NEVER)
    assert search.surface_bound == 7
