"""Each encoding by itself: known answers, brute force, the reference solver, limits, bad input."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from exhaustive_minima import live_darts, minimum
from hypothesis import assume, example, given
from hypothesis import strategies as st
from library import PAPER
from ortools.sat.python import cp_model
from rooms import four_colors_in_turn

from cellcolor.cli.solving import Interrupted
from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.solution import count_segments
from cellcolor.deadline import Deadline
from cellcolor.errors import InputError, TooLarge
from cellcolor.lab.families import SMALL, hub, hub_grid, hub_minimum, planar_graph
from cellcolor.lab.families.hubs import wide_hub
from cellcolor.solvers import interruptible
from cellcolor.solvers.checked import solve
from cellcolor.solvers.dfs import ReferenceSolver
from cellcolor.solvers.encodings.contour import Contour, ContourSolver
from cellcolor.solvers.encodings.pointers import Pointers
from cellcolor.solvers.encodings.problem import Problem
from cellcolor.solvers.encodings.ranks import Ranks
from cellcolor.solvers.interface import Options
from cellcolor.solvers.joined_chains import division_of_chains
from cellcolor.solvers.registry import make_solver, solver_version
from examples import examples

NAMES = ("cp-sat-pointers", "cp-sat-ranks", "cp-sat-contour")
FIGURES = sorted(
    path
    for path in PAPER.glob("*.json")
    if not path.name.endswith(".surface.json") and Instance.read(path).most_live_loops < 2
)


@pytest.fixture(params=NAMES)
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def proved(instance: Instance, name: str) -> int:
    """The minimum, of a division that the checker has seen."""
    solution = solve(instance, Options(deadline=Deadline.after(60.0), workers=1), name)
    assert solution.status == "optimal" and solution.segments is not None
    return solution.segments


@pytest.mark.parametrize("path", FIGURES, ids=lambda path: path.stem)
def test_figures(path: Path, name: str) -> None:
    instance = Instance.read(path)
    assert instance.known is not None and instance.known.paper is not None
    assert proved(instance, name) == instance.known.paper.segments


@examples(7)
@example(seed=16567, cells=4, self_edges=True)  # its only live edge is a self-edge: no join at all
@given(seed=st.integers(0, 10**6), cells=st.integers(3, 4), self_edges=st.booleans())
def test_brute_force_over_all_partitions(seed: int, cells: int, self_edges: bool) -> None:
    instance = planar_graph(seed, cells, cells + 3, 3, self_edges=self_edges)
    assume(max(len(live_darts(instance, cell)) for cell in instance.cells) <= 5)
    expected = minimum(instance)
    for name in NAMES:
        assert proved(instance, name) == expected, name


@examples(7)
@given(seed=st.integers(0, 10**6), self_edges=st.booleans())
def test_reference_solver_on_graphs(seed: int, self_edges: bool) -> None:
    family = SMALL["graphs with self-edges" if self_edges else "graphs"]
    instance = family(seed)
    assert isinstance(instance, Instance)
    assume(instance.most_live_loops < 2)
    expected = ReferenceSolver().minimize(instance, Options()).lower_bound
    for name in NAMES:
        assert proved(instance, name) == expected, name


@examples(6)
@given(seed=st.integers(0, 10**6), petals=st.integers(4, 6), choices=st.integers(1, 3))
def test_hubs(seed: int, petals: int, choices: int) -> None:
    """One cell in which links would cross; of single colors the minimum is known."""
    instance = hub(seed, petals, 4) if choices == 1 else wide_hub(seed, petals, 4, choices)
    if choices == 1:
        expected = hub_minimum([cell.colors[0] for cell in instance.cells[1:]])
    else:
        expected = ReferenceSolver().minimize(instance, Options()).lower_bound
    for name in NAMES:
        assert proved(instance, name) == expected, name


def test_grids_of_hubs(name: str) -> None:
    """Trees in which cells of several segments are passed; the reference solver's minimum."""
    grid = hub_grid(0, 2, 2, 4, 1)
    expected = ReferenceSolver().minimize(grid, Options()).lower_bound
    assert proved(grid, name) == expected


