"""The commands and their options. What they do is imported only when one of them runs."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cellcolor.cli.motion_options import motion_options
from cellcolor.pictures.registry import PICTURES
from cellcolor.solvers.registry import DEFAULT, OWN_NAMES, REFERENCE, solver_names
from cellcolor.tool_paths.registry import DEFAULT_PATTERN, PATTERNS, pattern_names
from cellcolor.version import __version__

if TYPE_CHECKING:
    from cellcolor.data.solution import SearchSpace


class _Positive(click.FloatRange):
    """A positive, finite number of some unit."""

    def __init__(self, units: str) -> None:
        super().__init__(min=0, min_open=True)
        self.units = units

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        number = float(super().convert(value, param, ctx))
        if not math.isfinite(number):
            self.fail(f"{value} is not a number of {self.units}.", param, ctx)
        return number


def _solver_name(_context: click.Context, _option: click.Parameter, value: str) -> str:
    """Refuse a solver that nobody has registered; none is imported for that."""
    known = solver_names()
    if value not in known:
        raise click.BadParameter(f"{value!r} is not one of {', '.join(known)}.")
    return value


def _pattern_name(_context: click.Context, _option: click.Parameter, value: str) -> str:
    """Refuse a pattern that nobody has registered; none is imported for that."""
    known = pattern_names()
    if value not in known:
        raise click.BadParameter(f"{value!r} is not one of {', '.join(known)}.")
    return value


class _Commands(click.Group):
    """Lists every command with its first paragraph in full; click would cut it to one line."""

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        rows = []
        for name in self.list_commands(ctx):
            paragraph = (self.commands[name].help or "").partition("\n\n")[0]
            rows.append((name, " ".join(paragraph.split())))
        with formatter.section("Commands"):
            formatter.write_dl(rows)


class _Input(click.Path):
    """A file to be read, or the name of a shipped one."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        from cellcolor.door.shipped import find_file

        return find_file(str(super().convert(value, param, ctx)))


_PATH = click.Path(path_type=Path)
_INPUT = _Input()
_SECONDS = _Positive("seconds")
_METRES = _Positive("metres")
_SEED = click.option(
    "--seed",
    metavar="N",
    type=click.IntRange(0, 2**31 - 1),
    default=0,
    show_default=True,
    help="Of everything random.",
)


@click.group(name="cellcolor", cls=_Commands, invoke_without_command=True)
@click.version_option(__version__, message="%(prog)s %(version)s")
@click.pass_context
def cellcolor(context: click.Context) -> None:
    """The fewest lift-offs of a robot arm over a surface, with a proof."""
    if context.invoked_subcommand is None:
        raise click.UsageError("no command given; see cellcolor --help", context)


@cellcolor.command()
@click.argument("source", metavar="SCENE.toml|SURFACE.json", type=_INPUT)
@click.option(
    "-o",
    "--output",
    metavar="INSTANCE.json",
    required=True,
    type=_PATH,
    help="The instance; other files are named after it.",
)
def build(source: Path, output: Path) -> int:
    """Make the topological graph of a robot scene or of a labelled surface.

    For a scene the labelled surface is written as well, beside the instance.
    """
    from cellcolor.cli.build import build_instance

    return build_instance(source, output)


