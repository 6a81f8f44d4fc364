"""``cellcolor paint``: a solution as one color for each vertex of a surface."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from cellcolor.cli.exits import Exit
from cellcolor.cli.inputs import read_subject
from cellcolor.cli.painted_files import check_painted, write_painted
from cellcolor.cli.terminal import complain, say
from cellcolor.data.solution import Solution
from cellcolor.data.wording import count, listed
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import InputError

if TYPE_CHECKING:
    from cellcolor.painting.border_report import BorderReport
    from cellcolor.painting.paint import Painted


def paint_files(
    source: Path, claim: Path, output: Path, tool_radius: float | None, deadline: Deadline
) -> Exit:
    """Write a painted surface, and its plan beside it.

    Args:
        source: a labelled surface, a scene, or an instance that names its surface.
        claim: a solution of it.
        output: the surface's file, with the ending ``.surface.json``.
        tool_radius: of the tool's footprint, m; None for what ``cellcolor.paint`` takes.
        deadline: when to give up.
    """
    inputs = [source, claim]
    plan_path = check_painted(output, inputs)
    solution = Solution.read(claim)
    if tool_radius is not None and not 0 < tool_radius < math.inf:
        raise InputError(None, "--tool-radius", "must be a positive number of meters")

    from cellcolor.door.painting import paint

    try:
        subject = read_subject(source, deadline)
        if subject.surface_path is not None:  # of an instance: what it names is read as well
            inputs.append(subject.surface_path)
        check_painted(output, inputs)
        painted = paint(subject, solution, tool_radius_m=tool_radius, time_limit=deadline)
    except OutOfTime:
        complain(f"{source}: not painted: the time limit came first; nothing is written")
        return Exit.STOPPED
    except InputError as error:
        raise error if error.file else error.in_file(str(claim)) from error
    write_painted(painted, output, inputs)
    added = len(painted.surface.vertices) - len(subject.surface.vertices)
    refined = f", {count(added, 'vertex', 'vertices')} added" if added else ""
    lift_offs = count(max(0, painted.segments - 1), "lift-off")
    say(f"wrote {output}: {count(painted.segments, 'segment')}, {lift_offs}{refined}")
    say(f"wrote {plan_path}")
    if painted.borders is not None:
        for line in _lines(painted.borders, painted.segments > 1):
            say(f"  {line}")
    for line in _answers(painted):
        say(f"  {line}")
    for group in painted.merged:
        say(f"  segments {listed(group)} of the solution touch in one color: painted, they are one")
    return Exit.DONE


def _lines(report: BorderReport, several: bool) -> Iterator[str]:
    """What is said of the borders of a painting, if it has any."""
    before, after = report.before, report.after
    if not several:
        return
    yield f"borders: {after.length_m:.4g} m, {before.length_m:.4g} m as first drawn"
    if after.narrowest is not None:
        x, y, z = after.narrowest.place
        width, number = after.narrowest.width_m, after.narrowest.segment
        place = f"({x:.4g}, {y:.4g}, {z:.4g})"
        yield f"narrowest corridor: {width:.4g} m at {place}, of segment {number}"
    tool = f"a footprint of radius {report.tool_radius_m:.4g} m"
    if report.stays_inside:
        yield f"{tool} stays inside its segments"
    else:
        places = f", {count(after.narrow, 'corridor')} too narrow" if after.narrow else ""
        yield f"{tool} passes over {after.repeated_m2:.3g} m² of other segments{places}"


def _answers(painted: Painted) -> Iterator[str]:
    """What the scene has said of a painting, where it was asked and has refused something."""
    if len(painted.minima) > 1:
        yield f"the scene rejects copied colors: {count(painted.minima[0], 'segment')} as solved,"
        yield f"{painted.segments} after solving again with the true colors of the refined surface"
    if painted.refused:
        refused = count(len(painted.refused), "vertex", "vertices")
        first = painted.refused[0]
        yield f"the scene refuses {refused} of the painting all the same, {first} first"
