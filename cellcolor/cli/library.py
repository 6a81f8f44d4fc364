"""``cellcolor library`` and ``cellcolor import``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from rich import box
from rich.table import Table

from cellcolor.cli.exits import Exit
from cellcolor.cli.tables import console
from cellcolor.cli.terminal import apart_from, print_json, say
from cellcolor.data.imcgs import read_imcgs
from cellcolor.data.instance import Instance
from cellcolor.data.library_index import LibraryEntry
from cellcolor.data.solution import Solution
from cellcolor.data.solution_verdict import SolutionVerdict
from cellcolor.data.wording import count, listed
from cellcolor.door.shipped import library
from cellcolor.errors import InputError
from cellcolor.files.writing import Output, check_output, kind_of_format, write

_INSTANCE = kind_of_format(Instance.FORMAT)


def list_library(family: str | None, only_open: bool, as_json: bool) -> Exit:
    """Print the entries of the index, as a table or as JSON Lines."""
    entries = library().index.entries
    families = sorted({entry.family for entry in entries})
    if family is not None and family not in families:
        raise InputError(None, "--family", f"there is no {family!r}, only {listed(families)}")
    chosen = [
        entry
        for entry in entries
        if family in (None, entry.family) and (entry.is_open or not only_open)
    ]
    if as_json:
        for entry in chosen:
            print_json(asdict(entry))
        return Exit.DONE
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for name in ("name", "family"):
        table.add_column(name, overflow="fold")
    for name in ("cells", "darts", "loops", "colors", "holes", "paper", "any division", "verified"):
        table.add_column(name, justify="right")
    for entry in chosen:
        table.add_row(*_row(entry))
    console().print(table)
    console().print(
        f"{count(len(chosen), 'graph')}. darts, loops: live ones of the cell that has most; paper, "
        "any division: where the fewest\nsegments lie; verified: the lower bound for any division "
        "has a certificate of that kind, which needs no solver"
    )
    return Exit.DONE


def _row(entry: LibraryEntry) -> list[str]:
    numbers = (entry.cells, entry.darts, entry.loops, entry.colors, entry.holes)
    lower = entry.surface.lower
    return [
        entry.name,
        entry.family,
        *map(str, numbers),
        str(entry.paper),
        str(entry.surface),
        lower.kind if lower.verified else "",
    ]


def import_graph(source: Path, output: Path, corrections: Sequence[str]) -> Exit:
    """Write the instance that a file in the text format of IMCGS becomes."""
    check_output(output, _INSTANCE, [source])
    instance = read_imcgs(source, corrections, output.name.removesuffix(".json"))
    write([Output(output, _INSTANCE, [instance.to_json().encode()])], [source])
    with apart_from(output):
        say(f"wrote {output}: {str(instance).partition(': ')[2]}")
        for entry in library().index.entries:
            if entry.fingerprint == instance.sha256:
                say(f"This is {entry.name} of the library: {entry.paper} segments.")
    return Exit.DONE


def say_better(instance: Instance, solution: Solution, verdict: SolutionVerdict) -> None:
    """Say where a valid solution is better than the index, and how to send it.

    A bound counts if its certificate was verified, so that nothing is taken on trust.
    """
    bounds = [(b.holds_for, b.value, True) for b in verdict.bounds if b.outcome == "verified"]
    for entry in library().index.entries:
        if entry.fingerprint == instance.sha256 and (found := entry.beaten_by(solution, bounds)):
            for line in found:
                say(f"  better than the library's index: {line}")
            name = f"{entry.name}.{'surface.' * (solution.search_space == 'surface')}solution.json"
            say(f"  please send it as {name} (docs/library.md, How to contribute a better bound)")
