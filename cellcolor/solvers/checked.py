"""Solve an instance with a solver of choice; the checker sees every result."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace

from cellcolor.checker.certificates import verify_bound
from cellcolor.checker.dart_lists import MOST_DARTS
from cellcolor.checker.division import Report, check_scheme, check_solution
from cellcolor.checker.groups import regions_of_cells
from cellcolor.data.bounds import Bound, CertifiedCells, greatest, kind_of
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, InstanceReference, Solution, Status, count_segments
from cellcolor.data.wording import count, lift_offs_of
from cellcolor.deadline import Deadline
from cellcolor.errors import InputError, RefusedResult
from cellcolor.solvers.bounds.cover import hard_cells
from cellcolor.solvers.interface import Answer, OnProgress, Options, SchemeSolver, Start
from cellcolor.solvers.registry import DEFAULT, make_solver
from cellcolor.solvers.seamed import Seamed

FEW_STEPS = 20_000
"""Choices for each certificate of a result, some seconds; hardly any takes more than a few."""


def check_able(name: str, options: Options, *, schemes: bool = False) -> None:
    """Reject a task that a solver does not declare.

    Args:
        schemes: whether it is to list all optimal schemes.

    Raises:
        InputError: there is no such solver, or it is not able to.
    """
    able = make_solver(name).abilities
    if options.start is not None and not able.start:
        raise InputError(None, "start", f"is more than the solver {name} can do")
    if schemes and not able.optimal_schemes:
        raise InputError(None, "schemes", f"is more than the solver {name} can do")
    if schemes and options.search_space != "paper":
        message = "schemes are defined in search space 'paper' only"
        raise InputError(None, "search_space", message)
    if options.search_space not in able.search_spaces:
        spaces = " and ".join(able.search_spaces)
        message = f"is {options.search_space}, the solver {name} searches {spaces}"
        raise InputError(None, "search_space", message)


def check_able_to_list(name: str, instance: Instance) -> None:
    """Reject an instance whose optimal schemes a solver does not list.

    Raises:
        InputError: there is no such solver, or a cell has too many live loops for it.
    """
    if make_solver(name).abilities.schemes_of_several_loops:
        return
    for cell, loops in enumerate(instance.live_loops):
        if len(loops) > 1:
            only = f"the solver {name} lists optimal schemes with one live loop only"
            raise InputError(None, f"cells[{cell}].loops", f"{only}, this one has {len(loops)}")


def solve(
    instance: Instance, options: Options, solver: str = DEFAULT, progress: OnProgress | None = None
) -> Solution:
    """Color an instance with the fewest segments; the checker sees it.

    Raises:
        InputError: there is no such solver, or it is not able to, or there are too many strands.
        TooLarge: the seams of cells with several loops would need too many strands.
        RefusedResult: the checker refuses what the solver found.
    """
    check_able(solver, options)
    chosen = make_solver(solver)
    live = len(instance.live_edges)
    if 2 * live * options.strands > MOST_DARTS:
        many = f"{options.strands} for each of {live} live edges are too many"
        raise InputError(None, "strands", f"{many}; they may have {MOST_DARTS} darts together")
    start = time.monotonic()
    if chosen.abilities.several_loops:
        answer = chosen.minimize(instance, options, progress)
    else:
        seamed = Seamed(instance)
        answer = chosen.minimize(seamed.instance, options, progress)
        if answer.division is not None and seamed.seams:
            division = seamed.division(answer.division)
            answer = replace(answer, division=division, seams=seamed.seams)
    if instance.nothing_to_cover:
        # Covering nothing of a surface in 0 segments would be no answer to anybody's question.
        note = "No point of the surface can be covered: there is nothing to divide."
        answer = Answer(None, (), (), notes=(*answer.notes, note))
    doubtful = (instance.meta or {}).get("doubtful_edges")
    if isinstance(doubtful, list) and doubtful:
        note = (
            f"Whatever is proved is proved of this labelling: {count(len(doubtful), 'mesh edge')} "
            "of its surface are doubtful."
        )
        answer = replace(answer, notes=(*answer.notes, note))
    return checked_solution(instance, options, solver, answer, time.monotonic() - start)


def checked_solution(
    instance: Instance, options: Options, solver: str, answer: Answer, seconds: float
) -> Solution:
    """What follows from an answer, after the checker has seen it.

    Its segments are counted, and its status is what it has proved.

    Raises:
        RefusedResult: the checker refuses what the solver found.
    """
    bounds = tuple(_certified(instance, b, options.deadline) for b in _needed(answer.bounds))
    surface_bound, lower_bound = greatest(bounds, "surface"), greatest(bounds, "strands")
    segments = None if answer.division is None else count_segments(answer.division)
    status: Status = "feasible"
    if segments is None:
        status = "unknown"
    elif segments == (lower_bound if options.search_space == "paper" else surface_bound):
        status = "optimal"
    solution = Solution(
        instance=InstanceReference(instance.name, instance.sha256),
        search_space=options.search_space,
        strands=options.strands,
        solver=solver,
        status=status,
        segments=segments,
        lift_offs=None if segments is None else lift_offs_of(segments),
        lower_bound=lower_bound,
        surface_lower_bound=surface_bound,
        proved_for_surface=segments == surface_bound,
        seams=answer.seams,
        cells=answer.division,
        seconds=seconds,
        bounds=bounds,
        coverage=instance.coverage,
        notes=answer.notes,
        model=answer.model,
    )
    return passed(instance, solution)


def passed(instance: Instance, solution: Solution) -> Solution:
    """A solution after the checker has seen it; its certificates have been verified before.

    Raises:
        RefusedResult: the checker refuses it.
    """
    bare = tuple(replace(bound, certificate=None) for bound in solution.bounds or ())
    _insist(check_solution(instance, replace(solution, bounds=bare)), solution.solver)
    return solution


def enumerate_schemes(
    instance: Instance,
    options: Options,
    solver: str,
    segments: int,
    known: Start | None = None,
    counted: Callable[[int], None] | None = None,
) -> Iterator[Division]:
    """Every optimal scheme (docs/semantics.md, section 3), each once, as they are found.

    Args:
        segments: the minimum, in the search space ``paper``.
        known: a division to start from, for solvers that can.
        counted: told how many schemes there are as soon as the solver knows that.

    Raises:
        InputError: there is no such solver, or it lists no schemes, or none of this instance.
        TooLarge: the search would not fit into memory.
        RefusedResult: the checker refuses what the solver found.
    """
    check_able(solver, options, schemes=True)
    check_able_to_list(solver, instance)
    chosen = make_solver(solver)
    if not isinstance(chosen, SchemeSolver):
        message = f"{solver} declares that it lists optimal schemes, but cannot do so"
        raise InputError(None, "solver", message)
    if known is not None and chosen.abilities.start:
        options = replace(options, start=known)
    division: Division | None = None
    schemes = chosen.optimal_schemes(instance, options, segments)
    for division in schemes:
        if counted is not None and (count := getattr(schemes, "count", None)) is not None:
            counted(count)
            counted = None
        report = check_scheme(instance, division)
        _insist(report, solver)
        if report.segments != segments or not report.is_scheme:
            reasons = "; ".join(report.not_canonical) or f"{report.segments} segments"
            raise RefusedResult(f"{solver} returned no optimal scheme: {reasons}")
        yield division
    if division is None:
        raise RefusedResult(f"{solver} found no scheme with {segments} segments, the minimum")


def _needed(bounds: tuple[Bound, ...]) -> tuple[Bound, ...]:
    """The bounds without those that an earlier or a more general one makes pointless.

    Those for any division of the surface come first, each kind of bound in the order given.
    """
    kept: list[Bound] = []
    for bound in sorted(bounds, key=lambda bound: bound.holds_for != "surface"):
        if bound.value > max((b.value for b in kept), default=0):
            kept.append(bound)
    return tuple(kept)


def _certified(instance: Instance, bound: Bound, deadline: Deadline) -> Bound:
    """The bound with what a checker without a solver can verify, where that is known in time."""
    if kind_of(bound).certificate is CertifiedCells and bound.holds_for == "surface":
        cells = hard_cells(instance, bound.value, deadline)
        if cells is not None:
            bound = replace(bound, certificate=CertifiedCells(tuple(cells)).to_document())
    if bound.certificate is None:
        return bound
    # What a solver hands in may be true and yet not prove it: conflicts on handles, say. And what
    # could not be verified here would make the solution invalid if `check` refused it.
    regions = regions_of_cells(instance)
    verdict = verify_bound(instance, bound, regions, FEW_STEPS, deadline)
    return bound if verdict.outcome == "verified" else replace(bound, certificate=None)


def _insist(report: Report, solver: str) -> None:
    if not report.valid:
        raise RefusedResult(f"{solver} returned something illegal: {report.problems[0]}")
