"""``cellcolor check``: a solution, a plan or a trajectory against what it was made for."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from cellcolor.checker.certificates import BoundVerdict
from cellcolor.checker.claimed_numbers import claims
from cellcolor.checker.division import check_scheme
from cellcolor.cli.ending import Exit
from cellcolor.cli.inputs import STANDARD_INPUT, input_file, name_of, read_subject
from cellcolor.cli.terminal import at_work, complain, print_json, say
from cellcolor.data.plan import Plan
from cellcolor.data.solution import SchemeKey, Solution, read_schemes, scheme_key
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.data.verdicts import (
    CheckedBound,
    CheckError,
    PlanImprovement,
    PlanVerdict,
    PlanViolation,
    SolutionVerdict,
)
from cellcolor.data.wording import count, lift_offs_of, segments_and_lift_offs
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.door.installed import find_claim, find_file
from cellcolor.door.reading import format_of_claim, read_claim
from cellcolor.door.subject import Subject
from cellcolor.errors import CellcolorError, InputError, naming
from cellcolor.files.writing import is_folder_or_nothing
from cellcolor.questions.places import Place

if TYPE_CHECKING:
    from cellcolor.oracle import Verdict

_FAULTS = 3  # of each kind
_VERTICES = 10
_SOLVERS = {"cp-sat": "CP-SAT", "cp-sat-model": "CP-SAT"}  # what has proved their bounds


def say_plan(name: str, verdict: Verdict) -> None:
    """What is said of a plan with a name."""
    say(f"{name}: {'valid' if verdict.valid else 'not valid'}")
    places = {f"vertex_colors[{found.vertex}]": found.place for found in verdict.violations}
    for problem in verdict.problems[:_VERTICES]:
        place = places.get(problem.partition(": ")[0])
        where = "" if place is None else " at ({:.3f}, {:.3f}, {:.3f}) m".format(*place)
        say(f"  {problem}{where}")
    if len(verdict.problems) > _VERTICES:
        say(f"  {len(verdict.problems) - _VERTICES} more")
    if verdict.segments is not None:
        say(f"  {verdict}")


def say_solution(name: str, verdict: SolutionVerdict) -> None:
    """What is said of a solution with a name."""
    say(f"{name}: {'valid' if verdict.valid else 'not valid'}")
    for problem in verdict.problems:
        say(f"  {problem}")
    if verdict.segments is not None:
        say(f"  {segments_and_lift_offs(verdict.segments)}")
    say(f"  status {verdict.status}")
    if verdict.schemes is not None:
        say(f"  {count(verdict.schemes, 'scheme')}")
    solver = _SOLVERS.get(verdict.solver, verdict.solver)
    for bound in verdict.bounds:
        tried = f"{bound.tried} of {bound.budget} choices tried"
        more = {"verified": tried, "refused": bound.reason}.get(bound.outcome, f"by {solver}")
        say(f"  at least {bound.value} by {bound.kind}: {bound.outcome}, {more}")
    if verdict.bounds_by_solver:
        bounds = count(len(verdict.bounds), "bound")
        say(f"  {verdict.bounds_by_solver} of {bounds} by {solver}")
    if verdict.claimed:
        claimed = (f"{name} {json.dumps(value)}" for name, value in verdict.claimed.items())
        say(f"  claimed, not verified: {', '.join(claimed)}")


def say_trajectory(name: str, verdict: TrajectoryVerdict) -> None:
    """What is said of a trajectory with a name."""
    said = count(sum(verdict.fault_counts.values()), "fault")
    say(f"{name}: {'valid' if verdict.valid else f'not valid, {said}'}")
    for kind, number in verdict.fault_counts.items():
        first = verdict.of_kind(kind)[:_FAULTS]
        for fault in first:
            say(f"  {fault}")
        if number > len(first):
            say(f"  {kind}: {number - len(first)} more")
    seconds = "" if verdict.seconds is None else f", {verdict.seconds:.1f} s"
    tested = f"{count(verdict.samples, 'sample')}, {count(verdict.tested, 'configuration')} tested"
    say(f"  {count(verdict.strokes, 'stroke')}, {count(verdict.lift_offs, 'lift-off')}{seconds}")
    say(f"  {tested}")
    if verdict.minimum_lift_offs is not None:
        extra = f"{verdict.claimed_extra} more announced, {verdict.unclaimed_extra} more not"
        say(f"  fewest lift-offs on this surface, proved: {verdict.minimum_lift_offs}; {extra}")
    if verdict.covered is not None:
        say(f"  {verdict.covered}")
    for line in (*verdict.feed_lines, *verdict.notes):
        say(f"  {line}")


_Said = TypeVar("_Said", SolutionVerdict, TrajectoryVerdict, "Verdict")
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
    require_optimal: bool
    as_json: bool

    def opened(self, deadline: Deadline) -> Subject:
        """The subject; one from standard input lies beside no other file."""
        if self.subject != STANDARD_INPUT:
            subject = read_subject(find_file(self.subject), deadline, self.tolerance)
        else:
            with input_file(STANDARD_INPUT) as copy:
                subject = replace(read_subject(copy, deadline), path=None)
        return subject.left_alone(self.left_alone)


def check_files(request: Request) -> Exit:
    """Say whether a claim is valid, and what its numbers are."""
    late, form = (request.subject, "surface"), None
    try:
        with input_file(request.claim) as copy:
            claim = copy if request.claim == STANDARD_INPUT else find_claim(request.claim)
            form = format_of_claim(claim)  # anything else is read as a solution
            for option in ("cache", "require_optimal"):
                if getattr(request, option) and form != Plan.FORMAT:
                    message = f"goes with a plan; {name_of(request.claim)} is none"
                    raise InputError(None, f"--{option.replace('_', '-')}", message)
            if form == Trajectory.FORMAT:
                late = (request.claim, "verdict")
                return _check_trajectory(request, claim)
            with naming(name_of("-") if request.subject == STANDARD_INPUT else None):
                if form == Plan.FORMAT:
                    return _check_plan(request, claim)
                return _check_solution(request, claim)
    except OutOfTime:
        message = f"unknown: the time limit came before there was a {late[1]}; see --time-limit"
        return _no_verdict(request, InputError(name_of(late[0]), None, message), Exit.STOPPED)
    except CellcolorError as error:
        at = error if isinstance(error, InputError) else InputError(None, None, str(error))
        return _no_verdict(request, at, Exit.BAD_INPUT)


def _check_solution(request: Request, claim: Path) -> Exit:
    """Say what is known of a solution, and of the schemes that follow it in its file."""
    subject = request.opened(NEVER)

    from cellcolor.door.judging import check  # imports a solver

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
            segments = count(scheme.segments or 0, "segment")
            faults.append(f"has {segments}, the solution {solution.segments}")
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
    verdict = SolutionVerdict(
        file=request.claim,
        valid=not problems,
        problems=tuple(problems),
        segments=report.segments,
        lift_offs=None if report.segments is None else lift_offs_of(report.segments),
        status=solution.status,
        solver=solution.solver,
        bounds=tuple(map(_checked, report.bounds)),
        bounds_by_solver=sum(found.trusted for found in report.bounds),
        claimed=claimed,
        schemes=schemes or None,
    )
    return _told(request, verdict, verdict.to_document(), say_solution)


def _checked(found: BoundVerdict) -> CheckedBound:
    bound = found.bound
    outcome = found.outcome, found.reason, found.tried, found.budget
    return CheckedBound(bound.kind, bound.value, bound.holds_for, *outcome)


def _check_plan(request: Request, claim: Path) -> Exit:
    """Say what is known of a plan."""
    subject = request.opened(request.deadline)
    if not subject.names_surface:
        if subject.path is None and subject.given_instance is not None:
            raise InputError(None, "surface", subject.why_no_surface)
        names = f"{request.subject} names none"
        message = f"is a plan, which goes with a labelled surface; {names}"
        raise InputError(name_of(request.claim), "format", message)
    if request.cache is not None:
        is_folder_or_nothing(request.cache)

    from cellcolor.door.oracle import Oracle

    oracle = Oracle(subject, time_limit=request.seconds, cache=request.cache)
    found = oracle.judge(claim, deadline=request.deadline)
    code = _told(request, found, _described(request.claim, found).to_document(), say_plan)
    if code is Exit.INVALID or not request.require_optimal or found.optimal:
        return code
    return Exit.STOPPED if found.optimal is None else Exit.INVALID


def _described(name: str, verdict: Verdict) -> PlanVerdict:
    bounds, segments, better = verdict.bounds, verdict.segments, verdict.improvement
    alike = ("valid", "problems", "segments", "lift_offs", "optimal", "beatable_by", "on_mesh")
    improvement = None
    if better is not None and segments is not None:
        colors = better.better.on_mesh.vertex_colors
        improvement = PlanImprovement(
            *(better.joined, better.places, better.segments, better.segments_on_mesh),
            vertex_colors=colors if better.segments_on_mesh < segments else None,
        )
    return PlanVerdict(
        file=name,
        text=str(verdict),
        violation_count=len(verdict.violations),
        violations=tuple(
            PlanViolation(found.vertex, found.color, found.place, found.reason)
            for found in verdict.violations[:_VIOLATIONS]
        ),
        lower_bound=None if bounds is None else bounds.lower,
        upper_bound=None if bounds is None else bounds.upper,
        gap=None if bounds is None or segments is None else segments - bounds.lower,
        improvement=improvement,
        why=verdict.why,
        kept_lower_bound=verdict.kept_lower,
        **{member: getattr(verdict, member) for member in alike},
    )


def _check_trajectory(request: Request, claim: Path) -> Exit:
    from cellcolor.door.judging import judge_trajectory

    given = read_claim(claim, (Trajectory,))
    name = name_of(request.claim)
    with naming(name):
        subject = request.opened(request.deadline)
        with at_work(Path(name), "judging") as report:
            verdict = judge_trajectory(subject, given, request.deadline, report)
    document = {"file": request.claim} | verdict.to_document()
    return _told(request, verdict, document, say_trajectory)


def _told(
    request: Request, verdict: _Said, document: dict[str, Any], say_it: Callable[[str, _Said], None]
) -> Exit:
    """Print a verdict, as JSON or in lines."""
    if request.as_json:
        print_json(document)
    else:
        say_it(name_of(request.claim), verdict)
    return Exit.DONE if verdict.valid else Exit.INVALID


def _no_verdict(request: Request, why: InputError, code: Exit) -> Exit:
    """Say why there is no verdict: on standard error, and as JSON where that was asked for."""
    complain(why)
    if request.as_json:
        number: Literal[2, 3] = 3 if code is Exit.STOPPED else 2
        error = CheckError(request.claim, None, str(why), why.file, why.field, number)
        print_json(error.to_document())
    return code
