"""Checking a solution and the schemes that follow it in its file."""

from __future__ import annotations

from pathlib import Path

from cellcolor.checker.claimed_numbers import claims
from cellcolor.checker.division import check_scheme
from cellcolor.data.solution import SchemeKey, Solution, read_schemes, scheme_key
from cellcolor.data.solution_verdict import CheckedBound, SolutionVerdict
from cellcolor.data.wording import count
from cellcolor.door.subject import Subject


def check_solution_file(subject: Subject, claim: Path, name: str) -> SolutionVerdict:
    """The verdict on a solution's file.

    Args:
        subject: what was solved.
        claim: the file.
        name: what the verdict says that the file is.

    Raises:
        InputError: one of the two cannot be used.
    """
    from cellcolor.door.judging import check

    instance, solution = subject.graph(), Solution.read(claim)
    on_trust = subject.check_graph()
    report = check(subject, solution)
    problems = list(report.problems)
    keys: set[SchemeKey] = set()
    schemes = 0
    for schemes, division in enumerate(read_schemes(claim), start=1):
        scheme = check_scheme(instance, division)
        faults = [*scheme.problems, *scheme.not_canonical]
        if not faults and scheme.segments != solution.segments:
            faults.append(
                f"has {count(scheme.segments or 0, 'segment')}, the solution {solution.segments}"
            )
        key = scheme_key(division)
        if key in keys:
            faults.append("an earlier line has the same scheme")
        keys.add(key)
        problems += [f"scheme {schemes}: {fault}" for fault in faults]
    # A solution alone may count schemes that it does not list; a list has to be whole.
    if schemes and schemes != solution.schemes:
        problems.append(f"schemes: says {solution.schemes}, listed are {schemes}")
    claimed = claims(instance, solution, report.bounds) if report.valid else {}
    if on_trust is not None:
        claimed["instance.surface"] = on_trust
    return SolutionVerdict(
        file=name,
        valid=not problems,
        problems=tuple(problems),
        segments=report.segments,
        lift_offs=None if report.segments is None else max(0, report.segments - 1),
        status=solution.status,
        solver=solution.solver,
        bounds=tuple(CheckedBound(**checked.to_document()) for checked in report.bounds),
        bounds_by_solver=sum(checked.trusted for checked in report.bounds),
        claimed=claimed,
        schemes=schemes or None,
    )