@pytest.mark.parametrize("encoding", [Pointers, Ranks, Contour])
def test_no_solution_of_a_model_has_fewer_segments_than_it_says(
    encoding: type[Pointers | Ranks | Contour],
) -> None:
    """Whatever a model allows is a division with so many segments or fewer, optimal or not."""
    for seed in range(8):
        instance = planar_graph(seed, 5, 9, 3, self_edges=seed % 2 == 1)
        built = encoding(Problem.of(instance), Deadline())
        solver = cp_model.CpSolver()
        solver.parameters.num_workers = 1
        solver.parameters.stop_after_first_solution = True
        solver.parameters.random_seed = seed
        solver.parameters.cp_model_presolve = False
        assert solver.solve(built.model) in (cp_model.OPTIMAL, cp_model.FEASIBLE)
        colors = {edge: c for (edge, c), on in built.joined.items() if solver.boolean_value(on)}
        after = dict(pair for pair, on in built.links() if solver.boolean_value(on))
        assert count_segments(division_of_chains(instance, colors, after)) <= solver.objective_value


@pytest.mark.parametrize("count", [0, 1])
def test_without_edges(name: str, count: int) -> None:
    cells = tuple(Cell(number, (0,), ()) for number in range(count))
    assert proved(Instance("no edges", ("c",), cells, ()), name) == count


def test_petals_of_one_color_are_one_segment(name: str) -> None:
    """A hub of four petals, red and blue in turn: the red ones joined across it part the blue."""
    cells = [Cell(0, (0, 1), ((1, 2, 3, 4),))]
    cells += [Cell(n, ((n - 1) % 2,), ((-n,),)) for n in range(1, 5)]
    edges = tuple(Edge(n, 0, n) for n in range(1, 5))
    assert proved(Instance("petals", ("red", "blue"), tuple(cells), edges), name) == 3


def test_several_loops_need_seams(name: str) -> None:
    """``solve`` makes them; the model itself knows one live loop."""
    annulus = Instance.read(PAPER / "annulus.json")
    assert annulus.known is not None and annulus.known.paper is not None
    assert solve(annulus, Options(), name).segments == annulus.known.paper.segments
    with pytest.raises(InputError, match=r"cells\[\d+\]\.loops: the model knows one live loop"):
        make_solver(name).minimize(annulus, Options())


def test_models_that_would_not_fit_are_refused(name: str) -> None:
    with pytest.raises(TooLarge, match=r"a model of more than 6e\+05 terms is not built"):
        solve(four_colors_in_turn(220), Options(), name)


def test_no_time_is_no_proof(name: str) -> None:
    solution = solve(hub(0, 40, 4), Options(deadline=Deadline.after(-1.0)), name)
    assert (solution.status, solution.lower_bound) == ("unknown", 0)


@pytest.mark.second
def test_at_the_deadline_the_best_and_a_bound(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The search is cut off by effort, which does not depend on how busy the machine is."""
    make = interruptible.make_portfolio

    def hasty(
        deadline: Deadline, workers: int | None, seed: int, strategies: Sequence[str]
    ) -> cp_model.CpSolver:
        return make(deadline, workers, seed, strategies, effort=0.5)

    monkeypatch.setattr("cellcolor.solvers.encodings.solving.make_portfolio", hasty)
    grid = hub_grid(0, 5, 5, 4)
    heard: list[int | None] = []
    solution = solve(grid, Options(workers=1), name, lambda best, _: heard.append(best))
    assert solution.segments is not None and solution.status == "feasible"
    assert 1 <= solution.lower_bound < solution.segments
    assert heard and None not in heard


def test_interrupts_end_the_search(monkeypatch: pytest.MonkeyPatch) -> None:
    """A signal that stands for the end of the time keeps what was found; Ctrl-C goes on."""
    for interrupt, known in ((Interrupted("interrupted"), True), (KeyboardInterrupt(), False)):

        def interrupted(
            solver: cp_model.CpSolver,
            model: cp_model.CpModel,
            _: object,
            error: BaseException = interrupt,
        ) -> tuple[cp_model.CpSolverStatus, BaseException]:
            return solver.solve(model), error

        monkeypatch.setattr("cellcolor.solvers.encodings.solving.solve_interruptibly", interrupted)
        instance = Instance.read(PAPER / "ring.json")
        if known:
            assert ContourSolver().minimize(instance, Options()).division is not None
        else:
            with pytest.raises(KeyboardInterrupt):
                ContourSolver().minimize(instance, Options())


def test_versions(name: str) -> None:
    assert solver_version(name).startswith("OR-Tools 9.")


@pytest.mark.parametrize("encoding", [Pointers, Ranks, Contour])
def test_the_deadline_is_looked_at_for_every_dart_of_a_large_cell(
    encoding: type[Pointers | Ranks | Contour], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its constraints against crossing are nearly all of a model."""
    asked: list[Deadline] = []
    monkeypatch.setattr(Deadline, "check", lambda deadline: asked.append(deadline))
    encoding(Problem.of(hub(0, 40, 4)), Deadline())
    assert len(asked) > 40
