"""The commands about the minimum: ``build``, ``solve``, ``check`` and ``show``."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellcolor.cli.commands.group import cellcolor
from cellcolor.cli.commands.options import INPUT, PATH, SECONDS, SEED
from cellcolor.pictures.registry import PICTURES
from cellcolor.solvers.registry import DEFAULT, OWN_NAMES, REFERENCE, solver_names

if TYPE_CHECKING:
    from cellcolor.data.solution import SearchSpace

__all__ = ["build", "check", "show", "solve"]


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
@click.option("--all", "every", is_flag=True, help="List all optimal schemes.")
@click.option(
    "--fewest-cuts", is_flag=True, help="Of the best divisions one with fewest cutting paths."
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
    help="With --all, no more schemes than that.  [default: 1000]",
)
@click.option("--time-limit", metavar="S", type=SECONDS, help="Seconds for each file.")
@click.option("--workers", metavar="N", type=click.IntRange(min=1), help="CP-SAT's search workers.")
@SEED
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
@click.argument("subject", metavar="FILE", type=click.Path())
@click.argument("claim", metavar="SOLUTION.json|PLAN.json|TRAJECTORY", type=click.Path())
@click.option(
    "--time-limit",
    metavar="S",
    type=SECONDS,
    default=60.0,
    show_default=True,
    help="Seconds, reading included, for a trajectory, or for the proven range that a plan is "
    "compared with.",
)
@click.option(
    "--cache",
    metavar="FOLDER",
    type=PATH,
    help="Of a plan: keep the proven range there, so that the next plan on the same surface needs "
    "no proof.",
)
@click.option(
    "--better",
    metavar="OUT.surface.json",
    type=PATH,
    help="Of a plan that can be beaten: write a better painting, the plan beside it as "
    "OUT.plan.json.",
)
@click.option(
    "--require-optimal",
    is_flag=True,
    help="Of a plan: exit code 1 if it can be beaten, 3 if that is open.",
)
@click.option("--json", "as_json", is_flag=True, help="One JSON object.")
def check(
    subject: str,
    claim: str,
    time_limit: float,
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
        raise click.UsageError("standard input (-) can be one of the two only")

    from cellcolor.cli.check import Request, check_files
    from cellcolor.cli.check_plan import PlanDemands
    from cellcolor.deadline import Deadline

    demands = PlanDemands(time_limit, cache, better, require_optimal)
    deadline = Deadline.after(time_limit, begun)
    return check_files(Request(subject, claim, deadline, demands, as_json))


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
