"""``cellcolor tradeoff``, ``explain`` and ``place``, for a terminal or another program."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cellcolor.cli.exits import Exit
from cellcolor.cli.inputs import read_subject
from cellcolor.cli.progress import stages_of
from cellcolor.cli.terminal import apart_from, complain, print_json, say
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.door.drawing import kind_of_plot
from cellcolor.errors import InputError
from cellcolor.files.writing import check_output
from cellcolor.questions.places import read_place, read_weights

if TYPE_CHECKING:
    from cellcolor.lab.executors.work import Workers


@dataclass(frozen=True, slots=True)
class TradeoffRequest:
    """What the command line asked for.

    Attributes:
        source: a scene, a labelled surface or an instance.
        weights: a file with the weights of the vertices.
        required, left_alone: places, see :func:`~cellcolor.questions.places.read_place`.
        share: of which the fewest lift-offs are asked, 0 to 1.
        picture: of the front.
        as_json: a JSON object for each point instead of lines.
        workers, seed, deadline: of the search.
    """

    source: Path
    weights: str | None
    required: str | None
    left_alone: str | None
    share: float | None
    picture: Path | None
    as_json: bool
    workers: int | None
    seed: int
    deadline: Deadline


def ask_tradeoff(request: TradeoffRequest) -> Exit:
    """Print a front, or the point of it that covers a share."""
    from cellcolor.door.asking import save_front, tradeoff

    if request.picture is not None:
        check_output(request.picture, kind_of_plot(request.picture), [request.source])
    required = None if request.required is None else read_place(request.required, "--required")
    alone = None if request.left_alone is None else read_place(request.left_alone, "--left-alone")
    weights = None if request.weights is None else read_weights(request.weights)
    try:
        subject = read_subject(request.source, request.deadline)
        with stages_of(request.source, "asking") as report:
            front = tradeoff(
                subject,
                weights=weights,
                required=required,
                left_alone=alone,
                time_limit=request.deadline,
                workers=request.workers,
                seed=request.seed,
                progress=report,
            )
    except OutOfTime:
        complain(f"{request.source}: the time limit came before any division was found")
        return Exit.STOPPED
    except InputError as error:
        raise error if error.file else error.in_file(str(request.source)) from error
    points = front.points if request.share is None else (front.at_least(request.share),)
    with apart_from(request.picture):
        for point in points:
            if request.as_json:
                print_json({"file": str(request.source)} | point.to_document())
            else:
                say(point)
        if request.picture is not None:
            save_front(front, request.picture)
            if not request.as_json:
                say(f"wrote {request.picture}")
    return Exit.DONE if all(point.proved for point in points) else Exit.STOPPED


@dataclass(frozen=True, slots=True)
class ExplainRequest:
    """What the command line asked for.

    Attributes:
        scene: its file.
        at: a point in the world, m.
        as_json: a JSON object for each row instead of lines.
        workers, seed, deadline: of the search.
    """

    scene: Path
    at: str | None
    as_json: bool
    workers: int | None
    seed: int
    deadline: Deadline


def ask_explain(request: ExplainRequest) -> Exit:
    """Print what each limit, obstacle and test of a scene costs."""
    from cellcolor.door.asking import explain

    try:
        at = None if request.at is None else [float(word) for word in request.at.split(",")]
    except ValueError as error:
        raise InputError(None, "--at", "a point is three numbers: x,y,z") from error
    try:
        with stages_of(request.scene, "explaining") as report:
            found = explain(
                request.scene,
                at=at,
                time_limit=request.deadline,
                workers=request.workers,
                seed=request.seed,
                progress=report,
            )
    except OutOfTime:
        complain(f"{request.scene}: the time limit came before the scene itself was solved")
        return Exit.STOPPED
    except InputError as error:
        raise error if error.file else error.in_file(str(request.scene)) from error
    if request.as_json:
        for row in (*found, *found.here):
            print_json({"file": str(request.scene)} | row.to_document())
    else:
        for line in str(found).split("\n"):
            say(line)
    proved = all(row.proved_for_surface for row in found)
    return Exit.DONE if found.complete and proved else Exit.STOPPED


@dataclass(frozen=True, slots=True)
class PlaceRequest:
    """What the command line asked for.

    Attributes:
        scene: its file.
        ranges: of each variable that was given, ``LOW,HIGH``.
        cover: the share that has to be covered; None for as much as where the part stands.
        points, best, vertices, tiles, leeway: see :func:`~cellcolor.door.placing.place`.
        base: whether the arm's base is moved.
        uncovered_price: see :func:`~cellcolor.door.placing.place`.
        table: where rows are kept, and what is gone on from.
        picture: of the map.
        as_json: a JSON object for each row instead of lines.
        jobs, cluster: who does the work.
        seed, deadline: of the search.
    """

    scene: Path
    ranges: Mapping[str, str]
    cover: float | None
    points: int
    best: int
    vertices: int
    tiles: int
    leeway: float | None
    base: bool
    uncovered_price: float
    table: Path | None
    picture: Path | None
    as_json: bool
    jobs: int
    cluster: str | None
    seed: int
    deadline: Deadline


def ask_place(request: PlaceRequest) -> Exit:
    """Print where the part should stand."""
    from cellcolor.door.placing import place, save_map

    if request.picture is not None:
        check_output(request.picture, kind_of_plot(request.picture), [request.scene])
    jobs: int | Workers = request.jobs
    if request.cluster is not None:
        from cellcolor.cli.workers import workers_for

        jobs = workers_for(request.jobs, request.cluster)
    ranges = ranges_of(request.ranges)
    try:
        with stages_of(request.scene, "placing") as report:
            found = place(
                request.scene,
                **ranges,
                cover=request.cover,
                points=request.points,
                best=request.best,
                vertices=request.vertices,
                tiles=None if request.picture is None else request.tiles,
                leeway=request.leeway,
                base=request.base,
                uncovered_price=request.uncovered_price,
                table=request.table,
                jobs=jobs,
                time_limit=request.deadline,
                seed=request.seed,
                progress=report,
            )
    except OutOfTime:
        complain(f"{request.scene}: the time limit came before the scene itself was solved")
        return Exit.STOPPED
    except InputError as error:
        raise error if error.file else error.in_file(str(request.scene)) from error
    with apart_from(request.picture):
        if request.as_json:
            for row in found:
                moved = {"moved": "base"} if found.base else {}
                print_json({"file": str(request.scene)} | moved | row.to_document())
        else:
            for line in str(found).split("\n"):
                say(line)
        if request.picture is not None:
            save_map(found, request.picture)
            if not request.as_json:
                say(f"wrote {request.picture}")
    proved = found.best and all(row.proved_for_surface for row in found.best)
    return Exit.DONE if found.complete and proved else Exit.STOPPED


def ranges_of(texts: Mapping[str, str]) -> dict[str, Any]:
    """The range of each variable that was given as ``LOW,HIGH``."""
    ranges = {}
    for name, text in texts.items():
        try:
            low, high = map(float, text.split(","))
        except ValueError as error:
            raise InputError(None, f"--{name}", "a range is two numbers: LOW,HIGH") from error
        ranges[name] = low, high
    return ranges
