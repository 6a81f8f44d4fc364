"""``cellcolor solve``: the fewest segments of each file."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from cellcolor.checker.claimed_numbers import contradictions
from cellcolor.cli.ending import INTERRUPTS, Exit, worst
from cellcolor.cli.inputs import read_subject
from cellcolor.cli.tables import nothing_to_cover, print_solution
from cellcolor.cli.terminal import complain, line_of, print_json
from cellcolor.data.solution import Division, Solution, scheme_line
from cellcolor.data.wording import count
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.door.subject import Result
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
from cellcolor.solvers.interface import Options
from cellcolor.solvers.registry import solver_names

_SOLUTION = kind_of_format(Solution.FORMAT)


class Interrupted(OutOfTime, KeyboardInterrupt):
    """A signal that a solver takes for the time limit; it hands over the best it has."""


def solve_files(
    files: Sequence[Path],
    *,
    output: Path | None,
    tolerance: str | None,
    schemes: int | None,
    seconds: float | None,
    first: Deadline | None,
    as_json: bool,
    **search: Any,
) -> Exit:
    """Solve every file; a bad one does not stop the others.

    Args:
        schemes: how many optimal schemes are listed at most; None lists none.
        seconds: the time limit of each file.
        first: when they are over for the first file, for which starting the command counts.
        search: what goes on to the front door's ``solve``.
    """
    targets = _targets(files, output, schemes is not None)
    _check_able(search, schemes is not None)
    of_a_part = "cover" in search or search["left_alone"] is not None
    codes: list[Exit] = []

    def failed(code: Exit, message: str, **known: str) -> None:
        complain(message)
        if as_json:
            print_json({"file": str(file)} | known | {"error": message})
        codes.append(code)

    for file, target in zip(files, targets, strict=True):
        deadline, first = first or Deadline.after(seconds), None
        try:
            result, lines = _solve(file, deadline, tolerance, schemes, search)
            if target is not None:
                _write(target, result, lines, files, of_a_part)
        except Interrupted:
            failed(Exit.STOPPED, f"{file}: interrupted, nothing found yet")
        except OutOfTime:
            message = f"{file}: unknown: the time limit came before any division was found"
            failed(Exit.STOPPED, message, status="unknown")
        except CellcolorError as error:
            named = isinstance(error, InputError) and error.file
            failed(Exit.BAD_INPUT, str(error) if named else f"{file}: {error}")
        else:
            codes.append(_told(file, result, of_a_part, as_json))
        if INTERRUPTS.seen:
            break
    return worst([*codes, Exit.STOPPED] if len(codes) < len(files) else codes)


def _told(file: Path, result: Result, of_a_part: bool, as_json: bool) -> Exit:
    """Print one result; the exit code that it stands for."""
    instance, solution = result.instance, result.solution
    wrong = contradictions(instance, solution)
    if as_json:
        fault = {"error": "; ".join(wrong)} if wrong else {}
        share = {"covered_share": result.covered_share} if of_a_part else {}
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


def _check_able(search: dict[str, Any], every: bool) -> None:
    """Refuse at once what the solver cannot do for any file.

    What every solver can do is not asked about: bad input has to import no solver.
    """
    options = Options(search.get("search_space", "paper"), search.get("strands"))  # type: ignore[arg-type]
    if (solver := search["solver"]) not in (known := solver_names()):
        message = f"{solver!r} is not one of {', '.join(known)}"
        raise click.BadParameter(message, param_hint="--solver")
    if every or options.search_space != "paper":
        from cellcolor.solvers.checked import check_able

        check_able(search["solver"], options, schemes=every)


def _targets(files: Sequence[Path], output: Path | None, every: bool) -> list[Path | None]:
    """Where each input's solution goes; refuses what could lose a file."""
    if output is None:
        return [None] * len(files)
    if len(files) == 1 and not is_folder(output):
        check_output(output, _SOLUTION, files)
        return [output]
    there = is_folder_or_nothing(output)
    suffix = ".solution.jsonl" if every else ".solution.json"
    targets = [output / (file.stem + suffix) for file in files]
    for number, target in enumerate(targets):
        if target in targets[:number]:
            other = files[targets.index(target)]
            raise click.UsageError(f"{other} and {files[number]} would both go to {target}")
        if there:
            check_output(target, _SOLUTION, files)
    return list(targets)


def _solve(
    file: Path,
    deadline: Deadline,
    tolerance: str | None,
    most: int | None,
    search: dict[str, Any],
) -> tuple[Result, list[str]]:
    """The result of one file, and the lines of its optimal schemes."""
    subject = read_subject(file, deadline, tolerance)
    instance = subject.graph(deadline)

    from cellcolor.door.solving import solve
    from cellcolor.solvers.checked import check_able_to_list

    if most is not None:
        check_able_to_list(search["solver"], instance)
    with line_of(file, "solving") as show, INTERRUPTS.turned_into(Interrupted):

        def progress(segments: int | None, bound: int) -> None:
            best = "no division yet" if segments is None else f"best {segments}"
            show(f"{best}, at least {bound}")

        result = solve(subject, time_limit=deadline, progress=progress, **search)
    return (result, []) if most is None else _with_schemes(file, result, deadline, most, search)


def _write(
    target: Path, result: Result, schemes: list[str], inputs: Sequence[Path], of_a_part: bool
) -> None:
    """A solution, schemes after it, and beside it what had to be covered: surface or graph."""
    outputs = []
    if of_a_part and not is_stream(target):
        beside = target.with_name(f"{target.name.removesuffix(target.suffix)}.covered.json")
        covered = result.instance if result.surface is None else result.surface
        outputs = [Output.of(beside, covered)]
    if result.solution.schemes is not None:
        lines = [json.dumps(result.solution.to_document(), ensure_ascii=False), *schemes]
        outputs.append(Output(target, _SOLUTION, (f"{line}\n".encode() for line in lines)))
    else:
        outputs.append(Output.of(target, result.solution))
    with system_errors(target, "cannot be written"):
        target.parent.mkdir(parents=True, exist_ok=True)
    write(outputs, inputs)


def _with_schemes(
    file: Path, result: Result, deadline: Deadline, most: int, search: dict[str, Any]
) -> tuple[Result, list[str]]:
    """The result with all optimal schemes counted, and their lines."""
    from cellcolor.door.solving import with_schemes

    if INTERRUPTS.seen:
        return replace(result, solution=replace(result.solution, schemes=0, complete=False)), []
    lines: list[str] = []
    with line_of(file, "looking for schemes") as show, INTERRUPTS.turned_into(Interrupted):

        def take(division: Division) -> None:
            lines.append(scheme_line(division))
            show(f"{count(len(lines), 'scheme')} so far")

        own = {name: search[name] for name in ("workers", "seed") if name in search}
        options = Options(deadline=deadline, **own)
        of = result.instance, result.solution, search["solver"]
        solution = with_schemes(*of, options, most, take)
    # After a signal the last line may not be counted.
    return replace(result, solution=solution), lines[: solution.schemes]
