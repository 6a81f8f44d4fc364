"""What options are held to, and the options that several commands have."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import click

__all__ = ["CLUSTER", "INPUT", "JOBS", "METRES", "PATH", "SECONDS", "SEED", "TIME_LIMIT"]


class _Positive(click.FloatRange):
    """A positive, finite number of some unit."""

    def __init__(self, units: str) -> None:
        super().__init__(min=0, min_open=True)
        self.units = units

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        number = float(super().convert(value, param, ctx))
        if not math.isfinite(number):
            self.fail(f"{value} is not a number of {self.units}.", param, ctx)
        return number


class _Input(click.Path):
    """A file to be read, or the name of a shipped one."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        from cellcolor.door.shipped import find_file

        return find_file(str(super().convert(value, param, ctx)))


PATH = click.Path(path_type=Path)
INPUT = _Input()
SECONDS = _Positive("seconds")
METRES = _Positive("metres")
SEED = click.option(
    "--seed",
    metavar="N",
    type=click.IntRange(0, 2**31 - 1),
    default=0,
    show_default=True,
    help="Of everything random.",
)
TIME_LIMIT = click.option(
    "--time-limit",
    metavar="S",
    type=SECONDS,
    help="Seconds, reading included.  [default: as long as it takes]",
)
JOBS: dict[str, Any] = {
    "metavar": "N",
    "type": click.IntRange(min=1),
    "show_default": True,
    "help": "Processes at a time.",
}
CLUSTER = click.option(
    "--cluster",
    metavar="ADDRESS",
    help="The scheduler of a Dask cluster that does the work, such as tcp://10.0.0.1:8786, "
    "instead of processes here.",
)
