"""The commands about the instance library: ``library`` and ``import``."""

from __future__ import annotations

from pathlib import Path

import click

from cellcolor.cli.commands.group import cellcolor
from cellcolor.cli.commands.options import PATH


@cellcolor.command()
@click.option("--family", metavar="NAME", help="Only the graphs of this family.")
@click.option(
    "--open", "only_open", is_flag=True, help="Only graphs whose minimum is open in a search space."
)
@click.option(
    "--json", "as_json", is_flag=True, help="Print JSON Lines, one entry of the index per line."
)
def library(family: str | None, only_open: bool, as_json: bool) -> int:
    """List the graphs of the instance library, with what is known of their minima.

    Commands take them by name, and check takes the stored solution of one as NAME.solution.json.
    """
    from cellcolor.cli.library import list_library

    return list_library(family, only_open, as_json)


@cellcolor.command(name="import")
@click.argument("source", metavar="PROBLEM.txt", type=PATH)
@click.option(
    "-o", "--output", metavar="INSTANCE.json", required=True, type=PATH, help="The instance."
)
@click.option(
    "--correct",
    "corrections",
    metavar="EDGE=A,B",
    multiple=True,
    help="Correct cells beside an edge if the file has them wrong, -1 for the outside.",
)
def import_(source: Path, output: Path, corrections: tuple[str, ...]) -> int:
    """Make an instance of a graph in the text format of IMCGS, the paper's authors' solver.

    It is named after INSTANCE.json. Files that contradict themselves are refused: what is wrong in
    them is said by --correct, and written into the instance.
    """
    from cellcolor.cli.library import import_graph

    return import_graph(source, output, corrections)
