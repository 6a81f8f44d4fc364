"""Meshes of parts: ``inspect``, ``repair`` and ``new``."""

from __future__ import annotations

import math
import re
from contextlib import suppress
from pathlib import Path
from typing import Any

import click

from cellcolor.cli.ending import Exit
from cellcolor.cli.options import (
    LENGTH,
    PATH,
    SHARE,
    TIME_LIMIT,
    cellcolor,
    json_option,
    keywords,
    option,
    output_option,
)
from cellcolor.cli.terminal import at_work, print_json, say, say_lines
from cellcolor.errors import InputError
from cellcolor.files.writing import FileKind, Output, check_output, write

_PART = click.argument("part", metavar="PART.(stl|obj|ply)", type=PATH)
_UNIT = keywords(unit=click.Choice(["m", "mm", "cm", "in"]))
_JSON = json_option("One JSON object.")


def _fixed(text: str) -> tuple[str, float]:
    """``rail_joint=0.4``: a joint and its position."""
    joint, _, position = text.rpartition("=")
    with suppress(ValueError):
        if joint and math.isfinite(float(position)):
            return joint, float(position)
    raise click.BadParameter(f"{text!r} is not JOINT=POSITION, as rail_joint=0.4")


@cellcolor.command(of=("door.parts:inspect",))
@_PART
@_UNIT
@output_option("OUT.(html|png|svg)", "A picture with the faulty places marked.")
@TIME_LIMIT
@_JSON
def inspect(part: Path, output: Path | None, as_json: bool, **wanted: Any) -> Exit:
    """Look a part's mesh through: its size, and what is wrong with it.

    Says why a scene would refuse it, and what repair would do about that. Nothing is changed.
    """
    from cellcolor.door import parts
    from cellcolor.door.drawing import Drawing, kind_of_picture

    if output is not None:
        check_output(output, kind_of_picture(output), [part])
    with at_work(part, "inspecting") as tell:
        found = parts.inspect(part, progress=tell, **wanted)
    if as_json:
        print_json(found.to_dict())
    else:
        say_lines(found)
    if output is not None:
        from cellcolor.pictures.mesh_picture import faulty_part

        Drawing(faulty_part(found)).save(output)
        if not as_json:
            say(f"wrote {output}")
    return Exit.DONE


@cellcolor.command(of=("door.parts:repair",))
@_PART
@_UNIT
@output_option("MESH.obj", "The mesh.", required=True)
@option("--fill-holes", LENGTH, to="fill_holes_m")
@keywords(least_component=SHARE)
@option("--edge-length", LENGTH, to="edge_length_m")
@TIME_LIMIT
@_JSON
def repair(part: Path, output: Path, as_json: bool, **wanted: Any) -> Exit:
    """Repair a part's mesh, so that a scene can use it, or say why that cannot be done.

    Lengths are in metres; the mesh keeps the unit of its coordinates. What was changed is listed.
    """
    from cellcolor.door import parts

    kind = FileKind("a mesh repaired by cellcolor", re.compile(rb"# repaired by cellcolor\n"))
    if output.suffix != ".obj":
        raise InputError(str(output), None, "must end in .obj")
    check_output(output, kind, [part])
    with at_work(part, "repairing") as tell:
        made = parts.repair(part, progress=tell, **wanted)
        tell("writing")
        content = made.to_obj().encode()
    write([Output(output, kind, [content])], [part])
    if as_json:
        print_json(made.to_dict())
    else:
        say_lines(made)
        say(f"wrote {output}, meters_per_unit = {made.meters_per_unit:g}")
    return Exit.DONE


@cellcolor.command(of=("door.starting:new",))
@_PART
@click.argument("arm", metavar="ARM.urdf", type=PATH)
@output_option("FOLDER", "Folder for the files; it is created if it does not exist.", required=True)
@keywords(tool=PATH, tip_link=str)
@_UNIT
@keywords(outside=click.Choice(["toward", "away", "flip"]), cover=click.Choice(["largest", "all"]))
@option(
    "--fix",
    _fixed,
    "Where a joint stands still, rad, or m of a rail. May be given several times.  [default: rails "
    "and joints beside the chain at 0]",
    metavar="JOINT=POSITION",
    multiple=True,
)
@TIME_LIMIT
def new(
    part: Path, arm: Path, output: Path, fix: tuple[tuple[str, float], ...], **wanted: Any
) -> Exit:
    """Begin with a part and an arm: write a scene and a setup, ready to plan.

    The arm has six turning joints. Its family and flange, links that always overlap, a place where
    most of the part can be reached and a free home position are found out, and every key is
    explained. What was assumed is printed.
    """
    from cellcolor.door.starting import new as begin

    with at_work(part, "beginning") as tell:
        made = begin(part, arm, output, fix=dict(fix), progress=tell, **wanted)
    say(f"wrote {made.scene} and its setup: {made.reachable_share:.0%} of the part can be reached")
    for note in made.notes:
        say(f"  {note}")
    say(f"next: cellcolor plan {made.scene} -o {made.scene.parent / 'plan'}")
    return Exit.DONE
