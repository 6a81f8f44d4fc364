"""``cellcolor show``: pictures of surfaces, graphs, solutions and the arm."""

from __future__ import annotations

from pathlib import Path

import click

from cellcolor.cli.exits import Exit
from cellcolor.cli.inputs import open_file
from cellcolor.cli.interrupts import INTERRUPTS
from cellcolor.cli.terminal import say
from cellcolor.data.plan import Plan
from cellcolor.door.claims import format_of_claim
from cellcolor.door.drawing import View, draw, kind_of_picture, picture_of
from cellcolor.door.extras import extras_for
from cellcolor.errors import InputError
from cellcolor.files.writing import Output, check_output, write


def show_files(
    files: tuple[Path, ...],
    output: Path,
    name: str,
    color: str | None,
    vertex: int | None,
    branch: str | None,
) -> Exit:
    """Draw one picture.

    Args:
        files: what to show, and its solution or a plan if there is a second one.
        output: the picture's file.
        name: of the picture; what else it is drawn of is in a ``View``.
    """
    kind = kind_of_picture(output)
    check_output(output, kind, files)
    claim = files[1] if len(files) > 1 else None
    if name == "segments" and claim is not None and format_of_claim(claim) == Plan.FORMAT:
        name = "plan"
    claims = {"plan" if name == "plan" else "solution": claim}
    view = View(name, color=color, vertex=vertex, branch=branch, **claims)
    with extras_for(files[0]):
        try:
            picture = picture_of(view)
        except InputError as error:  # what is wrong is an option, not a file
            raise click.UsageError(str(error)) from error
    subject = open_file(files[0])
    with extras_for(output):
        drawing = draw(picture, subject, view)
        content = drawing.render(output.suffix)
    INTERRUPTS.check()
    write([Output(output, kind, [content])], files)
    say(f"wrote {output}: {drawing}")
    return Exit.DONE
