"""What is no solver, measured beside solvers: programs from their start to their end."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from datetime import UTC, datetime

from pydantic import ConfigDict

from cellcolor.processes import Ended


@dataclass(frozen=True, slots=True)
class Timing:
    """One measurement; the other columns are as in :class:`cellcolor.lab.runs.row.Row`.

    Attributes:
        subject: what was measured.
        way: how it was done, ``cellcolor`` or something that it is compared with.
        size: of its input, in ``unit``; None if that is of no interest.
        status: ``done``, or how it ended else.
        seconds: by the clock.
    """

    __pydantic_config__ = ConfigDict(extra="forbid", allow_inf_nan=False)

    subject: str
    way: str
    size: int | None
    unit: str | None
    repetition: int
    status: str
    seconds: float
    cpu_seconds: float
    peak_mb: float
    cores: int
    memory_mb: int
    cpu: str
    python: str
    cellcolor: str
    load: float
    date: str
    command: str


def timing(
    subject: str,
    way: str,
    repetition: int,
    ended: Ended,
    command: str,
    size: int | None = None,
    unit: str | None = None,
) -> Timing:
    """What came of a process as a row."""
    return Timing(
        subject=subject,
        way=way,
        size=size,
        unit=unit,
        repetition=repetition,
        status=ended.end,
        seconds=round(ended.seconds, 4),
        cpu_seconds=round(ended.cpu_seconds, 4),
        peak_mb=round(ended.peak_mb, 1),
        **asdict(ended.machine),
        load=round(ended.load, 2),
        date=datetime.now(UTC).isoformat(timespec="seconds"),
        command=command,
    )