@cellcolor.command()
@click.argument("files", metavar="FILE…", nargs=-1, required=True, type=_INPUT)
@click.option(
    "-o", "--output", metavar="OUT", type=_PATH, help="A file for one input, a folder for several."
)
@click.option(
    "--solver",
    metavar="NAME",
    callback=_solver_name,
    default=DEFAULT,
    show_default=True,
    help=f"{', '.join(OWN_NAMES)}, or what another package registers. {REFERENCE} is the paper's "
    "depth-first search, for small instances.",
)
@click.option(
    "--search-space",
    type=click.Choice(["paper", "surface"]),
    default="paper",
    show_default=True,
    help="paper: no more than one corridor across an edge. surface: several.",
)
@click.option(
    "--strands",
    metavar="K",
    type=click.IntRange(min=1),
    help="Corridors that may cross an edge, in search space surface.  [default: 2]",
)
@click.option("--all", "every", is_flag=True, help="List all optimal schemes.")
@click.option(
    "--fewest-cuts", is_flag=True, help="Of the best divisions one with fewest cutting paths."
)
@click.option(
    "--warm-start",
    metavar="SOLUTION.json",
    type=_PATH,
    help="Start from this solution of the one file given.",
)
@click.option(
    "--limit",
    metavar="N",
    type=click.IntRange(min=1),
    help="With --all, no more schemes than that.  [default: 1000]",
)
@click.option("--time-limit", metavar="S", type=_SECONDS, help="Seconds for each file.")
@click.option("--workers", metavar="N", type=click.IntRange(min=1), help="CP-SAT's search workers.")
@_SEED
@click.option("--json", "as_json", is_flag=True, help="JSON Lines, one solution a file.")
def solve(
    files: tuple[Path, ...],
    output: Path | None,
    solver: str,
    search_space: str,
    strands: int | None,
    every: bool,
    fewest_cuts: bool,
    warm_start: Path | None,
    limit: int | None,
    time_limit: float | None,
    workers: int | None,
    seed: int,
    as_json: bool,
) -> int:
    """Find the fewest segments of instances, labelled surfaces and scenes.

    FILE may be the name of a shipped one, such as wok: a file of that name goes first. That holds
    for the other commands as well; cellcolor.library() lists the names in Python.
    """
    begun = time.monotonic()
    if strands is not None and search_space == "paper":
        raise click.UsageError("--strands goes with --search-space surface")
    if limit is not None and not every:
        raise click.UsageError("--limit goes with --all")
    if every and search_space == "surface":
        raise click.UsageError("--all goes with --search-space paper: schemes are defined there")

    if warm_start is not None and len(files) > 1:
        raise click.UsageError("--warm-start goes with a single file")

    from cellcolor.cli.solve import Request, solve_files
    from cellcolor.solvers.interface import STRANDS, Options

    space: SearchSpace = "surface" if search_space == "surface" else "paper"
    options = Options(
        space,
        STRANDS[space] if strands is None else strands,
        workers=workers,
        seed=seed,
        fewest_cuts=fewest_cuts,
    )
    request = Request(
        files, output, solver, options, time_limit, begun, warm_start, every, limit or 1000, as_json
    )
    return solve_files(request)


@cellcolor.command()
@click.argument("subject", metavar="FILE", type=_INPUT)
@click.argument("claim", metavar="SOLUTION.json|PLAN.json|TRAJECTORY", type=_PATH)
@click.option(
    "--time-limit",
    metavar="S",
    type=_SECONDS,
    default=60.0,
    show_default=True,
    help="Seconds, reading included, for a trajectory, or for the proven range that a plan is "
    "compared with.",
)
@click.option("--json", "as_json", is_flag=True, help="One JSON object.")
def check(subject: Path, claim: Path, time_limit: float, as_json: bool) -> int:
    """Check a solution, a plan on a labelled surface, or a trajectory for a scene.

    FILE is what was solved, an instance, a labelled surface or a scene; for a plan it leads to a
    surface, for a trajectory (.json or .csv) it is the scene.
    """
    begun = time.monotonic()

    from cellcolor.cli.check import check_files
    from cellcolor.deadline import Deadline

    return check_files(subject, claim, Deadline.after(time_limit, begun), as_json)


@cellcolor.command()
@click.argument("source", metavar="FILE", type=_INPUT)
@click.argument("claim", metavar="SOLUTION.json", type=_PATH)
@click.option(
    "-o",
    "--output",
    metavar="OUT.surface.json",
    required=True,
    type=_PATH,
    help="The painted surface; the plan on it is written beside, as OUT.plan.json.",
)
@click.option(
    "--tool-radius",
    metavar="M",
    type=float,
    help="Of the tool's footprint, m: corridors are made as wide as that where possible.  "
    "[default: the scene's, or one mean mesh edge]",
)
@click.option(
    "--time-limit",
    metavar="S",
    type=_SECONDS,
    help="Seconds, reading included.  [default: as long as it takes]",
)
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
@click.argument("scene", metavar="SCENE.toml", type=_INPUT)
@click.option(
    "-o",
    "--output",
    metavar="FOLDER",
    required=True,
    type=_PATH,
    help="For all files; it is made if it does not exist.",
)
@click.option(
    "--pattern",
    metavar="NAME",
    default=DEFAULT_PATTERN,
    show_default=True,
    help=f"Of the tool paths: {', '.join(PATTERNS)}, or what another package registers.",
)
@click.option(
    "--time-limit",
    metavar="S",
    type=_SECONDS,
    help="Seconds for all of it.  [default: as long as it takes]",
)
@motion_options
def plan(
    scene: Path, output: Path, pattern: str, time_limit: float | None, **motion: object
) -> int:
    """Plan a motion over a scene's object with the fewest lift-offs, and have it judged.

    FOLDER gets the proof, the painted surface, tool paths, the trajectory, the verdict on it, files
    for other programs, and report.html to look at. The options below --time-limit replace keys of
    the setup's table [motion].
    """
    begun = time.monotonic()

    from cellcolor.cli.plan import plan_scene
    from cellcolor.deadline import Deadline

    given = {key: value for key, value in motion.items() if value is not None}
    return plan_scene(scene, output, pattern, given, Deadline.after(time_limit, begun))


