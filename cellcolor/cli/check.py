"""``cellcolor check``: a solution or a plan against what it was made for, or a trajectory."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path

from cellcolor.cli.check_plan import PlanDemands, check_plan_file
from cellcolor.cli.check_solution import check_solution_file
from cellcolor.cli.exits import Exit
from cellcolor.cli.inputs import read_subject
from cellcolor.cli.library import say_better
from cellcolor.cli.progress import judge_progress_of
from cellcolor.cli.standard_input import STANDARD_INPUT, input_file, name_of
from cellcolor.cli.terminal import complain, print_json
from cellcolor.cli.verdict_lines import say_plan, say_solution, say_trajectory
from cellcolor.data.check_error import CheckError
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.data.trajectory import Trajectory
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.door.claims import format_of_claim, read_trajectory
from cellcolor.door.leaving_out import left_alone
from cellcolor.door.shipped import find_claim, find_file
from cellcolor.door.subject import Subject
from cellcolor.errors import CellcolorError, InputError
from cellcolor.questions.places import Place


@dataclass(frozen=True)
class Request:
    """What was asked for.

    Attributes:
        subject: an instance, a labelled surface or a scene; its file, its shipped name, or ``-``
            for standard input.
        claim: a solution of it, a plan on its surface, or a trajectory for the scene; its file,
            of a solution its shipped name, or ``-`` for standard input.
        deadline: when the proven range that a plan or a trajectory is compared with has to be
            there.
        demands: what else is wanted of a plan.
        as_json: one JSON object instead of lines.
        tolerance: of a scene's part.
        left_alone: where on the subject's surface nothing has to be covered.
    """

    subject: str
    claim: str
    deadline: Deadline
    demands: PlanDemands
    as_json: bool
    left_alone: Place | None = None
    tolerance: str | None = None


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
    if form != Plan.FORMAT and (option := request.demands.first_option):
        raise InputError(None, option, f"goes with a plan; {name_of(request.claim)} is none")
    if form == Trajectory.FORMAT:
        return _check_trajectory(request, claim)
    is_plan = form == Plan.FORMAT
    try:
        subject = _open(request, request.deadline if is_plan else NEVER)
    except OutOfTime:
        message = "unknown: the time limit came before there was a surface"
        at = InputError(name_of(request.subject), None, message)
        return _no_verdict(request, at, Exit.STOPPED)
    try:
        if is_plan:
            return _check_plan(request, subject, claim)
        solution_verdict = check_solution_file(subject, claim, request.claim)
    except InputError as error:
        if error.file is None and request.subject == STANDARD_INPUT:
            raise error.in_file(name_of(STANDARD_INPUT)) from error
        raise
    if request.as_json:
        print_json(solution_verdict.to_document())
    else:
        say_solution(name_of(request.claim), solution_verdict)
        if solution_verdict.valid:
            say_better(subject.graph(), Solution.read(claim), solution_verdict)
    return Exit.DONE if solution_verdict.valid else Exit.INVALID


def _open(request: Request, deadline: Deadline) -> Subject:
    """The subject; one from standard input lies beside no other file."""
    if request.subject != STANDARD_INPUT:
        subject = read_subject(find_file(request.subject), deadline, request.tolerance)
    else:
        with input_file(STANDARD_INPUT) as copy:
            subject = replace(read_subject(copy, deadline), path=None)
    return left_alone(subject, request.left_alone)


def _check_plan(request: Request, subject: Subject, claim: Path) -> Exit:
    if not subject.names_surface:
        if subject.path is None and subject.given_instance is not None:
            raise InputError(None, "surface", subject.why_no_surface)
        names = f"{request.subject} names none"
        message = f"is a plan, which goes with a labelled surface; {names}"
        raise InputError(name_of(request.claim), "format", message)
    verdict = check_plan_file(subject, claim, request.claim, request.demands, request.deadline)
    if request.as_json:
        print_json(verdict.to_document())
    else:
        say_plan(name_of(request.claim), verdict)
    if not verdict.valid:
        return Exit.INVALID
    if not request.demands.optimal or verdict.optimal:
        return Exit.DONE
    return Exit.STOPPED if verdict.optimal is None else Exit.INVALID


def _check_trajectory(request: Request, claim: Path) -> Exit:
    from cellcolor.door.judging import judge_trajectory

    given = read_trajectory(claim)
    try:
        subject = _open(request, request.deadline)
        with judge_progress_of(Path(request.claim)) as report:
            verdict = judge_trajectory(subject, given, request.deadline, report)
    except InputError as error:
        raise error if error.file else error.in_file(name_of(request.claim)) from error
    except OutOfTime:
        message = "unknown: the time limit came before there was a verdict"
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
