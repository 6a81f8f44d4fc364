"""The commands on meshes of parts: ``inspect`` and ``repair``."""

from __future__ import annotations

import time
from pathlib import Path

import click

from cellcolor.cli.commands.group import cellcolor
from cellcolor.cli.commands.options import METRES, PATH, TIME_LIMIT

_PART = click.argument("part", metavar="PART.(stl|obj|ply)", type=PATH)
_UNIT = click.option(
    "--unit",
    type=click.Choice(["m", "mm"]),
    help="Unit of the coordinates.  [default: guessed from the size]",
)
_JSON = click.option("--json", "as_json", is_flag=True, help="One JSON object.")


@cellcolor.command()
@_PART
@_UNIT
@click.option(
    "-o",
    "--output",
    metavar="OUT.(html|png|svg)",
    type=PATH,
    help="A picture with the faulty places marked.",
)
@TIME_LIMIT
@_JSON
def inspect(
    part: Path, unit: str | None, output: Path | None, time_limit: float | None, as_json: bool
) -> int:
    """Look a part's mesh through: its size, and what is wrong with it.

    Says why a scene would refuse it, and what repair would do about that. Nothing is changed.
    """
    begun = time.monotonic()

    from cellcolor.cli.parts import inspect_part
    from cellcolor.deadline import Deadline

    return inspect_part(part, unit, output, Deadline.after(time_limit, begun), as_json)


@cellcolor.command()
@_PART
@_UNIT
@click.option("-o", "--output", metavar="MESH.obj", required=True, type=PATH, help="The mesh.")
@click.option(
    "--fill-holes", metavar="M", type=METRES, help="Fill holes whose border is at most this long."
)
@click.option(
    "--least-component",
    metavar="SHARE",
    type=click.FloatRange(0, 1),
    default=0.01,
    show_default=True,
    help="Drop components smaller than this share of the largest one's area.",
)
@click.option(
    "--edge-length", metavar="M", type=METRES, help="Remesh to edges of about this length."
)
@TIME_LIMIT
@_JSON
def repair(
    part: Path,
    unit: str | None,
    output: Path,
    fill_holes: float | None,
    least_component: float,
    edge_length: float | None,
    time_limit: float | None,
    as_json: bool,
) -> int:
    """Repair a part's mesh, so that a scene can use it, or say why that cannot be done.

    Lengths are in metres; the mesh keeps the unit of its coordinates. What was changed is listed.
    """
    begun = time.monotonic()

    from cellcolor.cli.parts import repair_part
    from cellcolor.deadline import Deadline

    return repair_part(
        part,
        unit,
        output,
        fill_holes or 0.0,
        least_component,
        edge_length,
        Deadline.after(time_limit, begun),
        as_json,
    )


@cellcolor.command()
@_PART
@click.argument("arm", metavar="ARM.urdf", type=PATH)
@click.option(
    "-o",
    "--output",
    metavar="FOLDER",
    required=True,
    type=PATH,
    help="Folder for the files; it is created if it does not exist.",
)
@click.option(
    "--tool",
    metavar="TOOL.urdf",
    type=PATH,
    help="The tool, its root fixed to the flange.  [default: a polisher of 100 mm is written]",
)
@click.option("--tip-link", metavar="LINK", default="tip", show_default=True, help="Of the tool.")
@_UNIT
@TIME_LIMIT
def new(
    part: Path,
    arm: Path,
    output: Path,
    tool: Path | None,
    tip_link: str,
    unit: str | None,
    time_limit: float | None,
) -> int:
    """Begin with a part and an arm: write a scene and a setup, ready to plan.

    The arm has six turning joints. Its family and flange, links that always overlap, a place where
    most of the part can be reached and a free home position are found out, and every key is
    explained.
    """
    begun = time.monotonic()

    from cellcolor.cli.new import begin_scene
    from cellcolor.deadline import Deadline

    deadline = Deadline.after(time_limit, begun)
    return begin_scene(part, arm, output, tool, tip_link, unit, deadline)
