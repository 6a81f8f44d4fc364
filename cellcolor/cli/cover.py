"""``cellcolor cover``: a painted surface as tool paths."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from cellcolor.cli.exits import Exit
from cellcolor.cli.progress import stages_of
from cellcolor.cli.terminal import complain, say
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.wording import count
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import InputError
from cellcolor.files.writing import Output, check_output, kind_of_format, write

if TYPE_CHECKING:
    from cellcolor.tool_paths.cover import Covered

_PATHS = kind_of_format(ToolPaths.FORMAT)


def cover_files(
    source: Path,
    plan: Path,
    output: Path,
    pattern: str,
    spacing_m: float,
    tool_radius_m: float,
    deadline: Deadline,
) -> Exit:
    """Write tool paths.

    Args:
        source: a labelled surface.
        plan: one color for each of its vertices.
        output: the file of the paths.
        pattern: the name of a pattern.
        spacing_m: wanted between passes, m.
        tool_radius_m: of the tool's footprint, m.
        deadline: when to give up.
    """
    inputs = [source, plan]
    check_output(output, _PATHS, inputs)
    surface, colors = LabelledSurface.read(source), Plan.read(plan)

    from cellcolor.door.covering import cover as cover_surface

    try:
        with stages_of(source, "covering") as report:
            found = cover_surface(
                surface,
                colors,
                pattern=pattern,
                spacing_m=spacing_m,
                tool_radius_m=tool_radius_m,
                time_limit=deadline,
                progress=report,
            )
    except OutOfTime:
        complain(f"{source}: not covered: the time limit came first; nothing is written")
        return Exit.STOPPED
    except InputError as error:
        raise error if error.file or error.field else error.in_file(str(plan)) from error
    write([Output(output, _PATHS, [found.paths.to_json().encode()])], inputs)
    say(f"wrote {output}: {found}")
    _say_each(found)
    return Exit.DONE


def _say_each(found: Covered) -> None:
    """A line for each path, and one for what is left uncovered."""
    for path, measures in zip(found.paths.paths, found.measures, strict=True):
        say(f"  segment {path.segment}: {measures}")
    for place in found.uncovered[:3]:
        say(f"  uncovered: {place}")
    more = len(found.uncovered) - 3
    if more > 0:
        say(f"  and {count(more, 'smaller place')}")
