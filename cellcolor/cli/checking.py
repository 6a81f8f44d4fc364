"""``cellcolor check``: a solution or a plan against what it was made for, or a trajectory."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from cellcolor.checker.certificates import BoundVerdict
from cellcolor.checker.claimed_numbers import claims
from cellcolor.checker.division import check_scheme
from cellcolor.cli.ending import Exit
from cellcolor.cli.inputs import STANDARD_INPUT, input_file, name_of, read_subject
from cellcolor.cli.motion import check_painted, write_painted
from cellcolor.cli.progress import stages_of
from cellcolor.cli.terminal import complain, print_json
from cellcolor.cli.verdict_lines import say_better, say_plan, say_solution, say_trajectory
from cellcolor.data.plan import Plan
from cellcolor.data.schemes import read_schemes
from cellcolor.data.solution import SchemeKey, Solution, scheme_key
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.verdicts import (
    CheckedBound,
    CheckError,
    PlanImprovement,
    PlanVerdict,
    PlanViolation,
    SolutionVerdict,
)
from cellcolor.data.wording import count, lift_offs_of
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.door.leaving_out import left_alone
from cellcolor.door.reading import format_of_claim, read_trajectory
from cellcolor.door.shipped import find_claim, find_file
from cellcolor.door.subject import Subject
from cellcolor.errors import CellcolorError, InputError
from cellcolor.files.writing import is_folder_or_nothing
from cellcolor.questions.places import Place

if TYPE_CHECKING:
    from cellcolor.oracle import Improvement, Verdict

_VIOLATIONS = 100  # of a plan that are listed


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """What the command line asked for: an attribute for each argument and option of ``check``.

    Attributes:
        subject: the file or shipped name of an instance, a labelled surface or a scene, or ``-``.
        claim: a solution of it, a plan on its surface, or a trajectory for the scene, or ``-``.
        seconds: the time limit; a kept range that is not exact is used if its was no shorter.
        deadline: when that is over.
    """

    subject: str
    claim: str
    seconds: float
    deadline: Deadline
    left_alone: Place | None
    tolerance: str | None
    cache: Path | None
    better: Path | None
    require_optimal: bool
    as_json: bool

    @property
    def of_plans(self) -> str | None:
        """The first option given that only a plan can have."""
        given = {
            "--cache": self.cache is not None,
            "--better": self.better is not None,
            "--require-optimal": self.require_optimal,
        }
        return next((name for name, is_given in given.items() if is_given), None)


def check_files(request: Request) -> Exit:
    """Say whether a claim is valid, and what its numbers are."""
    try:
        with input_file(request.claim) as claim:
            copied = request.claim == STANDARD_INPUT
            return _check(request, claim if copied else find_claim(request.claim))
    except CellcolorError as error:
        at = error if isinstance(error, InputError) else InputError(None, None, str(error))
        return _no_verdict(request, at, Exit.BAD_INPUT)


def _check(request: Request, claim: Path) -> Exit:
    form = format_of_claim(claim)  # anything else is read as a solution
    if form != Plan.FORMAT and (option := request.of_plans):
        raise InputError(None, option, f"goes with a plan; {name_of(request.claim)} is none")
    if form == Trajectory.FORMAT:
        return _check_trajectory(request, claim)
    is_plan = form == Plan.FORMAT
    try:
        subject = _open(request, request.deadline if is_plan else NEVER)
    except OutOfTime:
        message = "unknown: the time limit came before there was a surface; see --time-limit"
        at = InputError(name_of(request.subject), None, message)
        return _no_verdict(request, at, Exit.STOPPED)
    try:
        if is_plan:
            return _check_plan(request, subject, claim)
        return _check_solution(request, subject, claim)
    except InputError as error:
        if error.file is None and request.subject == STANDARD_INPUT:
            raise error.in_file(name_of(STANDARD_INPUT)) from error
        raise


def _open(request: Request, deadline: Deadline) -> Subject:
    """The subject; one from standard input lies beside no other file."""
    if request.subject != STANDARD_INPUT:
        subject = read_subject(find_file(request.subject), deadline, request.tolerance)
    else:
        with input_file(STANDARD_INPUT) as copy:
            subject = replace(read_subject(copy, deadline), path=None)
    return left_alone(subject, request.left_alone)


def _check_solution(request: Request, subject: Subject, claim: Path) -> Exit:
    verdict = _on_solution(subject, claim, request.claim)
    if request.as_json:
        print_json(verdict.to_document())
    else:
        say_solution(name_of(request.claim), verdict)
        if verdict.valid:
            say_better(subject.graph(), Solution.read(claim), verdict)
    return Exit.DONE if verdict.valid else Exit.INVALID


def _on_solution(subject: Subject, claim: Path, name: str) -> SolutionVerdict:
    """The verdict on a solution's file, and on the schemes that follow the solution in it."""
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
        lift_offs=None if report.segments is None else lift_offs_of(report.segments),
        status=solution.status,
        solver=solution.solver,
        bounds=tuple(map(_checked, report.bounds)),
        bounds_by_solver=sum(checked.trusted for checked in report.bounds),
        claimed=claimed,
        schemes=schemes or None,
    )


