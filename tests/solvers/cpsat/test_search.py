"""The search for the fewest segments of one part, stage by stage."""

from __future__ import annotations

from library import INSTANCES

from cellcolor.checker.division import check_division
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER
from cellcolor.decomposition import decompose
from cellcolor.lab.families.registry import MEDIUM
from cellcolor.solvers.bounds.reductions import drop_dominated, left_out
from cellcolor.solvers.cpsat.model.painting import division_of
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.solvers.cpsat.part_search import PartSearch
from cellcolor.solvers.cpsat.parts import split
from cellcolor.solvers.interface import Options


def test_what_segments_avoid_proves_the_last_one() -> None:
    """Where segments two and three at a time may pass through each other's cells, six are not ruled
    out. But one that touches the cell between two of another color cannot get out of there."""
    instance = decompose(MEDIUM["rim"](26))
    (part,) = split(instance, drop_dominated(instance, left_out(instance)))
    options = Options()
    search = PartSearch(part, options, Runner(options), lambda: None)
    search.cover(NEVER)
    search.planning.route(NEVER)
    search.drop(NEVER)
    assert (search.segments, search.surface_bound) == (7, 6)
    search.planning.avoid(NEVER)
    assert search.surface_bound == 7


def test_a_large_part_begins_with_local_search() -> None:
    """A large part is planned no further while its best division is far from the bound.

    Routes and windows came to 18 segments of this graph in minutes, 17 of the large part.
    """
    instance = Instance.read(INSTANCES / "hard" / "large_part_1.json")
    *_, part = split(instance, drop_dominated(instance, left_out(instance)))
    options = Options()
    search = PartSearch(part, options, Runner(options), lambda: None)
    assert search.large
    search.cover(NEVER)
    search.begin_large(NEVER)
    assert search.bound <= search.segments < 17
    graph, painting = search.best
    report = check_division(part.instance, division_of(graph, painting), seams=graph.seams)
    assert report.valid, report.problems
    assert report.segments == search.segments


def test_a_small_part_is_left_to_other_routes() -> None:
    instance = decompose(MEDIUM["rim"](26))
    (part,) = split(instance, drop_dominated(instance, left_out(instance)))
    options = Options()
    search = PartSearch(part, options, Runner(options), lambda: None)
    search.cover(NEVER)
    before = search.best
    search.begin_large(NEVER)
    search.recolor_large(NEVER)
    assert search.best is before and not search.done
