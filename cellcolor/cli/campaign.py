"""``cellcolor bench campaign``: every solver against every other, on random instances."""

from __future__ import annotations

import json
import time
from pathlib import Path

from rich import box
from rich.table import Table

from cellcolor.cli.ending import Exit
from cellcolor.cli.progress import progress_bar, workers_for
from cellcolor.cli.tables import console
from cellcolor.cli.terminal import complain
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import system_errors
from cellcolor.files.temporary import remove_strays
from cellcolor.files.writing import Output, is_folder_or_nothing, kind_of_format, write
from cellcolor.lab.campaign.pool import Outcome, Summary, Tally, outcomes_of_campaign


def run_campaign(
    count: int, seed: int, time_limit: float, jobs: int, cluster: str | None, output: Path
) -> Exit:
    """Run a campaign, print what it looked at, and keep what went wrong."""
    if is_folder_or_nothing(output):
        remove_strays(output)
    summary = Summary()
    started = time.monotonic()
    interrupted = False
    try:
        with workers_for(jobs, cluster) as workers, progress_bar(count) as advance:
            for outcome in outcomes_of_campaign(count, seed, time_limit, workers):
                summary.add(outcome)
                _keep(outcome, seed, output)
                wrong = summary.total.disagreements
                text = f"{wrong} disagreements" if wrong else "no disagreement"
                advance(summary.total.instances, text)
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
        mesh = json.loads(wrong.document)["format"] == LabelledSurface.FORMAT
        name = f"campaign_{seed}_{outcome.number}{'.surface' if mesh else ''}.json"
        with system_errors(output, "cannot be made"):
            output.mkdir(parents=True, exist_ok=True)
        kind = kind_of_format(LabelledSurface.FORMAT if mesh else Instance.FORMAT)
        write([Output(output / name, kind, [wrong.document.encode()])])
        complain(f"{output / name}: {wrong.message}")


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
