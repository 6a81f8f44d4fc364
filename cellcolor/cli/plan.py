"""``cellcolor plan``: from a scene to a judged motion, its files and its page."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cellcolor.cli.exits import Exit
from cellcolor.cli.inputs import with_tolerance
from cellcolor.cli.interrupts import INTERRUPTS
from cellcolor.cli.progress import stages_of
from cellcolor.cli.terminal import complain, say
from cellcolor.data.wording import count
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.door.leaving_out import Wanted
from cellcolor.door.plan_files import KINDS, check_folder
from cellcolor.door.subject import Subject
from cellcolor.door.unfinished import NothingCovered, PlanOutOfTime, UnfinishedPlan
from cellcolor.errors import InputError

_SHOWN = 5  # faults


def plan_scene(
    scene: Path,
    folder: Path,
    pattern: str,
    wanted: Wanted,
    tolerance: str | None,
    ask: tuple[str, ...],
    motion: Mapping[str, Any],
    deadline: Deadline,
) -> Exit:
    """Plan, judge and write everything to a folder.

    Args:
        scene: the scene's file.
        folder: where all files go; made where it does not exist.
        pattern: of the tool paths.
        wanted: what has to be covered.
        tolerance: of the scene's part.
        ask: what the page is to tell besides.
        motion: keys of the setup's table ``[motion]``, which they replace.
        deadline: when to give up.
    """
    check_folder(folder, [scene])

    from cellcolor.door.planning import plan

    INTERRUPTS.check()
    try:
        with stages_of(scene, "planning") as report:
            planned = plan(
                scene if tolerance is None else with_tolerance(scene, tolerance),
                pattern=pattern,
                cover=wanted.cover,
                required=wanted.required,
                left_alone=wanted.left_alone,
                ask=ask,
                time_limit=deadline,
                progress=report,
                **motion,
            )
            report("files and page")
            begun = time.perf_counter()
            planned.save(folder)
            stages = {**planned.seconds, "files and page": time.perf_counter() - begun}
    except PlanOutOfTime as error:
        return _unfinished(scene, folder, error.unfinished)
    except OutOfTime:
        complain(
            f"{scene}: not planned: the time limit came before the topological graph was known"
        )
        return Exit.STOPPED
    except NothingCovered as error:
        for line in str(error.report).split("\n"):
            say(line)
        raise
    except InputError as error:
        raise error if error.file else error.in_file(str(scene)) from error
    INTERRUPTS.check()
    _warn(scene, planned.subject)
    for line in str(planned).split("\n"):
        say(line)
    verdict = planned.verdict
    for fault in verdict.faults[:_SHOWN]:
        say(f"  {fault}")
    spent = ", ".join(f"{stage} {seconds:.2f}" for stage, seconds in stages.items())
    say(f"seconds  {sum(stages.values()):.2f}: {spent}")
    say(f"wrote {count(len(KINDS), 'file')} to {folder}: look at {folder / 'report.html'}")
    if set(verdict.fault_counts) - {"unplanned"}:
        return Exit.INVALID
    proved = planned.solution.status == "optimal"
    return Exit.DONE if verdict.valid and proved else Exit.STOPPED


def _unfinished(scene: Path, folder: Path, unfinished: UnfinishedPlan) -> Exit:
    """Write what there is when the time limit came, and say what is missing."""
    _warn(scene, unfinished.subject)
    complain(f"{scene}: not planned to the end: {unfinished.missing}")
    try:
        written = unfinished.save(folder)
    except InputError as error:
        complain(f"nothing is written: {error}")
        return Exit.STOPPED
    if unfinished.result is not None:
        say(str(unfinished.result))
    say(f"wrote {count(len(written), 'file')} to {folder}: look at {folder / 'report.html'}")
    return Exit.STOPPED


def _warn(scene: Path, subject: Subject) -> None:
    for warning in subject.warnings:
        complain(f"{scene}: warning: {warning}")
