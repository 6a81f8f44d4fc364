"""From a solution to a motion: ``paint``, ``cover`` and ``plan``."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cellcolor.cli.ending import Exit
from cellcolor.cli.options import (
    INPUT,
    LEFT_ALONE,
    LENGTH,
    PATH,
    SHARE,
    TIME_LIMIT,
    TOLERANCE,
    Numbers,
    Real,
    cellcolor,
    keywords,
    option,
    output_option,
)
from cellcolor.cli.terminal import at_work, complain, say, say_lines
from cellcolor.data.wording import count, listed, segments_and_lift_offs
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import InputError, naming
from cellcolor.files.writing import Output, check_output, is_stream, kind_of_format, write

if TYPE_CHECKING:
    from cellcolor.door.planned import UnfinishedPlan
    from cellcolor.painting.paint import Painted

_ENDING = ".surface.json"
_FAULTS = 5  # that plan prints
_SAID = (
    *("frontend.setup:Motion", "door.planning:plan"),
    *("door.asked:SearchOfAPart", "door.painting:cover"),
)
_JOINTS = Numbers("must be numbers N,N,…")


@cellcolor.command()
@click.argument("source", metavar="FILE", type=INPUT)
@click.argument("claim", metavar="SOLUTION.json", type=PATH)
@output_option(
    "OUT.surface.json",
    "The painted surface; its plan is written beside it as OUT.plan.json.",
    required=True,
)
@TIME_LIMIT
def paint(source: Path, claim: Path, output: Path, time_limit: Deadline) -> Exit:
    """Paint every vertex of a surface in the colors of a solution.

    FILE is a labelled surface, a scene, or an instance that names its surface. Where a cell is
    divided and its mesh is too coarse for that, the surface is refined. Borders between segments
    are then moved, so that they are short.
    """
    from cellcolor.cli.inputs import read_subject
    from cellcolor.data.solution import Solution
    from cellcolor.door.painting import paint as painted_of

    inputs = [source, claim]
    plan_path = check_painted(output, inputs)
    solution = Solution.read(claim)
    subject = read_subject(source, time_limit)
    if subject.surface_path is not None:  # of an instance: what it names is read as well
        inputs.append(subject.surface_path)
    check_painted(output, inputs)
    with at_work(source, "painting"), naming(claim):
        painted = painted_of(subject, solution, time_limit=time_limit)
    write([Output.of(plan_path, painted.plan), Output.of(output, painted.surface)], inputs)
    added = len(painted.surface.vertices) - len(subject.surface.vertices)
    refined = f", {count(added, 'vertex', 'vertices')} added" if added else ""
    say(f"wrote {output}: {segments_and_lift_offs(painted.segments)}{refined}")
    say(f"wrote {plan_path}")
    for line in _about(painted):
        say(f"  {line}")
    return Exit.DONE


def _about(painted: Painted) -> Iterator[str]:
    """What a scene refused of a painting, and segments that are one on the mesh."""
    if len(painted.minima) > 1:
        yield f"the scene rejects copied colors: {count(painted.minima[0], 'segment')} as solved,"
        yield f"{painted.segments} after solving again with the true colors of the refined surface"
    if painted.refused:
        refused = count(len(painted.refused), "vertex", "vertices")
        first = painted.refused[0]
        yield f"the scene refuses {refused} of the painting all the same, {first} first"
    for group in painted.merged:
        yield f"segments {listed(group)} of the solution touch in one color: painted, they are one"


def check_painted(output: Path, inputs: Sequence[Path]) -> Path:
    """Refuse a place where a painting cannot be written; returns that of its plan.

    Args:
        output: the surface's file, with the ending ``.surface.json``.
        inputs: files that the same command reads.

    Raises:
        InputError: with the reason.
    """
    from cellcolor.data.plan import Plan
    from cellcolor.data.surface import LabelledSurface

    if not output.name.endswith(_ENDING) or is_stream(output):
        raise InputError(str(output), None, f"must be a file with the ending {_ENDING}")
    plan_path = output.with_name(output.name.removesuffix(_ENDING) + ".plan.json")
    check_output(output, kind_of_format(LabelledSurface.FORMAT), inputs)
    check_output(plan_path, kind_of_format(Plan.FORMAT), inputs)
    return plan_path


@cellcolor.command(of=("door.painting:cover",))
@click.argument("source", metavar="SURFACE.json", type=INPUT)
@click.argument("plan", metavar="PLAN.json", type=PATH)
@keywords(pattern=str)
@option("--spacing-m", LENGTH, required=True)
@option("--tool-radius-m", LENGTH, required=True)
@output_option("PATHS.json", "The paths.", required=True)
@TIME_LIMIT
def cover(source: Path, plan: Path, output: Path, **wanted: Any) -> Exit:
    """Lay a tool path on every segment of a painted surface, without a robot.

    SURFACE.json and PLAN.json are what paint writes. Each segment is covered without lifting off.
    """
    from cellcolor.data.plan import Plan
    from cellcolor.data.surface import LabelledSurface
    from cellcolor.data.tool_paths import ToolPaths
    from cellcolor.door.painting import cover as covered_of

    inputs = [source, plan]
    check_output(output, kind_of_format(ToolPaths.FORMAT), inputs)
    surface, colors = LabelledSurface.read(source), Plan.read(plan)
    with at_work(source, "covering") as tell, naming(plan):
        found = covered_of(surface, colors, progress=tell, **wanted)
    write([Output.of(output, found.paths)], inputs)
    say(f"wrote {output}: {found}")
    for path, measures in zip(found.paths.paths, found.measures, strict=True):
        say(f"  segment {path.segment}: {measures}")
    for place in found.uncovered[:3]:
        say(f"  uncovered: {place}")
    if (more := len(found.uncovered) - 3) > 0:
        say(f"  and {count(more, 'smaller place')}")
    return Exit.DONE


@cellcolor.command(of=_SAID)
@click.argument("scene", metavar="SCENE.toml", type=INPUT)
@output_option("FOLDER", "Folder for all files; it is created if it does not exist.", required=True)
@keywords(pattern=str, cover=SHARE)
@LEFT_ALONE
@TOLERANCE
@option("--ask", str, metavar="QUESTION", multiple=True)
@option(
    "--export-step",
    Real(0.001, 0.5),
    "The fixed time step of the files for controllers, s. By default they have the samples of the "
    "trajectory or via points, and a UR arm's program has 0.008 s.",
)
@TIME_LIMIT
@keywords(tool_radius_m=float, spacing_m=float, overlap_m=float, speed_m_per_s=float)
@keywords(lead_m=float, approach_speed_m_per_s=float, transfer_speed_m_per_s=float)
@keywords(even_feed=bool, least_feed=float, joint_velocities_rad_per_s=_JOINTS)
@keywords(joint_accelerations_rad_per_s2=_JOINTS, joint_jerks_rad_per_s3=_JOINTS)
@keywords(retract_m=float, clearance_m=float)
@keywords(home_rad=Numbers("must be numbers N,N,… or free", word="free"))
def plan(
    scene: Path, output: Path, tolerance: str | None, export_step: float | None, **wanted: Any
) -> Exit:
    """Plan a motion over a scene's object with the fewest lift-offs, and have it judged.

    FOLDER gets the proof, the painted surface, tool paths, the trajectory, the verdict on it, files
    for other programs, and report.html to look at. The options below --time-limit replace keys of
    the setup's table [motion].
    """
    from cellcolor.cli.inputs import warn_of, with_tolerance
    from cellcolor.door.planned import NothingCovered, PlanOutOfTime, check_folder
    from cellcolor.door.planning import plan as planned_of

    check_folder(output, [scene])
    try:
        with at_work(scene, "planning") as report:
            planned = planned_of(with_tolerance(scene, tolerance), progress=report, **wanted)
            report("files and page")
            begun = time.perf_counter()
            written = planned.save(output, export_step)
            stages = {**planned.seconds, "files and page": time.perf_counter() - begun}
    except NothingCovered as error:
        say_lines(error.report)
        raise
    except OutOfTime as end:
        if isinstance(end.__cause__, PlanOutOfTime):
            return _unfinished(scene, output, end.__cause__.unfinished)
        raise
    warn_of(scene, planned.subject)
    say_lines(planned)
    verdict = planned.verdict
    for fault in verdict.faults[:_FAULTS]:
        say(f"  {fault}")
    spent = ", ".join(f"{stage} {seconds:.2f}" for stage, seconds in stages.items())
    say(f"seconds  {sum(stages.values()):.2f}: {spent}")
    say(f"wrote {count(len(written), 'file')} to {output}: look at {output / 'report.html'}")
    if set(verdict.fault_counts) - {"unplanned"}:
        return Exit.INVALID
    whole = verdict.valid and planned.solution.status == "optimal" and planned.complete
    return Exit.done_if(whole)


def _unfinished(scene: Path, folder: Path, unfinished: UnfinishedPlan) -> Exit:
    """Write what there is when the time limit came, and say what is missing."""
    from cellcolor.cli.inputs import warn_of

    warn_of(scene, unfinished.subject)
    complain(f"{scene}: not planned to the end: {unfinished.missing}")
    for line in unfinished.unanswered:
        complain(f"{scene}: {line}")
    try:
        written = unfinished.save(folder)
    except InputError as error:
        raise OutOfTime(f"nothing is written: {error}") from error
    if unfinished.result is not None:
        say(str(unfinished.result))
    say(f"wrote {count(len(written), 'file')} to {folder}: look at {folder / 'report.html'}")
    return Exit.STOPPED
