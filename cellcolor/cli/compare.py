"""``cellcolor compare``, for a terminal or another program."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from cellcolor.cli.ask import ranges_of
from cellcolor.cli.exits import Exit
from cellcolor.cli.progress import stages_of
from cellcolor.cli.terminal import apart_from, complain, print_json, say
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.door.comparing import compare
from cellcolor.door.drawing import kind_of_plot
from cellcolor.files.writing import check_output


@dataclass(frozen=True, slots=True)
class CompareRequest:
    """What the command line asked for.

    Attributes:
        part: a mesh file.
        arms: names of shipped ones, or files of URDFs.
        ranges: of each variable that was given, ``LOW,HIGH``.
        cover: the share that each has to cover; None for as much as the best covers at first.
        points, vertices: see :func:`~cellcolor.door.placing.place`.
        unit: of the mesh; None for the likely one.
        picture: where the picture goes.
        as_json: a JSON object for each arm instead of lines.
        jobs: processes at a time.
        seed, deadline: of the search.
    """

    part: Path
    arms: tuple[str, ...]
    ranges: Mapping[str, str]
    cover: float | None
    points: int
    vertices: int
    unit: str | None
    picture: Path | None
    as_json: bool
    jobs: int
    seed: int
    deadline: Deadline


def compare_arms(request: CompareRequest) -> Exit:
    """Print what each arm needs for a part, and draw it if asked."""
    ranges = ranges_of(request.ranges)
    if request.picture is not None:
        check_output(request.picture, kind_of_plot(request.picture), [request.part])
    try:
        with stages_of(request.part, "comparing") as report:
            found = compare(
                request.part,
                request.arms,
                **ranges,
                cover=request.cover,
                points=request.points,
                vertices=request.vertices,
                unit=request.unit,
                jobs=request.jobs,
                time_limit=request.deadline,
                seed=request.seed,
                progress=report,
            )
    except OutOfTime:
        complain(f"{request.part}: the time limit came before anything was known of an arm")
        return Exit.STOPPED
    with apart_from(request.picture):
        if request.as_json:
            for row in found:
                print_json({"file": str(request.part)} | row.to_document())
        else:
            for line in str(found).split("\n"):
                say(line)
        if request.picture is not None:
            found.save(request.picture)
            if not request.as_json:
                say(f"wrote {request.picture}")
    proved = all(row.best is None or row.best.proved_for_surface for row in found)
    return Exit.DONE if found.complete and proved else Exit.STOPPED
