"""Solve an instance with a solver of choice; the checker sees every result."""

from __future__ import annotations

import time
from collections.abc import Iterator

from cellcolor.checker.cutting_paths import cutting_paths
from cellcolor.checker.dart_lists import MOST_DARTS
from cellcolor.checker.division import Report, check_scheme, check_solution
from cellcolor.data.bound import Bound, greatest
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, InstanceReference, Solution, Status, count_segments
from cellcolor.errors import InputError, RefusedResult
from cellcolor.solvers.interface import Answer, OnProgress, Options, Solver

__all__ = [
    "CONTENDERS",
    "SOLVERS",
    "enumerate_schemes",
    "make_solver",
    "solve",
]

SOLVERS = ("cp-sat", "dfs")
"""The names of the solvers."""

CONTENDERS = (*SOLVERS, "cp-sat-model")
"""What is held to each other: also the full CP-SAT model without plans, which settle most instances
before it is built."""


def make_solver(name: str) -> Solver:
    """The solver of that name.

    Raises:
        KeyError: there is none.
    """
    if name in ("cp-sat", "cp-sat-model"):
        from cellcolor.solvers.cpsat import CpSatSolver  # imports ortools

        return CpSatSolver(plans=name == "cp-sat")
    if name == "dfs":
        from cellcolor.solvers.dfs import ReferenceSolver

        return ReferenceSolver()
    raise KeyError(name)


def solve(
    instance: Instance,
    options: Options,
    solver: str = "cp-sat",
    progress: OnProgress | None = None,
) -> Solution:
    """Color an instance with the fewest segments.

    Args:
        instance: the topological graph.
        options: search space, limits, seed.
        solver: one of ``CONTENDERS``.
        progress: called with the best so far and the lower bound.

    Returns:
        The solution, held against the instance by the checker.

    Raises:
        InputError: an option is of CP-SAT only, and the solver is another; or there are too many
            strands.
        RefusedResult: the checker refuses what the solver found.
    """
    if solver == "dfs":
        for name, asked in (("start", options.start), ("fewest_cuts", options.fewest_cuts)):
            if asked:
                raise InputError(None, name, "goes with the solver cp-sat")
    live = sum(bool(instance.joinable(edge.id)) for edge in instance.edges)
    if 2 * live * options.strands > MOST_DARTS:
        raise InputError(
            None,
            "strands",
            f"{options.strands} for each of {live} live edges are too many; "
            f"they may have {MOST_DARTS} darts together",
        )
    chosen = make_solver(solver)
    start = time.monotonic()
    answer = chosen.minimize(instance, options, progress)
    if instance.nothing_to_cover:
        # Covering nothing of a surface in 0 segments would be no answer to anybody's question.
        note = "No point of the surface can be covered: there is nothing to divide."
        answer = Answer(None, (), (), notes=(*answer.notes, note))
    bounds = _needed(answer.bounds)
    surface_bound, lower_bound = greatest(bounds, "surface"), greatest(bounds, "strands")
    segments = None if answer.division is None else count_segments(answer.division)
    proved_for_surface = segments == surface_bound
    status: Status = "feasible"
    if segments is None:
        status = "unknown"
    elif proved_for_surface or (options.search_space == "paper" and segments == lower_bound):
        status = "optimal"
    solution = Solution(
        instance=InstanceReference(instance.name, instance.sha256),
        search_space=options.search_space,
        strands=options.strands,
        solver=solver,
        status=status,
        segments=segments,
        lift_offs=None if segments is None else max(0, segments - 1),
        lower_bound=lower_bound,
        surface_lower_bound=surface_bound,
        proved_for_surface=proved_for_surface,
        seams=answer.seams,
        cells=answer.division,
        seconds=time.monotonic() - start,
        cutting_paths=None if answer.cutting_paths_lower_bound is None else _cuts(instance, answer),
        cutting_paths_lower_bound=answer.cutting_paths_lower_bound,
        bounds=bounds,
        coverage=instance.coverage,
        notes=answer.notes,
    )
    _insist(check_solution(instance, solution), solver)
    return solution


def enumerate_schemes(
    instance: Instance, options: Options, solver: str, segments: int
) -> Iterator[Division]:
    """Every optimal scheme (docs/semantics.md, section 3), each once, as they are found.

    Args:
        instance: the topological graph.
        options: time limit and seed; the search space is ``paper``.
        solver: one of ``SOLVERS``.
        segments: the minimum.

    Raises:
        OutOfTime: the time limit came first.
        TooLarge: the model would not fit into memory.
        RefusedResult: the checker refuses what the solver found.
    """
    found = False
    for division in make_solver(solver).optimal_schemes(instance, options, segments):
        found = True
        report = check_scheme(instance, division)
        _insist(report, solver)
        if report.segments != segments or not report.is_scheme:
            reasons = "; ".join(report.not_canonical) or f"{report.segments} segments"
            raise RefusedResult(f"{solver} returned no optimal scheme: {reasons}")
        yield division
    if not found:
        raise RefusedResult(f"{solver} found no scheme with {segments} segments, the minimum")


def _needed(bounds: tuple[Bound, ...]) -> tuple[Bound, ...]:
    """The bounds without those that an earlier or a more general one makes pointless.

    Those for any division of the surface come first, each kind of bound in the order given.
    """
    kept: list[Bound] = []
    for extent in ("surface", "strands"):
        for bound in bounds:
            if bound.holds_for == extent and bound.value > max((b.value for b in kept), default=0):
                kept.append(bound)
    return tuple(kept)


def _cuts(instance: Instance, answer: Answer) -> int | None:
    if answer.division is None:
        return None
    return cutting_paths(instance, answer.division, answer.seams)


def _insist(report: Report, solver: str) -> None:
    if not report.valid:
        raise RefusedResult(f"{solver} returned something illegal: {report.problems[0]}")