def _checked(found: BoundVerdict) -> CheckedBound:
    bound = found.bound
    outcome = found.outcome, found.reason, found.tried, found.budget
    return CheckedBound(bound.kind, bound.value, bound.holds_for, *outcome)


def _check_plan(request: Request, subject: Subject, claim: Path) -> Exit:
    """Say what is known of a plan; write a better painting where one is known and asked for."""
    if not subject.names_surface:
        if subject.path is None and subject.given_instance is not None:
            raise InputError(None, "surface", subject.why_no_surface)
        names = f"{request.subject} names none"
        message = f"is a plan, which goes with a labelled surface; {names}"
        raise InputError(name_of(request.claim), "format", message)
    inputs = [path for path in (subject.path, subject.surface_path, claim) if path is not None]
    if request.better is not None:
        check_painted(request.better, inputs)
    if request.cache is not None:
        is_folder_or_nothing(request.cache)

    from cellcolor.door.oracle import KeepingOracle

    oracle = KeepingOracle(subject, request.seconds, request.cache)
    found = oracle.judge(claim, deadline=request.deadline)
    if request.better is not None and found.improvement is not None:
        write_painted(found.improvement.better.painted, request.better, inputs)
    verdict = _described(request.claim, found)
    if request.as_json:
        print_json(verdict.to_document())
    else:
        say_plan(name_of(request.claim), verdict)
    if not verdict.valid:
        return Exit.INVALID
    if not request.require_optimal or verdict.optimal:
        return Exit.DONE
    return Exit.STOPPED if verdict.optimal is None else Exit.INVALID


def _described(name: str, verdict: Verdict) -> PlanVerdict:
    bounds, segments = verdict.bounds, verdict.segments
    return PlanVerdict(
        file=name,
        valid=verdict.valid,
        text=str(verdict),
        problems=verdict.problems,
        violation_count=len(verdict.violations),
        violations=tuple(
            PlanViolation(found.vertex, found.color, found.place, found.reason)
            for found in verdict.violations[:_VIOLATIONS]
        ),
        segments=segments,
        lift_offs=verdict.lift_offs,
        lower_bound=None if bounds is None else bounds.lower,
        upper_bound=None if bounds is None else bounds.upper,
        optimal=verdict.optimal,
        beatable_by=verdict.beatable_by,
        gap=None if bounds is None or segments is None else segments - bounds.lower,
        on_mesh=verdict.on_mesh,
        improvement=_improved(verdict.improvement, segments),
        why=verdict.why,
        kept_lower_bound=verdict.kept_lower,
    )


def _improved(found: Improvement | None, segments: int | None) -> PlanImprovement | None:
    if found is None or segments is None:
        return None
    fewer = found.segments_on_mesh < segments
    return PlanImprovement(
        joined=found.joined,
        places=found.places,
        segments=found.segments,
        segments_on_mesh=found.segments_on_mesh,
        vertex_colors=found.better.on_mesh.vertex_colors if fewer else None,
    )


def _check_trajectory(request: Request, claim: Path) -> Exit:
    from cellcolor.door.judging import judge_trajectory

    given = read_trajectory(claim)
    try:
        subject = _open(request, request.deadline)
        with stages_of(Path(request.claim), "judging") as report:
            verdict = judge_trajectory(subject, given, request.deadline, report)
    except InputError as error:
        raise error if error.file else error.in_file(name_of(request.claim)) from error
    except OutOfTime:
        message = "unknown: the time limit came before there was a verdict; see --time-limit"
        at = InputError(name_of(request.claim), None, message)
        return _no_verdict(request, at, Exit.STOPPED)
    if request.as_json:
        print_json({"file": request.claim} | json.loads(verdict.to_json()))
    else:
        say_trajectory(name_of(request.claim), verdict)
    return Exit.DONE if verdict.valid else Exit.INVALID


def _no_verdict(request: Request, why: InputError, code: Exit) -> Exit:
    """Say why there is no verdict: on standard error, and as JSON where that was asked for."""
    complain(why)
    if request.as_json:
        error = CheckError(
            file=request.claim,
            valid=None,
            error=str(why),
            at_file=why.file,
            at_field=why.field,
            exit_code=3 if code is Exit.STOPPED else 2,
        )
        print_json(error.to_document())
    return code
