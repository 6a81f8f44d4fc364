"""What a lift-off costs: ``tradeoff``, ``explain``, ``place`` and ``setups``."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cellcolor.cli.ending import Exit
from cellcolor.cli.options import (
    CLUSTER,
    INPUT,
    JOBS,
    LEFT_ALONE,
    METRES,
    PATH,
    POINT,
    POSE,
    REQUIRED,
    SEED,
    TIME_LIMIT,
    TOLERANCE,
    WORKERS,
    Price,
    cellcolor,
    cover_option,
    json_option,
    output_option,
    ranges,
)
from cellcolor.cli.progress import at_work, workers_for
from cellcolor.cli.terminal import complain, drawn_to, print_json, say, say_lines
from cellcolor.data.prices import MOST_CM2, MOST_PRICE
from cellcolor.errors import InputError

if TYPE_CHECKING:
    from cellcolor.questions.front import FrontChoice, FrontPoint

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


def _print(
    file: Path, rows: Iterable[dict[str, Any]], text: object, as_json: bool, **common: Any
) -> None:
    """An answer: its rows as JSON Lines, or its text."""
    if not as_json:
        say_lines(text)
        return
    for row in rows:
        print_json({"file": str(file)} | common | row)


def _documents(rows: Iterable[Any]) -> Iterable[dict[str, Any]]:
    return (row.to_document() for row in rows)


@cellcolor.command()
@click.argument("source", metavar="SCENE|SURFACE|INSTANCE", type=INPUT)
@click.option(
    "--share",
    metavar="S",
    type=click.FloatRange(0, 1),
    help="Print only the fewest lift-offs that cover this share, 0 to 1.",
)
@click.option(
    "--price",
    "--lift-off-price",
    metavar="CM2",
    type=Price(0, MOST_CM2),
    help="Print only the least sum: a lift-off costs as much as CM2 square centimeters left out.",
)
@click.option(
    "--weights",
    metavar="FILE.json",
    help='A JSON file, {"weights": […]} with a number for each vertex, by which its area counts.',
)
@REQUIRED
@LEFT_ALONE
@output_option("FRONT.(png|svg)", "Draw the whole front to a file.")
@json_option("Print a JSON object for each point.")
@WORKERS
@SEED
@TIME_LIMIT
def tradeoff(
    source: Path,
    share: float | None,
    price: float | None,
    weights: str | None,
    output: Path | None,
    as_json: bool,
    **search: Any,
) -> Exit:
    """Print the largest share of area that each number of lift-offs covers, with proof.

    The share is one of the area that can be covered and is not left alone.
    """
    from cellcolor.cli.inputs import read_subject
    from cellcolor.cli.tables import nothing_to_cover
    from cellcolor.door.asking import save_front
    from cellcolor.door.asking import tradeoff as front_of
    from cellcolor.questions.places import read_weights

    if share is not None and price is not None:
        raise click.UsageError("--share and --price are two questions")
    with drawn_to(output, [source], as_json) as draw:
        given = None if weights is None else read_weights(weights)
        with at_work(source, "asking", "the time limit came before any division was found") as tell:
            subject = read_subject(source, search["time_limit"])
            front = front_of(subject, weights=given, progress=tell, **search)
            if not front.points:
                complain(f"{source}: {nothing_to_cover(front.instance)}")
                return Exit.STOPPED
            rows: Sequence[FrontPoint | FrontChoice] = front.points
            if share is not None:
                rows = [front.fewest_for(share)]
            elif price is not None:
                rows = [front.least_cost(price)]
        _print(source, _documents(rows), "\n".join(map(str, rows)), as_json)
        draw(lambda file: save_front(front, file))
    return Exit.done_if(all(row.proved for row in rows))


@cellcolor.command()
@click.argument("scene", metavar="SCENE", type=INPUT)
@click.option(
    "--at",
    metavar="X,Y,Z",
    type=POINT,
    help="Also say what each branch does at the vertex nearest to this point (m), and by which "
    "tests its color ends.",
)
@json_option("Print a JSON object for each row.")
@WORKERS
@SEED
@TIME_LIMIT
def explain(scene: Path, at: tuple[float, ...] | None, as_json: bool, **search: Any) -> Exit:
    """Print what costs a lift-off: the minimum without each limit, obstacle and test.

    Of what saves a lift-off the least amount that does is printed too. Where nothing does alone,
    sets of two and three are tried. Everything is proved like the minimum itself.
    """
    from cellcolor.door.asking import explain as explanation_of

    late = "the time limit came before the scene itself was solved"
    with at_work(scene, "explaining", late) as tell:
        found = explanation_of(scene, at=at, progress=tell, **search)
    _print(scene, found.documents(), found, as_json)
    return Exit.done_if(found.complete and all(row.proved_for_surface for row in found))


@cellcolor.command()
@click.argument("scene", metavar="SCENE", type=INPUT)
@ranges
@cover_option(
    "The share of the surface that has to be covered, 0 to 1.  [default: as much as where the "
    "part stands]"
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
    type=Price(0, MOST_PRICE),
    default=0.0,
    help="Make the sum of lift-offs and PRICE × uncovered share least.  [default: lift-offs first, "
    "then area]",
)
@TOLERANCE
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
@output_option(
    "TABLE.csv",
    "Keep each placement as it is proved; a table that is there is continued.",
    name="table",
)
@json_option("Print a JSON object for each placement.")
@click.option("--jobs", default=1, **JOBS)
@CLUSTER
@SEED
@TIME_LIMIT
def place(
    scene: Path,
    tolerance: str | None,
    picture: Path | None,
    tiles: int,
    as_json: bool,
    jobs: int,
    cluster: str | None,
    **search: Any,
) -> Exit:
    """Print where the part should stand: the placements with the fewest lift-offs, proved.

    Many placements are tried on a coarse mesh, the best ones built and proved on the scene's own.
    """
    from cellcolor.cli.inputs import with_tolerance
    from cellcolor.door.placing import place as placements_of
    from cellcolor.door.placing import save_map

    late = "the time limit came before the scene itself was solved"
    with drawn_to(picture, [scene], as_json) as draw:
        workers = jobs if cluster is None else workers_for(jobs, cluster)
        with at_work(scene, "placing", late) as tell:
            found = placements_of(
                scene if tolerance is None else with_tolerance(scene, tolerance),
                tiles=None if picture is None else tiles,
                jobs=workers,
                progress=tell,
                **search,
            )
        moved = {"moved": "base"} if found.base else {}
        _print(scene, _documents(found), found, as_json, **moved)
        draw(lambda file: save_map(found, file))
    proved = bool(found.best) and all(row.proved_for_surface for row in found.best)
    return Exit.done_if(found.complete and proved)


@cellcolor.command()
@click.argument("scene", metavar="SCENE", type=INPUT)
@click.option(
    "--at",
    metavar="X,Y,Z,ROLL,PITCH,YAW",
    type=POSE,
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
@cover_option(
    "The share to be covered of what any of these set-ups reaches, 0 to 1.",
    default=1.0,
    show_default=True,
)
@click.option(
    "--change-over",
    metavar="PRICE",
    type=Price(1, MOST_PRICE),
    help="What a change from one set-up to the next costs, in lift-offs.  [default: as few set-ups "
    "as possible, then as few lift-offs]",
)
@output_option("OUT.(html|png|svg)", "A picture of the part.")
@click.option(
    "--plan", "folder", metavar="FOLDER", type=PATH, help="Plan a motion for each, and judge it."
)
@json_option("Print one JSON object.")
@WORKERS
@SEED
@TIME_LIMIT
def setups(
    scene: Path,
    at: tuple[tuple[float, ...], ...],
    places: Path | None,
    output: Path | None,
    folder: Path | None,
    as_json: bool,
    **search: Any,
) -> Exit:
    """Print which set-ups of a part cover it with the fewest lift-offs, with proof.

    A set-up is the part in one place before one arm. SCENE itself is one of them.
    """
    from cellcolor.door.drawing import kind_of_picture
    from cellcolor.door.setting_up import setups as set_ups_of
    from cellcolor.files.writing import check_output, is_folder_or_nothing

    if output is not None:
        check_output(output, kind_of_picture(output), [scene])
    if folder is not None:
        is_folder_or_nothing(folder)
    all_places = [*at, *([] if places is None else _places_in(places))]
    late = "the time limit came before there was a choice"
    with at_work(scene, "setting up", late) as tell:
        found = set_ups_of(scene, at=all_places, progress=tell, **search)
    _print(scene, [found.answer.to_document()], found, as_json)
    if output is not None:
        found.plot(output)
    valid = whole = True
    if folder is not None:
        late = "the time limit came before all motions were planned"
        with at_work(scene, "planning", late) as tell:
            planned = found.plan(time_limit=search["time_limit"], progress=tell)
        for one, plan in zip(found.answer.set_ups, planned, strict=True):
            own = folder / f"set-up-{one.number}"
            plan.save(own)
            valid &= plan.verdict.valid
            whole &= plan.complete
            if not as_json:
                say(f"{own}: {plan.trajectory}; judge: {plan.verdict}")
                for line in plan.lacking:
                    say(f"  {line}")
    proved = found.answer.proved and found.answer.complete and whole
    return Exit.done_if(proved) if valid else Exit.INVALID


def _places_in(file: Path) -> list[tuple[float, ...]]:
    """The placements of a file of JSON Lines that ``place`` has printed, without refused ones."""
    from cellcolor.files.documents import parse_json, read_text

    found: list[tuple[float, ...]] = []
    for number, line in enumerate(read_text(file).splitlines(), 1):
        try:
            row = parse_json(line)
            if row.get("moved") == "base":
                raise InputError(None, None, "is a place of the arm's base, not of the part")
            if not row.get("refused"):
                pose = (*row["position_m"], *row["rpy_rad"])
                if len(pose) != 6 or not all(type(v) in (int, float) and isfinite(v) for v in pose):
                    raise ValueError
                found.append(pose)
        except InputError as error:
            raise InputError(str(file), f"line {number}", error.message) from error
        except (KeyError, TypeError, ValueError) as error:
            message = (
                "must be an object with position_m and rpy_rad, three numbers each, as place "
                "--json prints it"
            )
            raise InputError(str(file), f"line {number}", message) from error
    if not found:
        raise InputError(str(file), None, "has no place where the part can stand")
    return found
