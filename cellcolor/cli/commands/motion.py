"""The commands from a solution to a motion: ``paint``, ``cover`` and ``plan``."""

from __future__ import annotations

import time
from pathlib import Path

import click

from cellcolor.cli.commands.group import cellcolor
from cellcolor.cli.commands.motion_options import motion_options
from cellcolor.cli.commands.options import (
    COVER,
    INPUT,
    LEFT_ALONE,
    METRES,
    PATH,
    REQUIRED,
    TIME_LIMIT,
    TOLERANCE,
)
from cellcolor.tool_paths.registry import DEFAULT_PATTERN, PATTERNS, pattern_names


def _pattern_name(_context: click.Context, _option: click.Parameter, value: str) -> str:
    """Refuse a pattern that nobody has registered; none is imported for that."""
    known = pattern_names()
    if value not in known:
        raise click.BadParameter(f"{value!r} is not one of {', '.join(known)}.")
    return value


_PATTERN = click.option(
    "--pattern",
    metavar="NAME",
    callback=_pattern_name,
    default=DEFAULT_PATTERN,
    show_default=True,
    help=f"Pattern of the tool paths: {', '.join(PATTERNS)}, or what another package registers.",
)


@cellcolor.command()
@click.argument("source", metavar="FILE", type=INPUT)
@click.argument("claim", metavar="SOLUTION.json", type=PATH)
@click.option(
    "-o",
    "--output",
    metavar="OUT.surface.json",
    required=True,
    type=PATH,
    help="The painted surface; its plan is written beside it as OUT.plan.json.",
)
@click.option(
    "--tool-radius",
    metavar="M",
    type=float,
    help="Of the tool's footprint, m: corridors are made as wide as that where possible.  "
    "[default: the scene's, or one mean mesh edge]",
)
@TIME_LIMIT
def paint(
    source: Path, claim: Path, output: Path, tool_radius: float | None, time_limit: float | None
) -> int:
    """Paint every vertex of a surface in the colors of a solution.

    FILE is a labelled surface, a scene, or an instance that names its surface. Where a cell is
    divided and its mesh is too coarse for that, the surface is refined. Borders between segments
    are then moved, so that corridors are wide and borders short.
    """
    begun = time.monotonic()

    from cellcolor.cli.paint import paint_files
    from cellcolor.deadline import Deadline

    deadline = Deadline.after(time_limit, begun)
    return paint_files(source, claim, output, tool_radius, deadline)


@cellcolor.command()
@click.argument("source", metavar="SURFACE.json", type=INPUT)
@click.argument("plan", metavar="PLAN.json", type=PATH)
@_PATTERN
@click.option(
    "--spacing-m",
    metavar="M",
    required=True,
    type=METRES,
    help="Desired distance between neighboring passes.",
)
@click.option(
    "--tool-radius-m", metavar="M", required=True, type=METRES, help="Of the tool's footprint."
)
@click.option("-o", "--output", metavar="PATHS.json", required=True, type=PATH, help="The paths.")
@TIME_LIMIT
def cover(
    source: Path,
    plan: Path,
    pattern: str,
    spacing_m: float,
    tool_radius_m: float,
    output: Path,
    time_limit: float | None,
) -> int:
    """Lay a tool path on every segment of a painted surface, without a robot.

    SURFACE.json and PLAN.json are what paint writes. Each segment is covered without lifting off.
    """
    begun = time.monotonic()

    from cellcolor.cli.cover import cover_files
    from cellcolor.deadline import Deadline

    deadline = Deadline.after(time_limit, begun)
    return cover_files(source, plan, output, pattern, spacing_m, tool_radius_m, deadline)


@cellcolor.command()
@click.argument("scene", metavar="SCENE.toml", type=INPUT)
@click.option(
    "-o",
    "--output",
    metavar="FOLDER",
    required=True,
    type=PATH,
    help="Folder for all files; it is created if it does not exist.",
)
@_PATTERN
@COVER
@REQUIRED
@LEFT_ALONE
@TOLERANCE
@click.option(
    "--ask",
    metavar="QUESTION",
    multiple=True,
    help="What report.html is to tell besides: tradeoff, explain, place or setups. May be given "
    "several times.",
)
@TIME_LIMIT
@motion_options
def plan(
    scene: Path,
    output: Path,
    pattern: str,
    cover: float | None,
    required: str | None,
    left_alone: str | None,
    tolerance: str | None,
    ask: tuple[str, ...],
    time_limit: float | None,
    **motion: object,
) -> int:
    """Plan a motion over a scene's object with the fewest lift-offs, and have it judged.

    FOLDER gets the proof, the painted surface, tool paths, the trajectory, the verdict on it, files
    for other programs, and report.html to look at. The options below --time-limit replace keys of
    the setup's table [motion].
    """
    begun = time.monotonic()

    if required is not None and cover is None:
        raise click.UsageError("--required needs --cover: without it everything has to be")

    from cellcolor.cli.inputs import read_wanted
    from cellcolor.cli.plan import plan_scene
    from cellcolor.deadline import Deadline

    given = {key: value for key, value in motion.items() if value is not None}
    wanted = read_wanted(cover, required, left_alone)
    deadline = Deadline.after(time_limit, begun)
    return plan_scene(scene, output, pattern, wanted, tolerance, ask, given, deadline)
