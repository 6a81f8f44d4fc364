"""Runs of solvers on instances as rows of a table, a CSV file that survives being cut off.

No solver may beat what another one has proved.
"""

from __future__ import annotations

import csv
import io
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields
from fcntl import LOCK_EX, LOCK_NB, flock
from io import FileIO
from os import PathLike
from pathlib import Path
from typing import Literal, TypeVar

from pydantic import ConfigDict

from cellcolor.data.solution import SearchSpace
from cellcolor.data.value import adapter_of
from cellcolor.errors import InputError, system_errors
from cellcolor.files.documents import validate

_K = TypeVar("_K")

Status = Literal[
    "optimal",
    "feasible",
    "unknown",
    "timeout",
    "memory",
    "crashed",
    "refused",
    "unsupported",
]
"""How a run ended. The first three are the solver's own words: a proved minimum, a division, none.
Killed for its time; killed for its memory, or not begun because it would have been too much; broken
down; refused by the checker, so that solver or checker is wrong; more than the solver is able to
do."""

LATE = 2.0
"""Seconds that a solver may take beyond its limit (docs/measured.md, Limits)."""

FINISHED: tuple[Status, ...] = ("optimal", "feasible", "unknown")
"""Those that came back with an answer."""

Key = tuple[str, str, str, str, int | None, float, int]
"""What makes a run the same as another one."""


@dataclass(frozen=True, slots=True)
class Row:
    """One run; docs/formats/tables.md says what the columns are.

    Attributes:
        seed: of the instance within its family, None for a file.
        workers: that the solver was told to use, None if it chose itself.
        limit: in seconds.
        seconds: of solving alone, by the solver's own clock.
        cpu_seconds: of all processors, of the whole process.
        process_seconds: from the start of the process to its end.
        peak_mb: the most memory of the whole process, 2**20 bytes.
        error: a line, None if nothing went wrong.
    """

    __pydantic_config__ = ConfigDict(extra="forbid", allow_inf_nan=False)

    family: str
    seed: int | None
    instance: str
    sha256: str
    cells: int
    edges: int
    colors: int
    live_darts: int
    live_loops: int
    search_space: SearchSpace
    solver: str
    solver_version: str
    workers: int | None
    limit: float
    repetition: int
    status: Status
    segments: int | None
    lower_bound: int | None
    proved_for_surface: bool | None
    seconds: float | None
    cpu_seconds: float
    process_seconds: float
    peak_mb: float
    error: str | None
    cores: int
    memory_mb: int
    cpu: str
    python: str
    cellcolor: str
    load: float
    date: str
    command: str

    @property
    def key(self) -> Key:
        """Runs with one key are the same run; the machine is not in it."""
        contestant = self.solver, self.solver_version, self.workers
        return (self.sha256, self.search_space, *contestant, self.limit, self.repetition)

    @property
    def contestant(self) -> str:
        """The solver with its number of workers, as it is named on the command line."""
        return self.solver if self.workers is None else f"{self.solver}@{self.workers}"

    @property
    def subject(self) -> str:
        """The instance, so that it can be found again."""
        return self.instance if self.seed is None else f"{self.family}, seed {self.seed}"

    @property
    def solved(self) -> bool:
        """Whether the minimum was proved, no later than two seconds after the limit."""
        in_time = self.seconds is not None and self.seconds <= self.limit + LATE
        return self.status == "optimal" and in_time


def disagreements(rows: Iterable[Row]) -> list[str]:
    """A line for each instance on which two runs contradict each other, and for each result that
    the checker refused."""
    found = []
    for own in _by_instance(rows):
        refused = (row for row in own if row.status == "refused")
        found += [f"{row.subject}: {row.contestant}: {row.error}" for row in refused]
        divided = [row for row in own if row.segments is not None]
        proved = [row for row in own if row.lower_bound is not None]
        if not divided or not proved:
            continue
        best = min(divided, key=lambda row: row.segments or 0)
        most = max(proved, key=lambda row: row.lower_bound or 0)
        if (best.segments or 0) < (most.lower_bound or 0):
            found.append(
                f"{best.subject} ({best.search_space}, {best.sha256[:12]}): {best.contestant} has "
                f"{best.segments} segments, {most.contestant} a lower bound of {most.lower_bound}"
            )
    return found


