"""The commands about the minimum: ``build``, ``solve``, ``check`` and ``show``."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellcolor.cli.commands.group import cellcolor
from cellcolor.cli.commands.options import (
    COVER,
    INPUT,
    LEFT_ALONE,
    PATH,
    REQUIRED,
    SECONDS,
    SEED,
    TOLERANCE,
)
from cellcolor.pictures.registry import PICTURES
from cellcolor.solvers.registry import DEFAULT, OWN_NAMES, REFERENCE, solver_names

if TYPE_CHECKING:
    from cellcolor.data.solution import SearchSpace


def _solver_name(_context: click.Context, _option: click.Parameter, value: str) -> str:
    """Refuse a solver that nobody has registered; none is imported for that."""
    known = solver_names()
    if value not in known:
        raise click.BadParameter(f"{value!r} is not one of {', '.join(known)}.")
    return value


@cellcolor.command()
@click.argument("source", metavar="SCENE.toml|SURFACE.json", type=INPUT)
@click.option(
    "-o",
    "--output",
    metavar="INSTANCE.json",
    required=True,
    type=PATH,
    help="The instance; other files are named after it.",
)
def build(source: Path, output: Path) -> int:
    """Make the topological graph of a robot scene or of a labelled surface.

    For a scene the labelled surface is written as well, beside the instance.
    """
    from cellcolor.cli.build import build_instance

    return build_instance(source, output)


@cellcolor.command()
@click.argument("files", metavar="FILE…", nargs=-1, required=True, type=INPUT)
@click.option(
    "-o", "--output", metavar="OUT", type=PATH, help="A file for one input, a folder for several."
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
@COVER
@REQUIRED
@LEFT_ALONE
@TOLERANCE
@click.option("--all", "every", is_flag=True, help="List all optimal schemes.")
@click.option(
    "--fewest-cuts",
    is_flag=True,
    help="Find one of the best divisions with the fewest cutting paths.",
)
@click.option(
    "--warm-start",
    metavar="SOLUTION.json",
    type=PATH,
    help="Start from this solution of the one file given.",
)
@click.option(
    "--limit",
    metavar="N",
    type=click.IntRange(min=1),
    help="With --all, stop after this many schemes.  [default: 1000]",
)
@click.option(
    "--refine-until-stable",
    is_flag=True,
    help="Solve a scene on finer meshes until minimum and graph stay the same twice in a row.",
)
@click.option(
    "--picture",
    metavar="OUT.(html|png|svg)",
    type=PATH,
    help="With --refine-until-stable, the meshes side by side.",
)
@click.option("--time-limit", metavar="S", type=SECONDS, help="Seconds for each file.")
@click.option("--workers", metavar="N", type=click.IntRange(min=1), help="CP-SAT's search workers.")
@SEED
@click.option("--json", "as_json", is_flag=True, help="Print JSON Lines, one solution per file.")
def solve(
    files: tuple[Path, ...],
    output: Path | None,
    solver: str,
    search_space: str,
    strands: int | None,
    cover: float | None,
    required: str | None,
    left_alone: str | None,
    tolerance: str | None,
    every: bool,
    fewest_cuts: bool,
    warm_start: Path | None,
    limit: int | None,
    refine_until_stable: bool,
    picture: Path | None,
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
        raise click.UsageError("--strands needs --search-space surface")
    if limit is not None and not every:
        raise click.UsageError("--limit needs --all")
    if every and search_space == "surface":
        raise click.UsageError("--all needs --search-space paper: schemes are defined only there")
    given = (cover, required, left_alone, warm_start, every or None)
    if refine_until_stable and any(value is not None for value in given):
        raise click.UsageError(
            "--refine-until-stable excludes --cover, --required, --left-alone, --warm-start "
            "and --all: they are of a single mesh"
        )
    if picture is not None and not (refine_until_stable and len(files) == 1):
        raise click.UsageError("--picture needs --refine-until-stable and a single scene")
    if warm_start is not None and len(files) > 1:
        raise click.UsageError("--warm-start takes a single file")
    if required is not None and cover is None:
        raise click.UsageError("--required needs --cover: without it everything has to be")

    from cellcolor.cli.inputs import read_wanted
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
        files,
        output,
        solver,
        options,
        time_limit,
        begun,
        warm_start,
        read_wanted(cover, required, left_alone),
        tolerance,
        every,
        limit or 1000,
        refine_until_stable,
        picture,
        as_json,
    )
    return solve_files(request)


@cellcolor.command()
@click.argument("subject", metavar="FILE", type=click.Path())
@click.argument("claim", metavar="SOLUTION.json|PLAN.json|TRAJECTORY", type=click.Path())
@click.option(
    "--time-limit",
    metavar="S",
    type=SECONDS,
    default=60.0,
    show_default=True,
    help="Seconds, including reading, for a trajectory, or for the proven range that a plan is "
    "compared with.",
)
@LEFT_ALONE
@TOLERANCE
@click.option(
    "--cache",
    metavar="FOLDER",
    type=PATH,
    help="For a plan: keep the proven range there, so that the next plan on the same surface needs "
    "no proof.",
)
@click.option(
    "--better",
    metavar="OUT.surface.json",
    type=PATH,
    help="For a plan that can be beaten: write a better painting, and beside it the plan as "
    "OUT.plan.json.",
)
@click.option(
    "--require-optimal",
    is_flag=True,
    help="For a plan: exit code 1 if it can be beaten, 3 if that is open.",
)
@click.option("--json", "as_json", is_flag=True, help="One JSON object.")
def check(
    subject: str,
    claim: str,
    time_limit: float,
    left_alone: str | None,
    tolerance: str | None,
    cache: Path | None,
    better: Path | None,
    require_optimal: bool,
    as_json: bool,
) -> int:
    """Check a solution, a plan on a labelled surface, or a trajectory for a scene.

    FILE is what was solved, an instance, a labelled surface or a scene; for a plan it leads to a
    surface, for a trajectory (.json or .csv) it is the scene. One of the two may be -, for standard
    input.
    """
    begun = time.monotonic()
    if subject == claim == "-":
        raise click.UsageError("only one of the two can be standard input (-)")

    from cellcolor.cli.check import Request, check_files
    from cellcolor.cli.check_plan import PlanDemands
    from cellcolor.deadline import Deadline
    from cellcolor.questions.places import read_place

    demands = PlanDemands(time_limit, cache, better, require_optimal)
    deadline = Deadline.after(time_limit, begun)
    place = None if left_alone is None else read_place(left_alone, "--left-alone")
    return check_files(Request(subject, claim, deadline, demands, as_json, place, tolerance))


@cellcolor.command()
@click.argument(
    "files", metavar="FILE [SOLUTION.json|PLAN.json]", nargs=-1, required=True, type=INPUT
)
@click.option(
    "-o",
    "--output",
    metavar="OUT.(html|png|svg)",
    required=True,
    type=PATH,
    help="The picture; the ending gives its format.",
)
@click.option(
    "--view",
    metavar="NAME",
    type=click.Choice(list(PICTURES)),
    help=f"The picture: {', '.join(PICTURES)}. The options below also choose one.",
)
@click.option("--color", metavar="NAME|ID", help="Show where one color is available.")
@click.option(
    "--reason",
    is_flag=True,
    help="Show why points are out of reach, in the best branch or in one --branch.",
)
@click.option("--graph", is_flag=True, help="The topological graph.")
@click.option(
    "--vertex",
    metavar="N",
    type=click.IntRange(min=0),
    help="Show the arm at a vertex, in a --branch.",
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
        raise click.UsageError("give one file to show, or one with its solution or plan")
    implied = {
        "color": color is not None,
        "reasons": reason,
        "graph": graph,
        "arm": vertex is not None,
        "segments": len(files) > 1,
    }
    asked = [name for name, is_asked in implied.items() if is_asked]
    if view is not None and (reason or graph):
        raise click.UsageError("--view cannot be combined with --reason and --graph")
    if view is None and len(asked) > 1:
        raise click.UsageError(
            "--color, --reason, --graph, --vertex and a solution exclude each other"
        )

    from cellcolor.cli.show import show_files

    name = view or (asked[0] if asked else "cells")
    return show_files(files, output, name, color, vertex, branch)
