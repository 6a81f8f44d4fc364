"""``cellcolor campaign``: every solver against every other, on random instances."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rich import box
from rich.table import Table

from cellcolor.cli.exits import Exit
from cellcolor.cli.tables import console
from cellcolor.cli.terminal import complain
from cellcolor.data import instance as instance_file
from cellcolor.data import surface as surface_file
from cellcolor.errors import InputError
from cellcolor.files.temporary import remove_strays
from cellcolor.files.writing import Output, is_folder_or_nothing, kind_of_format, write
from cellcolor.lab.campaign.pool import Outcome, outcomes_of_campaign
from cellcolor.lab.campaign.summary import Summary, Tally


def run_campaign(count: int, seed: int, time_limit: float, jobs: int, output: Path) -> Exit:
    """Run a campaign, print what it looked at, and keep what went wrong."""
    if is_folder_or_nothing(output):
        remove_strays(output)
    summary = Summary()
    started = time.monotonic()
    interrupted = False
    with _progress(count) as advance:
        try:
            for outcome in outcomes_of_campaign(count, seed, time_limit, jobs):
                summary.add(outcome)
                _keep(outcome, seed, output)
                advance(summary)
        except KeyboardInterrupt:
            interrupted = True
            complain("interrupted")
    _print(summary, seed, time.monotonic() - started)
    if summary.total.disagreements:
        return Exit.INVALID
    undecided = summary.total.proved < summary.total.instances
    return Exit.STOPPED if interrupted or undecided else Exit.DONE


def _keep(outcome: Outcome, seed: int, output: Path) -> None:
    """Write each disagreement to a file of its own."""
    for wrong in outcome.wrong:
        mesh = json.loads(wrong.document)["format"] == surface_file.FORMAT
        name = f"campaign_{seed}_{outcome.number}{'.surface' if mesh else ''}.json"
        try:
            output.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(str(output), None, error.strerror or "cannot be made") from error
        kind = kind_of_format(surface_file.FORMAT if mesh else instance_file.FORMAT)
        write([Output(output / name, kind, [wrong.document.encode()])])
        complain(f"{output / name}: {wrong.message}")


@contextmanager
def _progress(count: int) -> Iterator[Callable[[Summary], None]]:
    """A bar on standard error, only where somebody watches."""
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
    from rich.progress import TimeElapsedColumn as Elapsed
    from rich.progress import TimeRemainingColumn as Remaining

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    bar = Progress(*columns, Elapsed(), Remaining(), console=Console(stderr=True), transient=True)
    with bar:
        task = bar.add_task("no disagreement", total=count)

        def advance(summary: Summary) -> None:
            wrong = summary.total.disagreements
            text = f"{wrong} disagreements" if wrong else "no disagreement"
            bar.update(task, completed=summary.total.instances, description=text)

        yield advance


def _print(summary: Summary, seed: int, seconds: float) -> None:
    out = console()
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("kind")
    columns = ("instances", "minima proved", "scheme sets", "always cut", "meshes", "alike")
    for name in (*columns, "disagreements", "seconds"):
        table.add_column(name, justify="right")
    for name, kind in sorted(summary.kinds.items()):
        table.add_row(name, *_row(kind))
    table.add_section()
    table.add_row("all", *_row(summary.total))
    out.print(table)
    out.print("scheme sets: all optimal schemes, the same from every solver; always cut: of these,")
    out.print("with a cutting path in every optimum; meshes: search space surface against all")
    out.print("colorings of the vertices; alike: of these, with equal minima, the others being too")
    out.print("coarse for a corridor; seconds: of all processes")
    out.print()
    for name, bins in summary.histograms().items():
        if bins:
            out.print(f"{name}: " + ", ".join(f"{values}: {count}" for values, count in bins))
    out.print(f"seed {seed}, {summary.total.instances} instances in {seconds:.0f} s")


def _row(kind: Tally) -> list[str]:
    counts = (
        kind.instances,
        kind.proved,
        kind.scheme_sets,
        kind.always_cut,
        kind.meshes,
        kind.meshes_alike,
        kind.disagreements,
    )
    return [*map(str, counts), f"{kind.seconds:.0f}"]
