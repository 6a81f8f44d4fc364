"""``cellcolor solve``: the fewest segments of each file."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from types import FrameType
from typing import Any

import click

from cellcolor.checker.claimed_numbers import contradictions
from cellcolor.cli.ending import INTERRUPTS, Exit, worst
from cellcolor.cli.inputs import read_subject
from cellcolor.cli.progress import line_of
from cellcolor.cli.tables import nothing_to_cover, print_overview, print_solution
from cellcolor.cli.terminal import apart_from, complain, print_json, unheard
from cellcolor.data.instance import Instance
from cellcolor.data.schemes import scheme_line
from cellcolor.data.solution import Division, Solution
from cellcolor.data.wording import count
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.door.drawing import kind_of_plot
from cellcolor.door.result import Result
from cellcolor.errors import CellcolorError, InputError, system_errors
from cellcolor.files.writing import (
    Output,
    check_output,
    is_folder,
    is_folder_or_nothing,
    is_stream,
    kind_of_format,
    write,
)
from cellcolor.signals import handled_by
from cellcolor.solvers.interface import PORTFOLIO, Options

_SOLUTION = kind_of_format(Solution.FORMAT)
_SCHEMES = 1000  # that are listed unless --limit says otherwise


class Interrupted(OutOfTime, KeyboardInterrupt):
    """A signal that a solver takes for the time limit; it hands over the best it has."""


@contextmanager
def end_the_search() -> Iterator[None]:
    """Turn signals into :class:`Interrupted` for a while."""

    def handle(_number: int, _frame: FrameType | None) -> None:
        INTERRUPTS.seen = True
        raise Interrupted("interrupted")

    with handled_by(handle):
        yield


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """What the command line asked for.

    Attributes:
        search: what goes on to the front door's ``solve``.
        every: whether all optimal schemes are listed.
        limit: how many of them at most.
        time_limit: seconds for each file.
        begun: when the command began, on the clock of ``time.monotonic``: what it took to start
            counts for the first file.
    """

    files: tuple[Path, ...]
    output: Path | None
    search: dict[str, Any]
    tolerance: str | None
    every: bool
    limit: int | None
    picture: Path | None
    time_limit: float | None
    as_json: bool
    begun: float

    @property
    def inputs(self) -> list[Path]:
        """Files that are read."""
        return [*self.files, *filter(None, [self.search["start"]])]

    @property
    def of_a_part(self) -> bool:
        """Whether something is left out on purpose."""
        return self.search["cover"] is not None or self.search["left_alone"] is not None


def solve_files(request: Request) -> Exit:
    """Solve every file; a bad one does not stop the others."""
    targets = _targets(request)
    if request.picture is not None:
        check_output(request.picture, kind_of_plot(request.picture), request.inputs)
    _check_able(request)
    _warn_of_workers(request.search["workers"])
    with apart_from(request.output):
        return _solve_files(request, targets)


def _solve_files(request: Request, targets: list[Path | None]) -> Exit:
    codes: list[Exit] = []
    solved: list[tuple[Path, Instance, Solution]] = []
    begun: float | None = request.begun
    for file, target in zip(request.files, targets, strict=True):
        deadline = Deadline.after(request.time_limit, begun)
        begun = None
        try:
            result = _solve(file, target, request, deadline)
        except Interrupted:
            _say_failed(request, file, f"{file}: interrupted, nothing found yet")
            codes.append(Exit.STOPPED)
            break
        except OutOfTime:
            message = f"{file}: unknown: the time limit came before any division was found"
            _say_failed(request, file, message, status="unknown")
            codes.append(Exit.STOPPED)
            continue
        except CellcolorError as error:
            named = isinstance(error, InputError) and error.file
            _say_failed(request, file, str(error) if named else f"{file}: {error}")
            codes.append(Exit.BAD_INPUT)
            continue
        solved.append((file, result.instance, result.solution))
        codes.append(_told(request, file, result))
        if INTERRUPTS.seen or (target is None and unheard()):
            break
    if len(codes) < len(request.files):
        codes.append(Exit.STOPPED)
    if len(request.files) > 1 and not request.as_json:
        print_overview(solved)
    return worst(codes)


def _told(request: Request, file: Path, result: Result) -> Exit:
    """Print one result; the exit code that it stands for."""
    instance, solution = result.instance, result.solution
    wrong = contradictions(instance, solution)
    if request.as_json:
        fault = {"error": "; ".join(wrong)} if wrong else {}
        share = {"covered_share": result.covered_share} if request.of_a_part else {}
        print_json({"file": str(file)} | solution.to_document() | share | fault)
    else:
        print_solution(instance, solution)
    for problem in wrong:
        complain(f"{file}: contradiction: {problem}")
    if instance.nothing_to_cover:
        complain(f"{file}: {nothing_to_cover(instance)}")
    if wrong:
        return Exit.INVALID
    return Exit.done_if(solution.status == "optimal" and solution.complete is not False)


def _check_able(request: Request) -> None:
    """Refuse at once what the solver cannot do for any file.

    What every solver can do is not asked about: bad input has to import no solver.
    """
    space, start = request.search["search_space"], request.search["start"] is not None
    if request.every or start or space != "paper":
        from cellcolor.solvers.checked import check_able

        options = Options(space, request.search["strands"])
        try:
            check_able(request.search["solver"], options, start=start, schemes=request.every)
        except InputError as error:
            raise click.UsageError(str(error)) from error


def _warn_of_workers(workers: int | None) -> None:
    """More workers than processors are useful in a portfolio, and slow beyond it."""
    cores = os.cpu_count() or 1
    if workers is not None and workers > max(cores, PORTFOLIO):
        complain(f"{workers} workers share {cores} processors")


def _say_failed(request: Request, file: Path, message: str, **known: str) -> None:
    complain(message)
    if request.as_json:
        print_json({"file": str(file)} | known | {"error": message})


def _targets(request: Request) -> list[Path | None]:
    """Where each input's solution goes; refuses what could lose a file."""
    output = request.output
    if output is None:
        return [None] * len(request.files)
    if len(request.files) == 1 and not is_folder(output):
        check_output(output, _SOLUTION, request.inputs)
        return [output]
    there = is_folder_or_nothing(output)
    suffix = ".solution.jsonl" if request.every else ".solution.json"
    targets = [output / (file.stem + suffix) for file in request.files]
    for number, target in enumerate(targets):
        if target in targets[:number]:
            other = request.files[targets.index(target)]
            raise click.UsageError(f"{other} and {request.files[number]} would both go to {target}")
        if there:
            check_output(target, _SOLUTION, request.inputs)
    return list(targets)


