"""For and from other programs: ``export``, ``answer``, ``import``, ``label`` and ``library``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cellcolor.cli.ending import Exit
from cellcolor.cli.options import (
    INPUT,
    LENGTH,
    PATH,
    TIME_LIMIT,
    cellcolor,
    json_option,
    keywords,
    option,
    output_option,
)
from cellcolor.cli.terminal import at_work, print_json, say, say_lines
from cellcolor.data.wording import count
from cellcolor.deadline import Deadline
from cellcolor.errors import InputError, RefusedResult, naming
from cellcolor.files.writing import Output, check_output, kind_of_format, write

_ANSWERED = ("opb", "wcnf", "mps", "dzn", "lp")
_FORMATS = ("pbtxt", "pb", *_ANSWERED)


@cellcolor.command()
@click.argument("source", metavar="FILE", type=INPUT)
@output_option("OUT", "The model's file.", required=True)
@option(
    "--format",
    click.Choice(_FORMATS),
    "pbtxt, pb: the complete model for CP-SAT. opb: pseudo-Boolean. wcnf: MaxSAT. mps: "
    "mixed-integer programs. dzn: data for MiniZinc. lp: facts for answer set programs.  [default: "
    "from the ending of OUT]",
    to="kind",
)
def export(source: Path, output: Path, kind: str | None) -> Exit:
    """Write an instance for a solver from outside, in the search space paper.

    FILE is an instance, a labelled surface or a scene. What the solver answers, the command answer
    turns into a solution.
    """
    kind = kind or output.suffix.removeprefix(".")
    if kind not in _FORMATS:
        endings = ", ".join(f".{name}" for name in _FORMATS)
        message = f"{output} does not end in any of {endings}."
        raise click.BadParameter(message, param_hint="-o")

    from cellcolor.cli.inputs import read_instance
    from cellcolor.solvers.portable import PORTABLE

    form = PORTABLE[kind]
    check_output(output, form.kind, [source])
    instance = read_instance(source)
    with naming(source):
        content = form.write(instance)
    write([Output(output, form.kind, content)], [source])
    say(f"wrote {output}, for {form.about}")
    return Exit.DONE


@cellcolor.command()
@click.argument("source", metavar="FILE", type=INPUT)
@click.argument("given", metavar="ANSWER", type=PATH)
@option(
    "--format",
    click.Choice(_ANSWERED),
    "The format that the solver was given: opb and wcnf for lines v, mps for a file of names and "
    "values, dzn for what coloring.mzn prints, lp for what clingo prints.",
    to="kind",
    required=True,
)
@output_option("SOLUTION.json", "The solution.", required=True)
def answer(source: Path, given: Path, kind: str, output: Path) -> Exit:
    """Turn the answer of a solver from outside into a solution, once the checker has passed it.

    FILE is what was exported. An answer is no proof: the solution has no bounds, and says so if the
    solver claims the optimum.
    """
    from cellcolor.cli.inputs import read_instance
    from cellcolor.data.solution import Solution
    from cellcolor.files.documents import read_text
    from cellcolor.solvers.checked import checked_solution
    from cellcolor.solvers.interface import Options
    from cellcolor.solvers.portable import read_answer

    inputs = [source, given]
    check_output(output, kind_of_format(Solution.FORMAT), inputs)
    instance = read_instance(source)
    with naming(given):
        found = read_answer(instance, read_text(given), kind)
        try:
            solution = checked_solution(instance, Options(), f"outside ({kind})", found, 0.0)
        except RefusedResult as error:
            raise InputError(None, None, f"is not a legal division: {error}") from error
    write([Output.of(output, solution)], inputs)
    say(f"wrote {output}: {count(solution.segments or 0, 'segment')}")
    for note in solution.notes:
        say(note)
    return Exit.DONE


@cellcolor.command(name="import")
@click.argument("source", metavar="PROBLEM.txt", type=PATH)
@output_option("INSTANCE.json", "The instance.", required=True)
@option(
    "--correct",
    str,
    "Correct cells beside an edge if the file has them wrong, -1 for the outside.",
    to="corrections",
    metavar="EDGE=A,B",
    multiple=True,
)
def import_(source: Path, output: Path, corrections: tuple[str, ...]) -> Exit:
    """Make an instance of a graph in the text format of IMCGS, the paper's authors' solver.

    It is named after INSTANCE.json. Files that contradict themselves are refused: what is wrong in
    them is said by --correct, and written into the instance.
    """
    from cellcolor.data.imcgs import read_imcgs
    from cellcolor.data.instance import Instance
    from cellcolor.door.installed import library

    check_output(output, kind_of_format(Instance.FORMAT), [source])
    instance = read_imcgs(source, corrections, output.name.removesuffix(".json"))
    write([Output.of(output, instance)], [source])
    say(f"wrote {output}: {instance.size}")
    for entry in library().index.entries:
        if entry.fingerprint == instance.sha256:
            say(f"This is {entry.name} of the library: {entry.paper} segments.")
    return Exit.DONE


@cellcolor.command()
@json_option("Print JSON Lines, an entry of the library's index on each, with all that is known.")
def library(as_json: bool) -> Exit:
    """List the names that can replace a file: scenes, robots, and the graphs of the library.

    Of graphs the line says what is known of the minimum in search space paper. The command check
    takes the stored solution of a graph as NAME.solution.json.
    """
    from dataclasses import asdict

    from cellcolor.door.installed import library as shipped

    if as_json:
        for entry in shipped().index.entries:
            print_json(asdict(entry))
    else:
        say_lines(shipped())
    return Exit.DONE


@cellcolor.command(of=("door.reading:label",))
@click.argument("source", metavar="JOINTS.(npz|json|csv)", type=PATH)
@output_option("SURFACE.json", "The labelled surface.", required=True)
@keywords(mesh=PATH)
@option("--cut", bool, "Cut colors that have two solutions of a vertex.")
@option("--reach", LENGTH, to="reach_m")
@TIME_LIMIT
def label(source: Path, output: Path, cut: bool, time_limit: Deadline, **wanted: Any) -> Exit:
    """Make a labelled surface of joint solutions at the vertices of a mesh, without a robot.

    Solutions of neighboring vertices that are clearly the nearest to each other belong to one
    color. What is doubtful is listed.
    """
    from cellcolor.data.surface import LabelledSurface
    from cellcolor.door.reading import label as labelled

    inputs = [source, *filter(None, [wanted.get("mesh")])]
    check_output(output, kind_of_format(LabelledSurface.FORMAT), inputs)
    with at_work(source, "matching"):
        wanted["conflicts"] = "cut" if cut else "refuse"
        found = labelled(source, deadline=time_limit, **wanted)
    say_lines(found)
    write([Output.of(output, found.surface)], [source])
    say(f"wrote {output}")
    return Exit.DONE