def compared(rows: Iterable[Row]) -> int:
    """On how many instances two solvers or more, whatever their workers, have proved a minimum."""
    proved = [row for row in rows if row.status == "optimal"]
    return sum(len({row.solver for row in own}) > 1 for own in _by_instance(proved))


def by(rows: Iterable[Row], key: Callable[[Row], _K]) -> dict[_K, list[Row]]:
    """The rows of each kind, kinds in the order in which they come."""
    found: dict[_K, list[Row]] = defaultdict(list)
    for row in rows:
        found[key(row)].append(row)
    return dict(found)


def _by_instance(rows: Iterable[Row]) -> Iterable[list[Row]]:
    return by(rows, lambda row: (row.sha256, row.search_space)).values()


_COLUMNS = [field.name for field in fields(Row)]


def read_table(path: str | PathLike[str]) -> list[Row]:
    """The rows of a file.

    A last line that does not end was cut off while it was written, and is left out.

    Raises:
        InputError: the file cannot be read, or is no such table.
    """
    with system_errors(path, "cannot be read"):
        return _rows(Path(path).read_bytes(), str(path))


@dataclass(frozen=True, slots=True)
class Table:
    """A table that is being written.

    Attributes:
        rows: all there are, those of earlier sessions first.
        file: where they are; None for a table without a file.
    """

    rows: list[Row]
    file: FileIO | None = None

    def append(self, row: Row) -> None:
        """Add a row, at once, and handed to the system whole: a kill leaves a readable file.

        Raises:
            InputError: it cannot be written.
        """
        if self.file is not None:
            with system_errors(str(self.file.name), "cannot be written"):
                self.file.write(_line([_text(getattr(row, name)) for name in _COLUMNS]))
        self.rows.append(row)


@contextmanager
def continued(path: Path | None) -> Iterator[Table]:
    """The table of a file, to be written by nobody else at the same time; None for no file.

    Raises:
        InputError: the file cannot be used, is another table, or is being written to.
    """
    if path is None:
        yield Table([])
        return
    with system_errors(path, "cannot be written"):
        file = FileIO(path, "a+")
    with file:
        try:
            flock(file, LOCK_EX | LOCK_NB)
        except OSError as error:
            raise InputError(str(path), None, "is being written by another process") from error
        content, header = path.read_bytes(), _line(_COLUMNS)
        if header.startswith(content):  # empty, or cut off in its first line
            content = b""
        rows = _rows(content, str(path)) if content else []
        file.truncate(content.rfind(b"\n") + 1)
        if not content:
            file.write(header)
        yield Table(rows, file)


def _line(cells: Sequence[str]) -> bytes:
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerow(cells)
    return stream.getvalue().encode(errors="backslashreplace")  # names may have half a character


def _text(value: object) -> str:
    """A value in a cell; never more than one line."""
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else " ".join(str(value).split())


def _rows(content: bytes, path: str) -> list[Row]:
    try:
        lines = content[: content.rfind(b"\n") + 1].decode().split("\n")[:-1]
    except UnicodeDecodeError as error:
        raise InputError(path, None, f"is not text: {error}") from error
    if not lines or next(csv.reader(lines[:1])) != _COLUMNS:
        raise InputError(path, "line 1", f"is not the header {','.join(_COLUMNS)}")
    found = []
    for number, cells in enumerate(csv.reader(lines[1:]), 2):
        if len(cells) != len(_COLUMNS):
            message = f"has {len(cells)} cells, the header {len(_COLUMNS)}"
            raise InputError(path, f"line {number}", message)
        given = {name: cell or None for name, cell in zip(_COLUMNS, cells, strict=True)}
        try:
            found.append(validate(adapter_of(Row), given))
        except InputError as error:
            raise InputError(path, f"line {number}: {error.field}", error.message) from error
    return found
