"""Experiments: ``bench run`` and the other commands of its group."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cellcolor.cli.ending import Exit
from cellcolor.cli.options import COUNT, PATH, Commands, Real, cellcolor, option, output_option
from cellcolor.cli.terminal import complain, line_of, say, say_lines
from cellcolor.data.wording import count
from cellcolor.errors import CellcolorError, InputError, SolverMissing
from cellcolor.solvers.registry import DEFAULT, PAPERS, REFERENCE

if TYPE_CHECKING:
    from cellcolor.lab.runs.sweep import Contestant, Specimen


def _numbers(value: str) -> tuple[int, ...]:
    """Numbers and ranges of them, such as ``0-9`` or ``3,7,10-12``."""
    found: list[int] = []
    for part in value.split(","):
        first, dash, last = part.strip().partition("-")
        if not first.isdecimal() or (dash and not last.isdecimal()):
            raise click.BadParameter(f"{value!r} is not a list like 0-9 or 3,7,10-12.")
        found += range(int(first), int(last or first) + 1)
    if not found:
        raise click.BadParameter(f"{value!r} contains no number.")
    return tuple(dict.fromkeys(found))


_TABLES = click.argument("tables", metavar="TABLE.csv…", nargs=-1, required=True, type=PATH)


@cellcolor.group(cls=Commands)
def bench() -> None:
    """Experiments: solvers compared, on families of instances and on files."""


@bench.command(of=("door.solving:solve",))
@click.argument("subjects", metavar="FAMILY|FILE…", nargs=-1, required=True)
@option(
    "--solver",
    str,
    "Solver; repeat the option for several.",
    to="solvers",
    default=(PAPERS, REFERENCE, DEFAULT),
    show_default=True,
    metavar="NAME[@WORKERS]",
    multiple=True,
)
@option("--seeds", _numbers, "Of families.  [default: 0-9]", default="0-9", metavar="N-M")
@option(
    "--time-limit",
    Real(0, 1e6, min_open=True),
    "Seconds for each solve; several are tried in turn.  [default: 10]",
    to="limits",
    default=(10.0,),
    multiple=True,
)
@option("--repetitions", COUNT, "Of each run, with other random numbers in the solver.", default=1)
@option("--search-space", click.Choice(["paper", "surface"]), default="paper")
@option(
    "--memory",
    COUNT,
    "For each run, MB; a run that needs more is killed.",
    to="megabytes",
    default=4096,
    show_default=True,
)
@option("--jobs", COUNT, "Number of processes at a time.", default=1)
@option(
    "--in-process",
    bool,
    "Start no processes: quicker, but nothing ends a solver that goes on, or takes the memory.",
    is_flag=True,
    default=False,
)
@output_option(
    "TABLE.csv", "A row for each run. An existing table is continued: its runs are not repeated."
)
def run(
    subjects: Sequence[str],
    solvers: Sequence[str],
    seeds: Sequence[int],
    jobs: int,
    in_process: bool,
    output: Path | None,
    **wanted: Any,
) -> Exit:
    """Run solvers on instances, each solve in a process of its own unless --in-process is given.

    FAMILY is a set of random families (small, medium, large, growing), the library of shipped
    graphs (library) or one family, such as medium/thin; * stands for anything. Solvers that are
    not installed are left out. Exit code 1 if two runs contradict each other.
    """
    from cellcolor.lab.runs.summary import summary_of_runs
    from cellcolor.lab.runs.sweep import Sweep, taking_turns
    from cellcolor.lab.runs.table import continued, disagreements

    groups = [list(taking_turns(_groups(text, seeds))) for text in subjects]
    contestants = list(_contestants(solvers))
    if not contestants:
        return Exit.BAD_INPUT
    bad: list[Specimen] = []
    interrupted = False

    def tell(subject: Specimen, error: CellcolorError) -> None:
        named = isinstance(error, InputError) and error.file
        complain(error if named else f"{subject.name}: {error}")
        bad.append(subject)

    with continued(output) as table:
        before = len(table.rows)
        sweep = Sweep(
            list(taking_turns(groups)),
            contestants,
            command=shlex.join(["cellcolor", *sys.argv[1:]]),
            done={row.key for row in table.rows},
            complain=tell,
            **wanted,
        )
        try:
            with line_of(Path("bench"), "solving") as show:
                for row in sweep.run(None if in_process else jobs):
                    table.append(row)
                    done = len(table.rows) - before + sweep.skipped
                    show(f"{done} of {sweep.runs}, {row.subject}: {row.contestant}")
        except KeyboardInterrupt:
            interrupted = True
            complain("interrupted")
    made, wrong = table.rows[before:], disagreements(table.rows)
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


@bench.command()
@_TABLES
@option(
    "--pair",
    str,
    "Compare these two by paired tests, with intervals.",
    default=None,
    metavar="NAME NAME",
    nargs=2,
)
def summary(tables: tuple[Path, ...], pair: tuple[str, str] | None) -> Exit:
    """Sum tables up as Markdown; exit code 1 if two runs contradict each other."""
    from cellcolor.lab.runs.summary import summary_of_runs
    from cellcolor.lab.runs.table import disagreements, read_table

    rows = [row for path in tables for row in read_table(path)]
    if not rows:
        raise InputError(str(tables[0]), None, "has no rows")
    say_lines("\n".join(summary_of_runs(rows)))
    if pair is not None:
        from cellcolor.lab.runs.pairs import paired

        say_lines("\n".join(paired(rows, *pair)))
    return Exit.INVALID if disagreements(rows) else Exit.DONE


def _groups(text: str, seeds: Sequence[int]) -> list[list[Specimen]]:
    """What an argument stands for: random families, those of the library, or a file."""
    from cellcolor.cli.inputs import read_instance
    from cellcolor.door.installed import find_file, library
    from cellcolor.lab.runs.sweep import Specimen, families

    if found := families(text, seeds):
        return found
    if text.partition("/")[0] != "library" or Path(text).exists():
        file = find_file(text)
        make = partial(read_instance, file)
        return [[Specimen(file.resolve().parent.name, None, str(file), make)]]
    wanted = "library/*" if text == "library" else text
    shipped: dict[str, list[Specimen]] = {}
    for entry in library().index.entries:
        family = f"library/{entry.family}"
        if entry.file is not None and fnmatchcase(family, wanted):
            make = partial(read_instance, find_file(entry.name))
            shipped.setdefault(family, []).append(Specimen(family, None, entry.name, make))
    if not shipped:
        raise InputError(None, None, f"{text}: matches no family of the library")
    return list(shipped.values())


def _contestants(names: Sequence[str]) -> Iterator[Contestant]:
    """The solvers that are installed; each of the others gets a line."""
    from cellcolor.lab.runs.sweep import contestant

    for name in dict.fromkeys(names):
        try:
            yield contestant(name)
        except SolverMissing as error:
            complain(f"left out: {error}")
