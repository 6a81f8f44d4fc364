"""Joint solutions without a robot: ``label``."""

from __future__ import annotations

from pathlib import Path

import click

from cellcolor.cli.ending import INTERRUPTS, Exit
from cellcolor.cli.options import METRES, PATH, cellcolor, option, output_option, shared
from cellcolor.cli.progress import at_work
from cellcolor.cli.terminal import apart_from, say, say_lines
from cellcolor.deadline import Deadline
from cellcolor.files.writing import Output, check_output, kind_of_format, write


@cellcolor.command()
@click.argument("source", metavar="JOINTS.(npz|json|csv)", type=PATH)
@output_option("SURFACE.json", "The labelled surface.", required=True)
@option("--mesh", PATH, "The mesh of a CSV file, in m.", metavar="MESH.(obj|ply|stl)")
@click.option("--cut", is_flag=True, help="Cut colors that have two solutions of a vertex.")
@option("--reach", METRES, "The arm's reach; a part far larger is refused.")
@shared("time_limit")
def label(
    source: Path,
    output: Path,
    mesh: Path | None,
    cut: bool,
    reach: float | None,
    time_limit: Deadline,
) -> Exit:
    """Make a labelled surface of joint solutions at the vertices of a mesh, without a robot.

    Solutions of neighboring vertices that are clearly the nearest to each other belong to one
    color. What is doubtful is listed.
    """
    from cellcolor.data.surface import LabelledSurface
    from cellcolor.door.labelling import label as labelled

    check_output(output, kind_of_format(LabelledSurface.FORMAT), [source, *filter(None, [mesh])])
    with at_work(source, "matching", "not labelled: the time limit came first"):
        found = labelled(
            source,
            mesh=mesh,
            conflicts="cut" if cut else "refuse",
            reach_m=reach,
            deadline=time_limit,
        )
    INTERRUPTS.check()
    with apart_from(output):
        say_lines(found)
        write([Output.of(output, found.surface)], [source])
        say(f"wrote {output}")
    return Exit.DONE
