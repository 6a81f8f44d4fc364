"""The commands that ask what a lift-off costs, and what fewer of them cover."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import click

from cellcolor.cli.commands.group import cellcolor
from cellcolor.cli.commands.options import CLUSTER, INPUT, JOBS, SEED, TIME_LIMIT

__all__ = ["explain", "place", "tradeoff"]

_PLACE = "a box x,y,z,x,y,z (lowest and highest corner, m), or a JSON file with a mask."


@cellcolor.command()
@click.argument("source", metavar="SCENE|SURFACE|INSTANCE", type=INPUT)
@click.option(
    "--share",
    metavar="S",
    type=click.FloatRange(0, 1),
    help="Print only the fewest lift-offs that cover this share, 0 to 1.",
)
@click.option(
    "--weights",
    metavar="FILE.json",
    help="A JSON file with a number for each vertex, which its area is multiplied by.",
)
@click.option("--required", metavar="PLACE", help=f"What has to be covered: {_PLACE}")
@click.option("--left-alone", metavar="PLACE", help=f"What must not be covered: {_PLACE}")
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object for each point.")
@click.option("--workers", metavar="N", type=click.IntRange(1, 1000), help="CP-SAT's workers.")
@SEED
@TIME_LIMIT
def tradeoff(
    source: Path,
    share: float | None,
    weights: str | None,
    required: str | None,
    left_alone: str | None,
    as_json: bool,
    workers: int | None,
    seed: int,
    time_limit: float | None,
) -> int:
    """Print the largest share of area that each number of lift-offs covers, with proof.

    The share is one of the area that can be covered and is not left alone.
    """
    begun = time.monotonic()

    from cellcolor.cli.ask import TradeoffRequest, ask_tradeoff
    from cellcolor.deadline import Deadline

    deadline = Deadline.after(time_limit, begun)
    request = TradeoffRequest(
        source, weights, required, left_alone, share, as_json, workers, seed, deadline
    )
    return ask_tradeoff(request)


@cellcolor.command()
@click.argument("scene", metavar="SCENE", type=INPUT)
@click.option(
    "--at",
    metavar="X,Y,Z",
    help="Tell as well what each branch does at the vertex nearest to this point (m), and by which "
    "tests its color ends.",
)
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object for each row.")
@click.option("--workers", metavar="N", type=click.IntRange(1, 1000), help="CP-SAT's workers.")
@SEED
@TIME_LIMIT
def explain(
    scene: Path,
    at: str | None,
    as_json: bool,
    workers: int | None,
    seed: int,
    time_limit: float | None,
) -> int:
    """Print what costs a lift-off: the minimum without each limit, obstacle and test.

    Of what saves a lift-off the least amount that does is printed too. Where nothing does alone,
    sets of two and three are tried. Everything is proved like the minimum itself.
    """
    begun = time.monotonic()

    from cellcolor.cli.ask import ExplainRequest, ask_explain
    from cellcolor.deadline import Deadline

    deadline = Deadline.after(time_limit, begun)
    return ask_explain(ExplainRequest(scene, at, as_json, workers, seed, deadline))


def _ranges(command: Callable[..., int]) -> Callable[..., int]:
    """An option for each variable of a placement."""
    for name, unit in (
        ("yaw", "rad"),
        ("pitch", "rad"),
        ("roll", "rad"),
        ("z", "m"),
        ("y", "m"),
        ("x", "m"),
    ):
        said = f"Where the part may be put, {name} in {unit}. What is not given stays."
        command = click.option(f"--{name}", metavar="LOW,HIGH", help=said)(command)
    return command


@cellcolor.command()
@click.argument("scene", metavar="SCENE", type=INPUT)
@_ranges
@click.option(
    "--cover",
    metavar="S",
    type=click.FloatRange(0, 1),
    help="The share of the surface that has to be covered, 0 to 1.  [default: as much as where the "
    "part stands]",
)
@click.option(
    "--points",
    metavar="N",
    type=click.IntRange(1, 10**6),
    default=128,
    show_default=True,
    help="Placements tried all over the ranges; three quarters as many follow around the best.",
)
@click.option(
    "--best",
    metavar="N",
    type=click.IntRange(1, 100),
    default=3,
    show_default=True,
    help="Placements that are proved on the scene's own mesh and printed.",
)
@click.option(
    "--vertices",
    metavar="N",
    type=click.IntRange(20, 10**6),
    default=300,
    show_default=True,
    help="Of the coarse mesh that placements are tried on.",
)
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object for each placement.")
@click.option("--jobs", default=1, **JOBS)
@CLUSTER
@SEED
@TIME_LIMIT
def place(
    scene: Path,
    cover: float | None,
    points: int,
    best: int,
    vertices: int,
    as_json: bool,
    jobs: int,
    cluster: str | None,
    seed: int,
    time_limit: float | None,
    **ranges: str | None,
) -> int:
    """Print where the part should stand: the placements with the fewest lift-offs, proved.

    Many placements are tried on a coarse mesh, the best ones built and proved on the scene's own.
    """
    begun = time.monotonic()

    from cellcolor.cli.ask import PlaceRequest, ask_place
    from cellcolor.deadline import Deadline

    deadline = Deadline.after(time_limit, begun)
    given = {name: text for name, text in ranges.items() if text is not None}
    request = PlaceRequest(
        scene, given, cover, points, best, vertices, as_json, jobs, cluster, seed, deadline
    )
    return ask_place(request)
