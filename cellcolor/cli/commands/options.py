"""Types of options, and the options that several commands share."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import click


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
    help="Seconds, including reading.  [default: no limit]",
)
_PLACE = (
    "a box x,y,z,x,y,z (lowest and highest corner, m), a JSON file with a mask, or a labelled "
    "surface, for what it gives up."
)
COVER = click.option(
    "--cover",
    metavar="S",
    type=click.FloatRange(0, 1),
    help="Cover only this share of the area, 0 to 1, with the fewest lift-offs that do.",
)
REQUIRED = click.option("--required", metavar="PLACE", help=f"What has to be covered: {_PLACE}")
LEFT_ALONE = click.option(
    "--left-alone", metavar="PLACE", help=f"What must not be covered: {_PLACE}"
)
TOLERANCE = click.option(
    "--tolerance",
    metavar="D,A",
    help="How far a scene's part may stand off and be turned, such as 2mm,0.5deg: colors hold at a "
    "sample of such displacements.",
)
JOBS: dict[str, Any] = {
    "metavar": "N",
    "type": click.IntRange(min=1),
    "show_default": True,
    "help": "Number of processes at a time.",
}
CLUSTER = click.option(
    "--cluster",
    metavar="ADDRESS",
    help="The scheduler of a Dask cluster that does the work, such as tcp://10.0.0.1:8786, "
    "instead of processes here.",
)