def _solve(file: Path, target: Path | None, request: Request, deadline: Deadline) -> Result:
    """Solve one file and write what was found."""
    subject = read_subject(file, deadline, request.tolerance)
    instance = subject.graph(deadline)

    from cellcolor.door.solving import solve
    from cellcolor.solvers.checked import check_able_to_list

    if request.every:
        check_able_to_list(request.search["solver"], instance)
    with line_of(file, "solving") as show, end_the_search():

        def progress(segments: int | None, bound: int) -> None:
            best = "no division yet" if segments is None else f"best {segments}"
            show(f"{best}, at least {bound}")

        result = solve(subject, time_limit=deadline, progress=progress, **request.search)
    if request.picture is not None:
        from cellcolor.door.drawing import draw_search

        draw_search(result, request.picture)
    schemes: list[str] = []
    if request.every:
        result, schemes = _with_schemes(file, result, request, deadline)
    if target is not None:
        _write(target, result, schemes, request)
    return result


def _write(target: Path, result: Result, schemes: list[str], request: Request) -> None:
    """A solution, schemes after it, and beside it what had to be covered: surface or graph."""
    outputs = []
    if request.of_a_part and not is_stream(target):
        beside = target.with_name(f"{target.name.removesuffix(target.suffix)}.covered.json")
        covered = result.instance if result.surface is None else result.surface
        outputs = [Output.of(beside, covered)]
    if request.every:
        lines = [json.dumps(result.solution.to_document(), ensure_ascii=False), *schemes]
        outputs.append(Output(target, _SOLUTION, (f"{line}\n".encode() for line in lines)))
    else:
        outputs.append(Output.of(target, result.solution))
    with system_errors(target, "cannot be written"):
        target.parent.mkdir(parents=True, exist_ok=True)
    write(outputs, request.inputs)


def _with_schemes(
    file: Path, result: Result, request: Request, deadline: Deadline
) -> tuple[Result, list[str]]:
    """The result with all optimal schemes counted, and their lines."""
    from cellcolor.questions.listing_schemes import with_schemes

    if INTERRUPTS.seen:
        return replace(result, solution=replace(result.solution, schemes=0, complete=False)), []
    lines: list[str] = []
    with line_of(file, "looking for schemes") as show, end_the_search():

        def take(division: Division) -> None:
            lines.append(scheme_line(division))
            show(f"{count(len(lines), 'scheme')} so far")

        most = request.limit or _SCHEMES
        given = {name: request.search[name] for name in ("workers", "seed")}
        options = Options(deadline=deadline, **given)
        solver = request.search["solver"]
        solution = with_schemes(result.instance, result.solution, solver, options, most, take)
    # After a signal the last line may not be counted.
    return replace(result, solution=solution), lines[: solution.schemes]
