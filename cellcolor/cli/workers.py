"""Who does the work of experiments, and how far it is."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from cellcolor.door.extras import extras_for
from cellcolor.lab.executors.local import LocalWorkers
from cellcolor.lab.executors.work import Workers


def workers_for(jobs: int, cluster: str | None) -> Workers:
    """Processes of this machine, or those of a Dask cluster.

    Args:
        jobs: pieces of work at a time; a cluster says itself how many it does.
        cluster: the address of its scheduler.

    Raises:
        InputError: there is no such cluster, or no Dask.
    """
    if cluster is None:
        return LocalWorkers(jobs)
    with extras_for("--cluster"):
        from cellcolor.lab.executors.cluster import ClusterWorkers
    return ClusterWorkers(cluster)


@contextmanager
def progress_bar(total: int) -> Iterator[Callable[[int, str], None]]:
    """A bar on standard error, only where somebody watches; told what is done, and a text."""
    if not sys.stderr.isatty():
        yield lambda *_: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
    from rich.progress import TimeElapsedColumn as Elapsed
    from rich.progress import TimeRemainingColumn as Remaining

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    bar = Progress(*columns, Elapsed(), Remaining(), console=Console(stderr=True), transient=True)
    with bar:
        task = bar.add_task("", total=total)
        yield lambda done, text: bar.update(task, completed=done, description=text)
