"""What a lift-off costs: ``tradeoff``, ``explain``, ``place`` and ``setups``."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import click

from cellcolor.cli.ending import Exit
from cellcolor.cli.options import (
    INPUT,
    METRES,
    PATH,
    SHARE,
    Count,
    Numbers,
    Real,
    Stops,
    cellcolor,
    json_option,
    option,
    output_option,
    ranges,
    shared,
)
from cellcolor.cli.terminal import at_work, complain, print_json, say, say_lines
from cellcolor.data.wording import MOST_PRICE

_POSE = Numbers("a place is six numbers x,y,z,roll,pitch,yaw", 6)
_SCENE = click.argument("scene", metavar="SCENE", type=INPUT)
_UNSOLVED = "the time limit came before the scene itself was solved"


def _print(file: Path, rows: Iterable[dict[str, Any]], text: object, as_json: bool) -> None:
    """An answer: its rows as JSON Lines, or its text."""
    if not as_json:
        say_lines(text)
        return
    for row in rows:
        print_json({"file": str(file)} | row)


@cellcolor.command()
@click.argument("source", metavar="SCENE|SURFACE|INSTANCE", type=INPUT)
@option("--share", SHARE, "Print only the fewest lift-offs that cover this share, 0 to 1.")
@shared("left_alone")
@json_option("Print a JSON object for each point.")
@shared("workers", "seed", "time_limit")
def tradeoff(
    source: Path,
    share: float | None,
    as_json: bool,
    **search: Any,
) -> Exit:
    """Print the largest share of area that each number of lift-offs covers, with proof.

    The share is one of the area that can be covered and is not left alone.
    """
    from cellcolor.cli.inputs import read_subject
    from cellcolor.cli.tables import nothing_to_cover
    from cellcolor.door.asking import tradeoff as front_of

    with at_work(source, "asking", "the time limit came before any division was found") as tell:
        subject = read_subject(source, search["time_limit"])
        front = front_of(subject, progress=tell, **search)
        if not front.points:
            complain(f"{source}: {nothing_to_cover(front.instance)}")
            return Exit.STOPPED
        rows: list[Any] = list(front) if share is None else [front.fewest_for(share)]
    _print(source, (row.to_document() for row in rows), "\n".join(map(str, rows)), as_json)
    return Exit.done_if(all(row.proved for row in rows))


@cellcolor.command()
@_SCENE
@json_option("Print a JSON object for each row.")
@shared("workers", "seed", "time_limit")
def explain(scene: Path, as_json: bool, **search: Any) -> Exit:
    """Print what costs a lift-off: the minimum without each limit, obstacle and test.

    Of what saves a lift-off the least amount that does is printed too. Where nothing does alone,
    sets of two and three are tried. Everything is proved like the minimum itself.
    """
    from cellcolor.door.asking import explain as explanation_of

    with at_work(scene, "explaining", _UNSOLVED) as tell:
        found = explanation_of(scene, progress=tell, **search)
    _print(scene, (row.to_document() for row in found), found, as_json)
    return Exit.done_if(found.complete and all(row.proved_for_surface for row in found))


@cellcolor.command()
@_SCENE
@ranges
@option(
    "--cover",
    SHARE,
    "The share of the surface that has to be covered, 0 to 1.  [default: as much as where the "
    "part stands]",
)
@option(
    "--points",
    Count(1, 10**6),
    "Placements tried all over the ranges; about 3/4 as many follow around the best.",
    default=128,
)
@option(
    "--best",
    Count(1, 100),
    "Placements that are proved on the scene's own mesh and printed.",
    default=3,
)
@option(
    "--vertices",
    Count(20, 10**6),
    "Of the coarse mesh that placements are tried on.",
    default=300,
)
@shared("tolerance")
@click.option(
    "--base",
    is_flag=True,
    help="Move the arm's base instead of the part; it stands in the origin of the scene.",
)
@option(
    "--leeway",
    METRES,
    "Tell how far the best placements may be off before their lift-offs rise, tried up to so many "
    "metres.",
)
@option(
    "--map",
    PATH,
    "Draw all placements that were tried, over the first two ranges.",
    to="picture",
    metavar="OUT.(png|svg)",
)
@json_option("Print a JSON object for each placement.")
@shared("jobs", "seed", "time_limit")
def place(
    scene: Path, tolerance: str | None, picture: Path | None, as_json: bool, **search: Any
) -> Exit:
    """Print where the part should stand: the placements with the fewest lift-offs, proved.

    Many placements are tried on a coarse mesh, the best ones built and proved on the scene's own.
    """
    from cellcolor.cli.inputs import with_tolerance
    from cellcolor.door.asking import place as placements_of
    from cellcolor.door.asking import save_map
    from cellcolor.door.drawing import kind_of_picture
    from cellcolor.files.writing import check_output

    if picture is not None:
        check_output(picture, kind_of_picture(picture, flat=True), [scene])
    with at_work(scene, "placing", _UNSOLVED) as tell:
        found = placements_of(with_tolerance(scene, tolerance), progress=tell, **search)
        if picture is not None:
            save_map(found, picture)
    moved = {"moved": "base"} if found.base else {}
    _print(scene, (moved | row.to_document() for row in found), found, as_json)
    proved = bool(found.best) and all(row.proved_for_surface for row in found.best)
    return Exit.done_if(found.complete and proved)


@cellcolor.command()
@_SCENE
@option(
    "--at",
    _POSE,
    "Where else the part may stand, m and rad. May be given several times.",
    metavar="X,Y,Z,ROLL,PITCH,YAW",
    multiple=True,
)
@option(
    "--with",
    INPUT,
    "Another scene of the same part, such as with another arm. May be given several times.",
    to="others",
    metavar="SCENE.toml",
    multiple=True,
)
@option(
    "--stops",
    Stops(),
    "Where a joint that carries the arm, such as a rail, may stand while the tool works: m or rad. "
    "May be given once for each such joint.",
    metavar="JOINT=FROM:TO:STEP",
    multiple=True,
)
@option(
    "--cover",
    SHARE,
    "The share to be covered of what any of these set-ups reaches, 0 to 1.",
    default=1.0,
)
@option(
    "--change-over",
    Real("PRICE", 1, MOST_PRICE),
    "What a change from one set-up to the next costs, in lift-offs.  [default: as few set-ups as "
    "possible, then as few lift-offs]",
)
@output_option("OUT.(html|png|svg)", "A picture of the part.")
@option("--plan", PATH, "Plan a motion for each, and judge it.", to="folder", metavar="FOLDER")
@json_option("Print one JSON object.")
@shared("workers", "seed", "time_limit")
def setups(
    scene: Path,
    at: tuple[tuple[float, ...], ...],
    stops: tuple[tuple[str, tuple[float, ...]], ...],
    output: Path | None,
    folder: Path | None,
    as_json: bool,
    **search: Any,
) -> Exit:
    """Print which set-ups of a part cover it with the fewest lift-offs, with proof.

    A set-up is the part in one place before one arm. SCENE itself is one of them; with --stops each
    of these is one instead.
    """
    from cellcolor.door.drawing import kind_of_picture
    from cellcolor.door.setting_up import setups as set_ups_of
    from cellcolor.files.writing import check_output, is_folder_or_nothing

    if output is not None:
        check_output(output, kind_of_picture(output), [scene])
    if folder is not None:
        is_folder_or_nothing(folder)
    with at_work(scene, "setting up", "the time limit came before there was a choice") as tell:
        found = set_ups_of(scene, at=at, stops=dict(stops) or None, progress=tell, **search)
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
