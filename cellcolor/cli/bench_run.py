"""``cellcolor bench run``: families and files, solvers, and a table of their runs."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from fnmatch import fnmatchcase
from functools import partial
from pathlib import Path
from typing import Any

from cellcolor.cli.ending import Exit
from cellcolor.cli.inputs import read_instance
from cellcolor.cli.terminal import complain, progress_bar, say, say_lines, shown
from cellcolor.data.wording import count
from cellcolor.door.installed import find_file, library
from cellcolor.errors import CellcolorError, InputError, SolverMissing
from cellcolor.lab.runs.row import Row, disagreements
from cellcolor.lab.runs.summary import summary_of_runs
from cellcolor.lab.runs.sweep import (
    Contestant,
    Specimen,
    Sweep,
    contestant,
    families_like,
    of_family,
    taking_turns,
)
from cellcolor.lab.runs.table import TableFile
from cellcolor.lab.workers import Workers

_LIBRARY = "library"
"""Stands before the families of the library's graphs (docs/library.md)."""


def run_solvers(
    subjects: Sequence[str],
    solvers: Sequence[str],
    seeds: Sequence[int],
    jobs: int,
    output: Path | None,
    **wanted: Any,
) -> Exit:
    """Make the runs, keep each of them at once, and print what came of them.

    Args:
        wanted: what else :class:`~cellcolor.lab.runs.sweep.Sweep` has of the options.
    """
    specimens = list(taking_turns([list(_subjects(text, seeds)) for text in subjects]))
    contestants = list(_contestants(solvers))
    if not contestants:
        return Exit.BAD_INPUT
    table: AbstractContextManager[TableFile | None] = (
        nullcontext() if output is None else TableFile(output)
    )
    bad: list[Specimen] = []
    interrupted = False

    def tell(subject: Specimen, error: CellcolorError) -> None:
        named = isinstance(error, InputError) and error.file
        complain(error if named else f"{subject.name}: {error}")
        bad.append(subject)

    with table as file:
        before = list(file.rows) if file else []
        sweep = Sweep(
            specimens,
            contestants,
            command=shlex.join(["cellcolor", *sys.argv[1:]]),
            done={row.key for row in before},
            complain=tell,
            **wanted,
        )
        made: list[Row] = []
        total = len(specimens) * sweep.runs_of_each
        try:
            with Workers(jobs) as workers, progress_bar(total) as advance:
                for row in sweep.run(workers):
                    made.append(row)
                    if file is not None:
                        file.append(row)
                    advance(len(made) + sweep.skipped, f"{shown(row.subject)}: {row.contestant}")
        except KeyboardInterrupt:
            interrupted = True
            complain("interrupted")
    wrong = disagreements([*before, *made])
    if made:
        say_lines("\n".join(summary_of_runs(made)))
    already = f", {sweep.skipped} left out or already there" if sweep.skipped else ""
    proved = sum(row.solved for row in made)
    if made or not bad:  # otherwise what is wrong is all there is to say
        say(f"{count(len(made), 'run')}, {proved} with a proved minimum{already}")
    for line in wrong:
        complain(line)
    if bad:
        return Exit.BAD_INPUT
    if wrong:
        return Exit.INVALID
    return Exit.STOPPED if interrupted else Exit.DONE


def _subjects(text: str, seeds: Sequence[int]) -> Iterator[Specimen]:
    """What an argument stands for: families, the library, shipped files by a pattern, a file."""
    families = families_like(text)
    if families:
        yield from taking_turns([of_family(name, seeds) for name in families])
        return
    if text.partition("/")[0] == _LIBRARY and not Path(text).exists():
        yield from taking_turns(_shipped_families(text))
        return
    patterned = any(letter in text for letter in "*?[") and not Path(text).exists()
    names = [name for name in library() if fnmatchcase(name, text)] if patterned else [text]
    if not names:
        raise InputError(None, None, f"{text}: matches no family and no shipped name")
    for name in names:
        file = find_file(name)
        family = file.resolve().parent.name
        yield Specimen(family, None, str(file), partial(read_instance, file))


def _shipped_families(pattern: str) -> list[list[Specimen]]:
    """The graphs of the library whose family, as ``library/family``, is like a pattern."""
    wanted = f"{_LIBRARY}/*" if pattern == _LIBRARY else pattern
    families: dict[str, list[Specimen]] = {}
    for entry in library().index.entries:
        family = f"{_LIBRARY}/{entry.family}"
        if entry.file is not None and fnmatchcase(family, wanted):
            make = partial(read_instance, find_file(entry.name))
            families.setdefault(family, []).append(Specimen(family, None, entry.name, make))
    if not families:
        raise InputError(None, None, f"{pattern}: matches no family of the library")
    return list(families.values())


def _contestants(names: Sequence[str]) -> Iterator[Contestant]:
    """The solvers that are installed; each of the others gets a line."""
    for name in dict.fromkeys(names):
        try:
            yield contestant(name)
        except SolverMissing as error:
            complain(f"left out: {error}")
