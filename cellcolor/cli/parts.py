"""``cellcolor inspect`` and ``cellcolor repair``: meshes of parts."""

from __future__ import annotations

import re
from pathlib import Path

from cellcolor.cli.exits import Exit
from cellcolor.cli.interrupts import INTERRUPTS
from cellcolor.cli.progress import stages_of
from cellcolor.cli.terminal import apart_from, complain, print_json, say
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.door.drawing import kind_of_picture
from cellcolor.door.parts import draw_inspection, inspect, repair
from cellcolor.errors import InputError
from cellcolor.files.writing import FileKind, Output, check_output, write

_OBJ = FileKind("a mesh repaired by cellcolor", re.compile(rb"# repaired by cellcolor\n"))


def inspect_part(
    part: Path, unit: str | None, picture: Path | None, deadline: Deadline, as_json: bool
) -> Exit:
    """Print what a part has and what is wrong with it, and draw it if asked.

    Args:
        part: a mesh file.
        unit: of it; None for the likely one.
        picture: where the picture goes.
        deadline: when to give up.
        as_json: one JSON object instead of lines.
    """
    kind = None if picture is None else kind_of_picture(picture)
    if picture is not None and kind is not None:
        check_output(picture, kind, [part])
    try:
        with stages_of(part, "inspecting") as tell:
            found = inspect(part, unit=unit, time_limit=deadline, progress=tell)
            drawn = None
            if picture is not None:
                tell("drawing")
                drawn = draw_inspection(found).render(picture.suffix)
    except OutOfTime:
        complain(f"{part}: not inspected: the time limit came first")
        return Exit.STOPPED
    INTERRUPTS.check()
    with apart_from(picture):
        if as_json:
            print_json(found.to_dict())
        else:
            for line in str(found).split("\n"):
                say(line)
        if picture is not None and kind is not None and drawn is not None:
            write([Output(picture, kind, [drawn])], [part])
            if not as_json:
                say(f"wrote {picture}")
    return Exit.DONE


def repair_part(
    part: Path,
    unit: str | None,
    output: Path,
    fill_holes: float,
    least_component: float,
    edge_length: float | None,
    deadline: Deadline,
    as_json: bool,
) -> Exit:
    """Write a repaired mesh, and print what was changed.

    Args:
        part: a mesh file.
        unit: of it; None for the likely one.
        output: an OBJ file.
        fill_holes: the longest border of a hole that is filled, m.
        least_component: share of the largest component's area below which one is dropped.
        edge_length: wanted, m; None leaves the edges.
        deadline: when to give up.
        as_json: one JSON object instead of lines.
    """
    if output.suffix != ".obj":
        raise InputError(str(output), None, "must end in .obj")
    check_output(output, _OBJ, [part])
    try:
        with stages_of(part, "repairing") as tell:
            made = repair(
                part,
                unit=unit,
                fill_holes_m=fill_holes,
                least_component=least_component,
                edge_length_m=edge_length,
                time_limit=deadline,
                progress=tell,
            )
            tell("writing")
            content = made.to_obj().encode()
    except OutOfTime:
        complain(f"{part}: not repaired: the time limit came first; nothing is written")
        return Exit.STOPPED
    INTERRUPTS.check()
    with apart_from(output):
        write([Output(output, _OBJ, [content])], [part])
        if as_json:
            print_json(made.to_dict())
        else:
            for line in str(made).split("\n"):
                say(line)
            say(f"wrote {output}, meters_per_unit = {made.meters_per_unit:g}")
    return Exit.DONE
