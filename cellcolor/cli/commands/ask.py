"""The commands that ask what a lift-off costs, and what fewer of them cover."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import click

from cellcolor.cli.commands.group import cellcolor
from cellcolor.cli.commands.options import (
    CLUSTER,
    INPUT,
    JOBS,
    LEFT_ALONE,
    METRES,
    PATH,
    REQUIRED,
    SEED,
    TIME_LIMIT,
)

_POINTS = click.option(
    "--points",
    metavar="N",
    type=click.IntRange(1, 10**6),
    default=128,
    show_default=True,
    help="Placements tried all over the ranges; about 3/4 as many follow around the best.",
)
_VERTICES = click.option(
    "--vertices",
    metavar="N",
    type=click.IntRange(20, 10**6),
    default=300,
    show_default=True,
    help="Of the coarse mesh that placements are tried on.",
)


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
    help="A JSON file with one number for each vertex; the vertex's area is multiplied by it.",
)
@REQUIRED
@LEFT_ALONE
@click.option(
    "-o",
    "--output",
    "picture",
    metavar="FRONT.(png|svg)",
    type=PATH,
    help="Draw the whole front to a file.",
)
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
    picture: Path | None,
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
        source, weights, required, left_alone, share, picture, as_json, workers, seed, deadline
    )
    return ask_tradeoff(request)


@cellcolor.command()
@click.argument("scene", metavar="SCENE", type=INPUT)
@click.option(
    "--at",
    metavar="X,Y,Z",
    help="Also say what each branch does at the vertex nearest to this point (m), and by which "
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
        said = f"Where the part may be put, {name} in {unit}. Values not given stay."
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
@_POINTS
@click.option(
    "--best",
    metavar="N",
    type=click.IntRange(1, 100),
    default=3,
    show_default=True,
    help="Placements that are proved on the scene's own mesh and printed.",
)
@_VERTICES
@click.option(
    "--uncovered-price",
    metavar="PRICE",
    type=click.FloatRange(0, max_open=True),
    default=0.0,
    help="Make the sum of lift-offs and PRICE × uncovered share least.  [default: lift-offs first, "
    "then area]",
)
@click.option(
    "--base",
    is_flag=True,
    help="Move the arm's base instead of the part; it stands in the origin of the scene.",
)
@click.option(
    "--leeway",
    metavar="M",
    type=METRES,
    help="Tell how far the best placements may be off before their lift-offs rise, tried up to so "
    "many metres.",
)
@click.option(
    "--map",
    "picture",
    metavar="OUT.(png|svg)",
    type=PATH,
    help="A map over one or two ranges: lift-offs and area in the middle of each tile.",
)
@click.option(
    "--tiles",
    metavar="N",
    type=click.IntRange(1, 1000),
    default=31,
    show_default=True,
    help="Of the map, along each range; their middles are tried in place of --points.",
)
@click.option(
    "-o",
    "--output",
    metavar="TABLE.csv",
    type=PATH,
    help="Keep each placement as it is proved; a table that is there is continued.",
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
    uncovered_price: float,
    base: bool,
    leeway: float | None,
    picture: Path | None,
    tiles: int,
    output: Path | None,
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
        scene=scene,
        ranges=given,
        cover=cover,
        points=points,
        best=best,
        vertices=vertices,
        tiles=tiles,
        leeway=leeway,
        base=base,
        uncovered_price=uncovered_price,
        table=output,
        picture=picture,
        as_json=as_json,
        jobs=jobs,
        cluster=cluster,
        seed=seed,
        deadline=deadline,
    )
    return ask_place(request)


@cellcolor.command()
@click.argument("part", metavar="PART.(stl|obj|ply)", type=PATH)
@click.option(
    "--arm",
    "arms",
    metavar="NAME|ARM.urdf",
    multiple=True,
    required=True,
    help="A shipped arm, such as ur5e, or a URDF; once for each arm.",
)
@_ranges
@click.option(
    "--cover",
    metavar="S",
    type=click.FloatRange(0, 1),
    help="The share of the surface that each arm has to cover, 0 to 1.  [default: as much as the "
    "arm that covers most where the part is put at first]",
)
@_POINTS
@_VERTICES
@click.option(
    "--unit",
    type=click.Choice(["m", "mm"]),
    help="Of the coordinates.  [default: what is likely by the size]",
)
@click.option(
    "-o", "--output", metavar="OUT.(png|svg)", type=PATH, help="A picture of what each arm covers."
)
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object for each arm.")
@click.option("--jobs", default=1, **JOBS)
@SEED
@TIME_LIMIT
def compare(
    part: Path,
    arms: tuple[str, ...],
    cover: float | None,
    points: int,
    vertices: int,
    unit: str | None,
    output: Path | None,
    as_json: bool,
    jobs: int,
    seed: int,
    time_limit: float | None,
    **ranges: str | None,
) -> int:
    """Print for each arm the best placement of a part, its lift-offs, its area and its front.

    Each arm gets the setup that ``cellcolor new`` begins with.
    """
    begun = time.monotonic()

    from cellcolor.cli.compare import CompareRequest, compare_arms
    from cellcolor.deadline import Deadline

    deadline = Deadline.after(time_limit, begun)
    given = {name: text for name, text in ranges.items() if text is not None}
    request = CompareRequest(
        part, arms, given, cover, points, vertices, unit, output, as_json, jobs, seed, deadline
    )
    return compare_arms(request)


@cellcolor.command()
@click.argument("scene", metavar="SCENE", type=INPUT)
@click.option(
    "--at",
    metavar="X,Y,Z,ROLL,PITCH,YAW",
    multiple=True,
    help="Where else the part may stand, m and rad. May be given several times.",
)
@click.option("--places", metavar="FILE.jsonl", type=PATH, help="What place --json has printed.")
@click.option(
    "--with",
    "others",
    metavar="SCENE.toml",
    type=INPUT,
    multiple=True,
    help="Another scene of the same part, such as with another arm. May be given several times.",
)
@click.option(
    "--cover",
    metavar="S",
    type=click.FloatRange(0, 1),
    default=1.0,
    show_default=True,
    help="The share to be covered of what any of these set-ups reaches, 0 to 1.",
)
@click.option(
    "--change-over",
    metavar="PRICE",
    type=click.FloatRange(min=1),
    help="What a change from one set-up to the next costs, in lift-offs.  [default: as few set-ups "
    "as possible, then as few lift-offs]",
)
@click.option(
    "-o", "--output", metavar="OUT.(html|png|svg)", type=PATH, help="A picture of the part."
)
@click.option(
    "--plan", "folder", metavar="FOLDER", type=PATH, help="Plan a motion for each, and judge it."
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
@click.option("--workers", metavar="N", type=click.IntRange(1, 1000), help="CP-SAT's workers.")
@SEED
@TIME_LIMIT
def setups(
    scene: Path,
    at: tuple[str, ...],
    places: Path | None,
    others: tuple[Path, ...],
    cover: float,
    change_over: float | None,
    output: Path | None,
    folder: Path | None,
    as_json: bool,
    workers: int | None,
    seed: int,
    time_limit: float | None,
) -> int:
    """Print which set-ups of a part cover it with the fewest lift-offs, with proof.

    A set-up is the part in one place before one arm. SCENE as it stands is one of them.
    """
    begun = time.monotonic()

    from cellcolor.cli.setting_up import SetupsRequest, ask_setups
    from cellcolor.deadline import Deadline

    request = SetupsRequest(
        scene,
        at,
        places,
        others,
        cover,
        change_over,
        output,
        folder,
        as_json,
        workers,
        seed,
        Deadline.after(time_limit, begun),
    )
    return ask_setups(request)
