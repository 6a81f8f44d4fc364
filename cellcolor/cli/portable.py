"""``cellcolor export`` and ``cellcolor answer``: to a solver from outside, and back."""

from __future__ import annotations

from pathlib import Path

from cellcolor.checker.division import check_solution
from cellcolor.cli.exits import Exit
from cellcolor.cli.inputs import read_instance
from cellcolor.cli.terminal import apart_from, say
from cellcolor.data.instance import Instance
from cellcolor.data.solution import InstanceReference, Solution, count_segments
from cellcolor.data.wording import count
from cellcolor.errors import InputError
from cellcolor.files.documents import read_text
from cellcolor.files.writing import Output, check_output, kind_of_format, write
from cellcolor.solvers.answers import OutsideAnswer, read_answer
from cellcolor.solvers.portable import PORTABLE

_SOLUTION = kind_of_format(Solution.FORMAT)


def export_file(source: Path, output: Path, kind: str) -> Exit:
    """Write an instance in a format of ``PORTABLE``."""
    form = PORTABLE[kind]
    check_output(output, form.kind, [source])
    with apart_from(output):
        instance = read_instance(source)
        try:
            lines = form.write(instance)
        except InputError as error:
            raise error.in_file(str(source)) from error
        content = (f"{line}\n".encode() for line in lines)
        write([Output(output, form.kind, content)], [source])
        say(f"wrote {output}, for {form.about}")
    return Exit.DONE


def answer_file(source: Path, given: Path, kind: str, output: Path) -> Exit:
    """Write the solution that an answer describes."""
    inputs = [source, given]
    check_output(output, _SOLUTION, inputs)
    with apart_from(output):
        instance = read_instance(source)
        try:
            found = read_answer(instance, read_text(given), kind)
            solution = _checked(instance, found, kind)
        except InputError as error:
            raise error.in_file(str(given)) from error
        write([Output(output, _SOLUTION, [solution.to_json().encode()])], inputs)
        say(f"wrote {output}: {count(solution.segments or 0, 'segment')}")
        for note in solution.notes:
            say(note)
    return Exit.DONE


def _checked(instance: Instance, found: OutsideAnswer, kind: str) -> Solution:
    """The solution, seen by the checker, with nothing in it that the answer does not prove."""
    segments = count_segments(found.division)
    if found.segments is not None and segments > found.segments:
        message = f"says {found.segments}, its division has {count(segments, 'segment')}"
        raise InputError(None, "objective", message)
    claim = "The external solver claims that no division has fewer segments; this is not a proof."
    solution = Solution(
        instance=InstanceReference(instance.name, instance.sha256),
        search_space="paper",
        strands=1,
        solver=f"outside ({kind})",
        status="feasible",
        segments=segments,
        lift_offs=max(0, segments - 1),
        lower_bound=0,
        surface_lower_bound=0,
        proved_for_surface=segments == 0,
        seams=found.seams,
        cells=found.division,
        seconds=0.0,
        bounds=(),
        coverage=instance.coverage,
        notes=(claim,) if found.claims_optimum else (),
    )
    report = check_solution(instance, solution)
    if not report.valid:
        raise InputError(None, None, f"is not a legal division: {report.problems[0]}")
    return solution
