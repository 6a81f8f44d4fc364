"""``cellcolor check``: a solution or a plan against what it was made for, or a trajectory."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from cellcolor.checker.claimed_numbers import claims
from cellcolor.checker.division import check_scheme
from cellcolor.cli.exits import Exit
from cellcolor.cli.inputs import read_subject
from cellcolor.cli.progress import judge_progress_of
from cellcolor.cli.terminal import complain, print_json, say
from cellcolor.data import plan as plan_file
from cellcolor.data import trajectory as trajectory_file
from cellcolor.data.solution import SchemeKey, Solution, read_schemes, scheme_key
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.door.subject import Subject
from cellcolor.door.trajectories import format_of_claim, judge_trajectory, read_trajectory
from cellcolor.errors import InputError

_SHOWN = 3  # faults of each kind


def check_files(subject: Path, claim: Path, deadline: Deadline, as_json: bool) -> Exit:
    """Say whether a claim is valid, and what its numbers are.

    Args:
        subject: an instance, a labelled surface or a scene.
        claim: a solution of it, a plan on its surface, or a trajectory for the scene.
        deadline: when the proven range that a plan or a trajectory is compared with has to be
            there.
        as_json: one JSON object instead of lines.
    """
    form = format_of_claim(claim)  # anything else is read as a solution
    if form == trajectory_file.FORMAT:
        return _check_trajectory(subject, claim, deadline, as_json)
    is_plan = form == plan_file.FORMAT
    try:
        opened = read_subject(subject, deadline if is_plan else NEVER)
    except OutOfTime:
        message = f"{subject}: unknown: the time limit came before there was a surface"
        complain(message)
        if as_json:
            print_json({"file": str(claim), "error": message})
        return Exit.STOPPED
    if is_plan:
        if not opened.names_surface:
            message = f"is a plan, which goes with a labelled surface; {subject} names none"
            raise InputError(str(claim), "format", message)
        verdict = _check_plan(opened, claim, deadline)
    else:
        verdict = _check_solution(opened, claim)
    if as_json:
        print_json({"file": str(claim)} | verdict)
    else:
        _print(claim, verdict)
    return Exit.DONE if verdict["valid"] else Exit.INVALID


def _check_trajectory(subject: Path, claim: Path, deadline: Deadline, as_json: bool) -> Exit:
    given = read_trajectory(claim)
    try:
        opened = read_subject(subject, deadline)
        with judge_progress_of(claim) as report:
            verdict = judge_trajectory(opened, given, deadline, report)
    except InputError as error:
        raise error if error.file else error.in_file(str(claim)) from error
    except OutOfTime:
        message = f"{claim}: unknown: the time limit came before there was a verdict"
        complain(message)
        if as_json:
            print_json({"file": str(claim), "error": message})
        return Exit.STOPPED
    if as_json:
        print_json({"file": str(claim)} | json.loads(verdict.to_json()))
    else:
        _print_trajectory(claim, verdict)
    return Exit.DONE if verdict.valid else Exit.INVALID


def _print_trajectory(claim: Path, verdict: TrajectoryVerdict) -> None:
    said = count(sum(verdict.fault_counts.values()), "fault")
    say(f"{claim}: {'valid' if verdict.valid else f'not valid, {said}'}")
    for kind, number in verdict.fault_counts.items():
        first = verdict.of_kind(kind)[:_SHOWN]
        for fault in first:
            say(f"  {fault}")
        if number > len(first):
            say(f"  {kind}: {number - len(first)} more")
    seconds = "" if verdict.seconds is None else f", {verdict.seconds:.1f} s"
    tested = f"{count(verdict.samples, 'sample')}, {count(verdict.tested, 'configuration')} tested"
    say(f"  {count(verdict.strokes, 'stroke')}, {count(verdict.lift_offs, 'lift-off')}{seconds}")
    say(f"  {tested}")
    if verdict.minimum_lift_offs is not None:
        extra = f"{verdict.claimed_extra} more stated, {verdict.unclaimed_extra} more not stated"
        say(f"  fewest lift-offs on this surface, proved: {verdict.minimum_lift_offs}; {extra}")
    if verdict.covered is not None:
        say(f"  {verdict.covered}")
    for note in verdict.notes:
        say(f"  {note}")


def _check_solution(subject: Subject, claim: Path) -> dict[str, Any]:
    from cellcolor.door.judging import check

    instance, solution = subject.graph(), Solution.read(claim)
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
            faults.append("the same scheme stands in an earlier line")
        keys.add(key)
        problems += [f"scheme {schemes}: {fault}" for fault in faults]
    # A solution alone may count schemes that it does not list; a list has to be whole.
    if schemes and schemes != solution.schemes:
        problems.append(f"schemes: says {solution.schemes}, listed are {schemes}")
    verdict: dict[str, Any] = {
        "valid": not problems,
        "problems": problems,
        "segments": report.segments,
        "lift_offs": None if report.segments is None else max(0, report.segments - 1),
        "status": solution.status,
        "bounds": [
            {"kind": v.bound.kind, "value": v.bound.value, "outcome": v.outcome, "tried": v.tried}
            for v in report.bounds
        ],
        "claimed": claims(instance, solution, report.bounds) if report.valid else {},
    }
    return verdict | ({"schemes": schemes} if schemes else {})


def _check_plan(subject: Subject, claim: Path, deadline: Deadline) -> dict[str, Any]:
    from cellcolor.door.judging import judge_by

    verdict = judge_by(subject, claim, deadline)
    bounds = verdict.bounds
    return {
        "valid": verdict.valid,
        "problems": list(verdict.problems),
        "segments": verdict.segments,
        "lift_offs": verdict.lift_offs,
        "lower_bound": None if bounds is None else bounds.lower,
        "upper_bound": None if bounds is None else bounds.upper,
        "optimal": verdict.optimal,
        "beatable_by": verdict.beatable_by,
    }


def _print(claim: Path, verdict: dict[str, Any]) -> None:
    say(f"{claim}: {'valid' if verdict['valid'] else 'not valid'}")
    for problem in verdict["problems"]:
        say(f"  {problem}")
    if verdict["segments"] is not None:
        say(f"  {count(verdict['segments'], 'segment')}, {count(verdict['lift_offs'], 'lift-off')}")
    if "status" in verdict:
        say(f"  status {verdict['status']}")
    if "schemes" in verdict:
        say(f"  {count(verdict['schemes'], 'scheme')}")
    for bound in verdict.get("bounds", ()):
        if bound["outcome"] != "no certificate":
            say(f"  at least {bound['value']} by {bound['kind']}: {bound['outcome']}")
    if verdict.get("claimed"):
        claimed = (f"{name} {json.dumps(value)}" for name, value in verdict["claimed"].items())
        say(f"  claimed, not verified: {', '.join(claimed)}")
    if verdict.get("lower_bound") is not None:
        lower, upper = verdict["lower_bound"], verdict["upper_bound"]
        least = f"exactly {lower}" if lower == upper else f"between {lower} and {upper}"
        say(f"  fewest segments on this surface: {least}")
        if verdict["optimal"]:
            say("  optimal")
        elif verdict["beatable_by"]:
            say(f"  {verdict['beatable_by']} fewer are enough")
        else:
            say("  not known to be optimal, not known to be beatable")