@cellcolor.command()
@click.argument("source", metavar="SURFACE.json", type=_INPUT)
@click.argument("plan", metavar="PLAN.json", type=_PATH)
@click.option(
    "--pattern",
    metavar="NAME",
    callback=_pattern_name,
    default=DEFAULT_PATTERN,
    show_default=True,
    help=f"{', '.join(PATTERNS)}, or what another package registers.",
)
@click.option(
    "--spacing-m",
    metavar="M",
    required=True,
    type=_METRES,
    help="Wanted distance between neighboring passes.",
)
@click.option(
    "--tool-radius-m", metavar="M", required=True, type=_METRES, help="Of the tool's footprint."
)
@click.option("-o", "--output", metavar="PATHS.json", required=True, type=_PATH, help="The paths.")
@click.option(
    "--time-limit",
    metavar="S",
    type=_SECONDS,
    help="Seconds, reading included.  [default: as long as it takes]",
)
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
@click.argument("files", metavar="FILE…", nargs=-1, required=True, type=_INPUT)
@click.option(
    "--time-limit",
    metavar="S",
    type=_SECONDS,
    default=60.0,
    show_default=True,
    help="Seconds for each solve.",
)
def bench(files: tuple[Path, ...], time_limit: float) -> int:
    """Compare the reference solver with CP-SAT, one after the other, each on its own."""
    from cellcolor.cli.bench import bench_files

    return bench_files(files, time_limit)


@cellcolor.command()
@click.argument(
    "files", metavar="FILE [SOLUTION.json|PLAN.json]", nargs=-1, required=True, type=_INPUT
)
@click.option(
    "-o",
    "--output",
    metavar="OUT.(html|png|svg)",
    required=True,
    type=_PATH,
    help="The picture, in the format of its ending.",
)
@click.option(
    "--view",
    metavar="NAME",
    type=click.Choice(list(PICTURES)),
    help=f"The picture: {', '.join(PICTURES)}. The options below choose one as well.",
)
@click.option("--color", metavar="NAME|ID", help="Where one color is available.")
@click.option(
    "--reason", is_flag=True, help="Why points are out of reach, at best or in one --branch."
)
@click.option("--graph", is_flag=True, help="The topological graph.")
@click.option(
    "--vertex", metavar="N", type=click.IntRange(min=0), help="The arm on a vertex, in a --branch."
)
@click.option("--branch", metavar="NAME|ID", help="An inverse-kinematic branch.")
def show(
    files: tuple[Path, ...],
    output: Path,
    view: str | None,
    color: str | None,
    reason: bool,
    graph: bool,
    vertex: int | None,
    branch: str | None,
) -> int:
    """Draw an instance, a labelled surface or a scene, by cell unless an option says otherwise.

    With a solution after what was solved, or a plan on its surface: by segment.
    """
    if len(files) > 2:
        raise click.UsageError("one file to show, or one and its solution or plan")
    implied = {
        "color": color is not None,
        "reasons": reason,
        "graph": graph,
        "arm": vertex is not None,
        "segments": len(files) > 1,
    }
    asked = [name for name, is_asked in implied.items() if is_asked]
    if view is not None and (reason or graph):
        raise click.UsageError("--view goes without --reason and --graph")
    if view is None and len(asked) > 1:
        raise click.UsageError(
            "one of --color, --reason, --graph, --vertex and a solution at a time"
        )

    from cellcolor.cli.show import show_files

    name = view or (asked[0] if asked else "cells")
    return show_files(files, output, name, color, vertex, branch)


@cellcolor.command()
@click.option(
    "--count",
    metavar="N",
    type=click.IntRange(min=1),
    default=500,
    show_default=True,
    help="Random instances.",
)
@_SEED
@click.option(
    "--time-limit",
    metavar="S",
    type=_SECONDS,
    default=20.0,
    show_default=True,
    help="Seconds for each solve.",
)
@click.option(
    "--jobs",
    metavar="N",
    type=click.IntRange(min=1),
    default=2,
    show_default=True,
    help="Processes.",
)
@click.option(
    "-o",
    "--output",
    metavar="FOLDER",
    type=_PATH,
    default=Path("disagreements"),
    show_default=True,
    help="Where disagreements are kept.",
)
def campaign(count: int, seed: int, time_limit: float, jobs: int, output: Path) -> int:
    """Hold the solvers to each other on random instances; exit code 1 if they disagree."""
    from cellcolor.cli.campaign import run_campaign

    return run_campaign(count, seed, time_limit, jobs, output)
