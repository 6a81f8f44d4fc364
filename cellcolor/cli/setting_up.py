"""``cellcolor setups``, for a terminal or another program."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from cellcolor.cli.exits import Exit
from cellcolor.cli.progress import stages_of
from cellcolor.cli.terminal import complain, print_json, say
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import InputError
from cellcolor.files.documents import parse_json, read_text

if TYPE_CHECKING:
    from cellcolor.door.setting_up import ChosenSetUps


@dataclass(frozen=True, slots=True)
class SetupsRequest:
    """What the command line asked for.

    Attributes:
        scene: its file.
        at: places, ``X,Y,Z,ROLL,PITCH,YAW``.
        places: a file with what ``place --json`` has printed.
        others: files of other scenes of the same part.
        cover, change_over: see :func:`~cellcolor.door.setting_up.setups`.
        picture: where the part is drawn with the segments of all set-ups.
        folder: where the motion of each set-up is written.
        as_json: one JSON object instead of lines.
        workers, seed, deadline: of the search.
    """

    scene: Path
    at: tuple[str, ...]
    places: Path | None
    others: tuple[Path, ...]
    cover: float
    change_over: float | None
    picture: Path | None
    folder: Path | None
    as_json: bool
    workers: int | None
    seed: int
    deadline: Deadline


def ask_setups(request: SetupsRequest) -> Exit:
    """Print which set-ups to use; draw and plan them if asked to."""
    from cellcolor.door.drawing import kind_of_picture
    from cellcolor.door.setting_up import setups

    if request.picture is not None:
        kind_of_picture(request.picture)
    at = [_place(text) for text in request.at]
    if request.places is not None:
        at += _places_in(request.places)
    try:
        with stages_of(request.scene, "setting up") as report:
            found = setups(
                request.scene,
                at=at,
                others=request.others,
                cover=request.cover,
                change_over=request.change_over,
                time_limit=request.deadline,
                workers=request.workers,
                seed=request.seed,
                progress=report,
            )
    except OutOfTime:
        complain(f"{request.scene}: the time limit came before there was a choice")
        return Exit.STOPPED
    except InputError as error:
        raise error if error.file else error.in_file(str(request.scene)) from error
    if request.as_json:
        print_json({"file": str(request.scene)} | found.answer.to_document())
    else:
        for line in str(found).split("\n"):
            say(line)
    if request.picture is not None:
        found.plot(request.picture)
    valid = request.folder is None or _plan_each(request, found)
    if not valid:
        return Exit.INVALID
    return Exit.DONE if found.answer.proved else Exit.STOPPED


def _plan_each(request: SetupsRequest, found: ChosenSetUps) -> bool:
    """Write the motion of each set-up to a folder of its own; whether all were judged valid."""
    assert request.folder is not None
    try:
        with stages_of(request.scene, "planning") as report:
            planned = found.plan(time_limit=request.deadline, progress=report)
    except OutOfTime:
        complain(f"{request.scene}: the time limit came before all motions were planned")
        return False
    for one, plan in zip(found.answer.set_ups, planned, strict=True):
        folder = request.folder / f"set-up-{one.number}"
        plan.save(folder)
        if not request.as_json:
            say(f"{folder}: {plan.trajectory}; judge: {plan.verdict}")
    return all(plan.verdict.valid for plan in planned)


def _place(text: str) -> list[float]:
    try:
        values = [float(word) for word in text.split(",")]
    except ValueError:
        values = []
    if len(values) != 6:
        raise InputError(None, "--at", "a place is six numbers: x,y,z,roll,pitch,yaw (m and rad)")
    return values


def _places_in(file: Path) -> list[list[float]]:
    """The placements of a file of JSON Lines that ``place`` has printed, without refused ones."""
    found = []
    for number, line in enumerate(read_text(file).splitlines(), 1):
        try:
            row = parse_json(line)
            if row.get("moved") == "base":
                message = "is a place of the arm's base, not of the part"
                raise InputError(None, None, message)
            if not row.get("refused"):
                found.append([float(v) for v in (*row["position_m"], *row["rpy_rad"])])
        except InputError as error:
            raise InputError(str(file), f"line {number}", error.message) from error
        except (KeyError, TypeError, ValueError) as error:
            message = "must be an object with position_m and rpy_rad, as place --json prints it"
            raise InputError(str(file), f"line {number}", message) from error
    return found
