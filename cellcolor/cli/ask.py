"""What a lift-off costs: ``tradeoff``, ``explain``, ``place`` and ``setups``."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import click

from cellcolor.cli.ending import Exit
from cellcolor.cli.options import (
    COUNT,
    INPUT,
    LEFT_ALONE,
    PATH,
    SHARE,
    TIME_LIMIT,
    TOLERANCE,
    Numbers,
    cellcolor,
    json_option,
    keywords,
    option,
    output_option,
)
from cellcolor.cli.terminal import at_work, complain, print_json, say, say_lines

_SCENE = click.argument("scene", metavar="SCENE", type=INPUT)
_SEARCH = "door.asked:Search"
_RANGE = Numbers("a range is two numbers LOW,HIGH", 2)
_MOST_STOPS = 1000


def stops_of(text: str) -> tuple[str, tuple[float, ...]]:
    """A joint and where it may stand: evenly spaced positions up to the last."""
    joint, _, spaced = text.partition("=")
    try:
        low, high, step = map(float, spaced.split(":"))
        count = (high - low) / step + 1
    except (ValueError, ZeroDivisionError):
        count = 0.0
    if not joint or not 1 <= count <= _MOST_STOPS + 1e-9:
        asked = f"stops are JOINT=FROM:TO:STEP, at most {_MOST_STOPS}, as in rail_joint=0:2:0.25"
        raise click.BadParameter(f"{asked}, is {text!r}.")
    inside = min if step > 0 else max  # of the last one, which rounding can move beyond it
    return joint, tuple(inside(low + step * n, high) for n in range(int(count + 1e-9)))


def _print(file: Path, rows: Iterable[dict[str, Any]], text: object, as_json: bool) -> None:
    """An answer: its rows as JSON Lines, or its text."""
    if not as_json:
        say_lines(text)
        return
    for row in rows:
        print_json({"file": str(file)} | row)


@cellcolor.command(of=(_SEARCH,))
@click.argument("source", metavar="SCENE|SURFACE|INSTANCE", type=INPUT)
@option("--share", SHARE, "Print only the fewest lift-offs that cover this share, 0 to 1.")
@LEFT_ALONE
@json_option("Print a JSON object for each point.")
@keywords(workers=COUNT, seed=int)
@TIME_LIMIT
def tradeoff(source: Path, share: float | None, as_json: bool, **search: Any) -> Exit:
    """Print the largest share of area that each number of lift-offs covers, with proof.

    The share is one of the area that can be covered and is not left alone.
    """
    from cellcolor.cli.inputs import read_subject
    from cellcolor.cli.tables import nothing_to_cover
    from cellcolor.door.asking import tradeoff as front_of

    subject = read_subject(source, search["time_limit"])
    with at_work(source, "asking") as tell:
        front = front_of(subject, progress=tell, **search)
        if not front.points:
            complain(f"{source}: {nothing_to_cover(front.instance)}")
            return Exit.STOPPED
        rows: list[Any] = list(front) if share is None else [front.fewest_for(share)]
    _print(source, (row.to_document() for row in rows), "\n".join(map(str, rows)), as_json)
    return Exit.done_if(all(row.proved for row in rows))


@cellcolor.command(of=(_SEARCH,))
@_SCENE
@json_option("Print a JSON object for each row.")
@keywords(workers=COUNT, seed=int)
@TIME_LIMIT
def explain(scene: Path, as_json: bool, **search: Any) -> Exit:
    """Print what costs a lift-off: the minimum without each limit, obstacle and test.

    Of what saves a lift-off the least amount that does is printed too. Where nothing does alone,
    sets of two and three are tried. Everything is proved like the minimum itself.
    """
    from cellcolor.door.asking import explain as explanation_of

    with at_work(scene, "explaining") as tell:
        found = explanation_of(scene, progress=tell, **search)
    _print(scene, (row.to_document() for row in found), found, as_json)
    return Exit.done_if(found.complete and all(row.proved_for_surface for row in found))


@cellcolor.command(of=("door.asking:place", "questions.placements:PlacementQuestion"))
@_SCENE
@keywords(x=_RANGE, y=_RANGE, z=_RANGE, roll=_RANGE, pitch=_RANGE, yaw=_RANGE)
@keywords(cover=SHARE, points=COUNT, best=COUNT, vertices=COUNT)
@TOLERANCE
@keywords(base=bool)
@option(
    "--map",
    PATH,
    "Draw all placements that were tried, over the first two ranges.",
    to="picture",
    metavar="OUT.(png|svg)",
)
@json_option("Print a JSON object for each placement.")
@keywords(jobs=COUNT, seed=int)
@TIME_LIMIT
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
    with at_work(scene, "placing") as tell:
        found = placements_of(with_tolerance(scene, tolerance), progress=tell, **search)
        if picture is not None:
            save_map(found, picture)
    moved = {"moved": "base"} if found.base else {}
    _print(scene, (moved | row.to_document() for row in found), found, as_json)
    proved = bool(found.best) and all(row.proved_for_surface for row in found.best)
    return Exit.done_if(found.complete and proved)


@cellcolor.command(of=("door.setting_up:setups", _SEARCH))
@_SCENE
@option(
    "--at",
    Numbers("a place is six numbers x,y,z,roll,pitch,yaw", 6),
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
    stops_of,
    "Where a joint that carries the arm, such as a rail, may stand while the tool works: m or rad. "
    "May be given once for each such joint.",
    metavar="JOINT=FROM:TO:STEP",
    multiple=True,
)
@keywords(cover=SHARE, change_over=float)
@output_option("OUT.(html|png|svg)", "A picture of the part.")
@option("--plan", PATH, "Plan a motion for each, and judge it.", to="folder", metavar="FOLDER")
@json_option("Print one JSON object.")
@keywords(workers=COUNT, seed=int)
@TIME_LIMIT
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
    with at_work(scene, "setting up") as tell:
        found = set_ups_of(scene, at=at, stops=dict(stops) or None, progress=tell, **search)
    _print(scene, [found.answer.to_document()], found, as_json)
    if output is not None:
        found.plot(output)
    valid = whole = True
    if folder is not None:
        with at_work(scene, "planning") as tell:
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
