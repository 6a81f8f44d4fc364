"""Segments that cost more in one color than in another, against brute force and by hand."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest
from exhaustive_minima import literal_minimum
from hypothesis import assume, given
from hypothesis import strategies as st
from library import INSTANCES, PAPER
from ortools.sat.python import cp_model
from vertex_minima import vertex_minimum

from cellcolor.checker.certificates import verify_bound
from cellcolor.checker.claimed_numbers import claims, segments_of_whole_cells
from cellcolor.checker.color_regions import regions_of_cells
from cellcolor.checker.division import check_solution
from cellcolor.data.bound_kinds import CertifiedPart, CertifiedParts
from cellcolor.data.bounds import Bound
from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.objective import Objective
from cellcolor.data.solution import Solution
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from cellcolor.lab.families import blobs, planar_graph
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.checked import enumerate_schemes, solve
from cellcolor.solvers.cpsat.model.dart_graph import dart_graph
from cellcolor.solvers.cpsat.model.full import full_model, read_painting
from cellcolor.solvers.cpsat.model.painting import counted
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.solvers.cpsat.routes.segment_plans import Planner
from cellcolor.solvers.interface import Options, Start
from examples import examples

BOUNDING = ("cp-sat", "dfs-cover", "cp-sat-model")
"""Those that know a bound of the cost for any division."""
ABLE = (*BOUNDING, "dfs")
SEEDS = st.integers(0, 10**6)
COSTS = st.lists(st.integers(1, 9), min_size=4, max_size=4)

TWO = Instance(
    "two",
    ("red", "green", "blue"),
    (Cell(0, (0, 1), ((1, 2),)), Cell(1, (0, 2), ((-1, 3),))),
    (Edge(1, 0, 1, (0,)), Edge(2, 0, OUTSIDE, ()), Edge(3, 1, OUTSIDE, ())),
)
"""Red leads from one cell to the other; each has another color as well."""


def weighed(instance: Instance, costs: list[int]) -> tuple[Options, tuple[int, ...]]:
    """Options with a cost for each color, and these costs; not all of them 1."""
    objective = Objective(dict(zip(instance.colors, costs, strict=False)))
    assume(not objective.is_default)
    return Options(objective=objective, workers=1), objective.by_color(instance.colors)


@pytest.mark.parametrize("name", BOUNDING)
@pytest.mark.parametrize(
    ("costs", "segments", "cost"),
    [
        ({"green": 5}, 1, 1),  # red alone
        ({"red": 2, "green": 2}, 1, 2),  # cheaper than the 3 of green and blue
        ({"red": 3}, 2, 2),  # green and blue
        ({"red": 9, "green": 4, "blue": 4}, 2, 8),
    ],
)
def test_two_cells_by_hand(name: str, costs: dict[str, int], segments: int, cost: int) -> None:
    solution = solve(TWO, Options(objective=Objective(costs)), name)
    assert (solution.segments, solution.cost, solution.status) == (segments, cost, "optimal")
    assert solution.cost_surface_lower_bound == cost
    (bound,) = (bound for bound in solution.bounds or () if bound.of == "cost")
    assert (bound.kind, bound.value, bound.certificate is not None) == ("cover", cost, True)
    report = check_solution(TWO, solution)
    assert report.valid and {verdict.outcome for verdict in report.bounds} == {"verified"}
    assert claims(TWO, solution, report.bounds) == {}


def test_a_cheap_color_does_not_give_way_to_a_dear_one() -> None:
    """Red could stand in for blue, which it does as long as it does not cost more."""
    pair = replace(TWO, cells=(Cell(0, (0, 2), ((1, 2),)), Cell(1, (0,), ((-1, 3),))))
    assert solve(pair, Options()).segments == 1
    single = replace(TWO, cells=(Cell(0, (0, 2), ()),), edges=())
    for name in ABLE:
        assert solve(single, Options(objective=Objective({"red": 5})), name).cost == 1


def test_crossing_segments_by_hand() -> None:
    """Red, blue, red, blue around a cell of both: one color leads through, the other is cut in two.

    Red costs 2 and blue 3, so blue leads through, for 3 + 2 + 2, and a color cover costs 2 + 3.
    """
    instance = Instance.read(PAPER / "figeasycell4.json")
    options = Options(objective=Objective({"red": 2, "blue": 3}))
    solution = solve(instance, options)
    assert (solution.segments, solution.cost) == (3, 7)
    cover, conflicts = (bound for bound in solution.bounds or () if bound.of == "cost")
    assert [(cover.kind, cover.value), (conflicts.kind, conflicts.value)] == [
        ("cover", 5),
        ("conflicts", 7),
    ]
    assert {verdict.outcome for verdict in check_solution(instance, solution).bounds} == {
        "verified"
    }
    regions = regions_of_cells(instance)
    part = CertifiedPart(8, (1, 2, 3, 4))
    for certificate, reason in (
        (conflicts.certificate, "the parts need fewer than 8 segments"),
        (CertifiedParts(parts=(part,)).to_document(), "color regions that cost less than 8 touch"),
    ):
        more = replace(conflicts, value=8, certificate=certificate)
        verdict = verify_bound(instance, more, regions, costs=(2, 3))
        assert (verdict.outcome, reason in verdict.reason) == ("refused", True)


def test_a_dear_color_stands_in_for_none() -> None:
    """What a certificate leaves out has to have a stand-in that does not cost more."""
    single = replace(TWO, cells=(Cell(0, (0, 2), ()),), edges=())
    parts = CertifiedParts(left_out=((2, 0, 0),), parts=(CertifiedPart(5, (0,)),))
    bound = Bound("conflicts", 5, "surface", parts.to_document(), "cost")
    regions = regions_of_cells(single)
    verdict = verify_bound(single, bound, regions, costs=(5, 1, 1))
    assert (verdict.outcome, verdict.reason) == ("refused", "color 0 costs more than color 2")
    assert verify_bound(single, bound, regions, costs=(5, 1, 5)).outcome == "verified"


def test_around_hubs_the_number_is_a_bound_of_the_cost() -> None:
    instance = Instance.read(INSTANCES / "random" / "hub_24.json")
    solution = solve(instance, Options(objective=Objective({instance.colors[0]: 2}), workers=1))
    hubs = next(bound for bound in solution.bounds or () if bound.kind == "hubs")
    assert (hubs.of, hubs.value, solution.cost, solution.status) == ("cost", 15, 16, "optimal")
    outcomes = {v.bound.kind: v.outcome for v in check_solution(instance, solution).bounds}
    assert outcomes["hubs"] == "verified"
    # Links save pieces, whatever these cost, so dear pieces prove no more than their number.
    certificate = json.loads(json.dumps(hubs.certificate))
    certificate["parts"][-1]["value"] += 1
    more = replace(hubs, value=16, certificate=certificate)
    costs = [2] * len(instance.colors)
    verdict = verify_bound(instance, more, regions_of_cells(instance), costs=costs)
    assert verdict.outcome == "refused"
    assert claims(instance, solution, check_solution(instance, solution).bounds) == {
        "cost_lower_bound": 16,
        "status": "optimal",
    }


def test_a_plan_may_cost_less() -> None:
    """Green and blue cost 8 here, and there are no segments that cost 9 together."""
    costs = (20, 4, 4)
    runner = Runner(Options(workers=1))

    def run(model: cp_model.CpModel, seed: int) -> tuple[cp_model.CpSolver, Any]:
        solver = runner.single(seed=seed)
        return solver, runner.solve(solver, model)

    planner = Planner(TWO, color_regions(TWO), 8, run, costs=costs)
    plan = planner.plan(9, 0)
    assert plan is not None and sorted(segment.region[0] for segment in plan) == [1, 2]


@examples(15)
@given(seed=SEEDS, costs=COSTS)
def test_the_full_model_alone(seed: int, costs: list[int]) -> None:
    """Its optimum, and the painting that is read from it, without any bound beside it."""
    instance = planar_graph(seed, 3, 4, 3, self_edges=seed % 2 == 1)
    _, own = weighed(instance, costs)
    colors = [frozenset(cell.colors) for cell in instance.cells]
    graph = dart_graph(instance, colors, dict.fromkeys(instance.live_edges, 1), ())
    built = full_model(graph, color_regions(instance), costs=own)
    runner = Runner(Options())
    solver = runner.single()
    assert runner.solve(solver, built.model) == cp_model.OPTIMAL
    least = round(solver.objective_value)
    assert least == literal_minimum(instance, own)
    painting = read_painting(graph, built.variables, solver, own)
    assert counted(graph, painting, own) == least


def test_a_cell_alone_is_painted_in_its_cheapest_color() -> None:
    single = replace(TWO, cells=(Cell(0, (0, 2), ()),), edges=())
    graph = dart_graph(single, [frozenset({0, 2})], {}, ())
    built = full_model(graph, color_regions(single), costs=(5, 1, 1))
    runner = Runner(Options())
    solver = runner.single()
    runner.solve(solver, built.model)
    ((block,),) = read_painting(graph, built.variables, solver, (5, 1, 1))
    assert (block.color, round(solver.objective_value)) == (2, 1)


@examples(12)
@given(seed=SEEDS, costs=COSTS, colors=st.integers(2, 3))
def test_graphs_against_all_divisions(seed: int, costs: list[int], colors: int) -> None:
    instance = planar_graph(seed, 3, 4, colors, self_edges=seed % 2 == 1)
    options, own = weighed(instance, costs)
    expected = literal_minimum(instance, own)
    for name in ABLE:
        found = solve(instance, options, name)
        assert (found.cost, found.status) == (expected, "optimal"), name
        assert check_solution(instance, found).valid


@examples(12)
@given(
    seed=SEEDS,
    costs=COSTS,
    recipe=st.sampled_from(
        [
            {"size": 7, "colors": 2, "waves": 1.0},
            {"size": 6, "colors": 3, "waves": 0.4, "cracks": 2},
            {"size": 8, "colors": 2, "coverage": (0.8, 1.0), "rim": 5},
        ]
    ),
)
def test_surfaces_against_vertex_colorings(
    seed: int, costs: list[int], recipe: dict[str, Any]
) -> None:
    """No coloring of the vertices costs less than a bound for the surface says."""
    surface = blobs(seed, **recipe)
    instance = decompose(surface)
    assume(1 < len(instance.cells) < 9)
    options, own = weighed(instance, costs)
    expected = vertex_minimum(surface, own)
    paper, by_search = solve(instance, options), solve(instance, options, "dfs")
    assert paper.cost == by_search.cost and paper.status == by_search.status == "optimal"
    for solution in (paper, by_search):
        assert solution.cost_surface_lower_bound <= expected
        assert check_solution(instance, solution).valid
        assert Solution.from_document(json.loads(solution.to_json())) == replace(
            solution, seconds=round(solution.seconds, 4)
        )
    wide = solve(instance, replace(options, search_space="surface", strands=2))
    assert wide.cost == expected
    fewest = solve(instance, Options(workers=1))
    assert (fewest.segments or 0) <= (paper.segments or 0)
    assert segments_of_whole_cells(instance, own) >= expected


@examples(20)
@given(seed=SEEDS, costs=COSTS)
def test_certificates_prove_their_cost_and_no_more(seed: int, costs: list[int]) -> None:
    """The cells of a bound by a cheapest cover, held against all sets of color regions."""
    instance = planar_graph(seed, 7, 10, 4)
    options, own = weighed(instance, costs)
    solution = solve(instance, options)
    regions = regions_of_cells(instance)
    bounds = [b for b in solution.bounds or () if (b.kind, b.of) == ("cover", "cost")]
    for bound in bounds:
        assert bound.certificate is not None
        assert verify_bound(instance, bound, regions, costs=own).outcome == "verified"
        cells = bound.certificate["cells"]
        best = {frozenset[tuple[int, int]](): 0}
        for cell in cells:
            best = {
                chosen | {region}: sum(own[color] for color, _ in chosen | {region})
                for chosen in best
                for region in regions[cell]
            }
        least = min(best.values())
        assert least >= bound.value
        more = replace(bound, value=least + 1)
        assert verify_bound(instance, more, regions, costs=own).outcome == "refused"


def test_what_is_false_is_refused() -> None:
    solution = solve(TWO, Options(objective=Objective({"red": 3})))
    bounds = solution.bounds or ()
    cover = next(bound for bound in bounds if bound.of == "cost")
    for change, problem in (
        ({"cost": 3}, "cost: says 3, the segments of the division cost 2"),
        ({"cost_lower_bound": 1}, "cost_lower_bound: says 1, the greatest of bounds is 2"),
        ({"objective": Objective({"red": 3, "blue": 2})}, "cost: says 2"),
        ({"objective": Objective({"pink": 3})}, "objective.segments: names the color 'pink'"),
        ({"objective": Objective({"red": 3}, 2.0)}, "objective.uncovered_price: cannot be min"),
        ({"bounds": bounds[:-1], "cost_lower_bound": 1}, "status: a division that costs 2 is not"),
        (
            {"bounds": (*bounds, replace(cover, value=3)), "cost_lower_bound": 3},
            "cost_lower_bound: 3 cannot be above the 2 of the division",
        ),
        (
            {"objective": Objective({"red": 1, "blue": 1})},
            "bounds[1].certificate: color regions that cost less than 2 touch all",
        ),
        (
            {"bounds": (*bounds, replace(cover, kind="strangers"))},
            "strangers proves nothing of costs",
        ),
        ({"schemes": 1, "complete": True}, "schemes: go with the fewest segments"),
        (
            {"objective": None, "cost": None, "cost_lower_bound": None},
            "bounds: there is one of the cost without an objective",
        ),
    ):
        problems = check_solution(TWO, replace(solution, **change)).problems
        assert any(problem in one for one in problems), (problem, problems)
    for change, field in (({"cost": None}, "cost"), ({"objective": None}, "cost_lower_bound")):
        with pytest.raises(InputError, match=f"{field}: goes with objective"):
            replace(solution, **change)


def test_the_cost_is_told_where_it_matters() -> None:
    """With the default objective nothing is said of it, and what it says is as it was."""
    plain = solve(TWO, Options())
    ones = solve(TWO, Options(objective=Objective({"red": 1})))
    assert replace(ones, seconds=0.0) == replace(plain, seconds=0.0)
    assert not {"objective", "cost", "cost_lower_bound"} & plain.to_document().keys()
    assert all("of" not in bound for bound in plain.to_document()["bounds"])
    found = solve(TWO, Options(objective=Objective({"red": 3})))
    document = found.to_document()
    assert document["objective"] == {"segments": {"red": 3}}
    assert (document["cost"], document["cost_lower_bound"]) == (2, 2)
    assert str(found) == (
        "2 segments, 1 lift-off, cost 2, optimal: proved for any division of the surface, because "
        "cheaper color regions cannot touch every cell"
    )
    trusted = replace(found, bounds=(Bound("model", 2, "strands", of="cost"),))
    assert "cost 2, optimal in the search space paper; any division of the" in str(trusted)
    open_one = replace(trusted, status="feasible", cost_lower_bound=1)
    assert "cost 2, not proved to be the least: at least 1 in the search space" in str(open_one)
    version_1 = document | {"version": 1}
    with pytest.raises(InputError, match="is a member of version 2"):
        Solution.from_document({k: v for k, v in version_1.items() if k not in ("bounds",)})


def test_what_does_not_go_together_is_refused() -> None:
    objective = Objective({"red": 3})
    with pytest.raises(InputError, match="fewest_cuts: goes with the fewest segments"):
        solve(TWO, Options(objective=objective, fewest_cuts=True))
    with pytest.raises(InputError, match="schemes: goes with the fewest segments"):
        next(enumerate_schemes(TWO, Options(objective=objective), "cp-sat", 1))
    with pytest.raises(InputError, match="names the color 'pink', the instance has 'red', 'green'"):
        solve(TWO, Options(objective=Objective({"pink": 2})))
    for other in (Objective(uncovered_price=2.0), Objective(change_over=1.0)):
        with pytest.raises(InputError, match="cannot be minimized here, only segments"):
            solve(TWO, Options(objective=other))
    for cost in (0, -1, 1.5, True, 10**7):
        with pytest.raises(InputError, match="segments"):
            Objective({"red": cost})  # type: ignore[dict-item]


@pytest.mark.parametrize(("name", "least"), [("uncovered_price", 0), ("change_over", 1)])
def test_prices_that_floating_point_could_not_add_are_refused(name: str, least: int) -> None:
    """1e17 + 1 is 1e17, and 1000 * 1e306 no number; up to a million sums are right."""
    for price in (1_000_000.5, 1e17, 1e306):
        with pytest.raises(InputError, match=f"{name}: .* less than or equal to 1000000"):
            Objective(**{name: price})
    with pytest.raises(InputError, match=f"{name}: .* greater than or equal to {least}"):
        Objective(**{name: least - 0.5})
    for price in (float("inf"), float("nan")):
        with pytest.raises(InputError, match=name):
            Objective(**{name: price})
    for price in (least, 1.001, 2.5, 1_000_000):
        assert getattr(Objective(**{name: price}), name) == price


def test_a_change_over_is_told_in_thousandths() -> None:
    with pytest.raises(InputError, match="change_over: must have no more than three decimals"):
        Objective(change_over=1.0004)


def test_a_start_is_kept_where_it_is_cheaper() -> None:
    """With no time for more a dear start gives way to whole cells in cheap colors."""
    red, both = solve(TWO, Options()), solve(TWO, Options(objective=Objective({"red": 3})))
    for start, costs in ((both, {"red": 3}), (red, {"green": 5, "blue": 5})):
        begin = Start(start.cells or (), ())
        found = solve(TWO, Options(objective=Objective(costs), start=begin))
        assert found.cells == start.cells


def test_an_objective_in_words() -> None:
    """Whatever is asked for is said, and nothing else."""
    assert str(Objective()) == str(Objective({"red": 1})) == "each segment costs 1"
    assert str(Objective({"red": 3})) == "what segments cost by color, others 1: red: 3"
    price = str(Objective(uncovered_price=20.0))
    assert "20 segments" in price and "color" not in price
    both = str(Objective({"red": 3}, change_over=2.0))
    assert "red: 3" in both and "2 lift-offs" in both
