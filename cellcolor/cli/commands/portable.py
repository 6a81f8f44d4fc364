"""The commands for solvers from outside: ``export`` and ``answer``."""

from __future__ import annotations

from pathlib import Path

import click

from cellcolor.cli.commands.group import cellcolor
from cellcolor.cli.commands.options import INPUT, PATH

_FORMATS = ("opb", "wcnf", "mps", "dzn", "lp")


@cellcolor.command()
@click.argument("source", metavar="FILE", type=INPUT)
@click.option("-o", "--output", metavar="OUT", required=True, type=PATH, help="The model's file.")
@click.option(
    "--format",
    "kind",
    type=click.Choice(_FORMATS),
    help="opb: pseudo-Boolean. wcnf: MaxSAT. mps: mixed-integer programs. dzn: data for MiniZinc. "
    "lp: facts for answer set programs.  [default: from the ending of OUT]",
)
def export(source: Path, output: Path, kind: str | None) -> int:
    """Write an instance for a solver from outside, in the search space paper.

    FILE is an instance, a labelled surface or a scene. What the solver answers, the command answer
    turns into a solution.
    """
    from cellcolor.cli.portable import export_file

    return export_file(source, output, kind or _by_ending(output, "-o"))


@cellcolor.command()
@click.argument("source", metavar="FILE", type=INPUT)
@click.argument("given", metavar="ANSWER", type=PATH)
@click.option(
    "--format",
    "kind",
    type=click.Choice(_FORMATS),
    required=True,
    help="The format that the solver was given: opb and wcnf for lines v, mps for a file of names "
    "and values, dzn for what coloring.mzn prints, lp for what clingo prints.",
)
@click.option(
    "-o", "--output", metavar="SOLUTION.json", required=True, type=PATH, help="The solution."
)
def answer(source: Path, given: Path, kind: str, output: Path) -> int:
    """Turn the answer of a solver from outside into a solution, once the checker has passed it.

    FILE is what was exported. An answer is no proof: the solution has no bounds, and says so if the
    solver claims the optimum.
    """
    from cellcolor.cli.portable import answer_file

    return answer_file(source, given, kind, output)


def _by_ending(path: Path, option: str) -> str:
    ending = path.suffix.removeprefix(".")
    if ending not in _FORMATS:
        endings = ", ".join(f".{name}" for name in _FORMATS)
        raise click.BadParameter(f"{path} does not end in any of {endings}.", param_hint=option)
    return ending
