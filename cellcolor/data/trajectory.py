"""Trajectories: joint angles over time, in contact and between, of this planner or another.

Any planner can also write one as a table of comma-separated values. Its header names the columns,
in any order: ``contact`` (0 or 1), ``q1`` to the last joint in rad; and if they are known
``time_s``, ``segment``, the tool's pose ``x``, ``y``, ``z`` in m with the surface's normal ``nx``,
``ny``, ``nz``, and what the trajectory states of a sample, 0 or 1: ``repeated``, ``unplanned`` and
``extra_lift_off``.
"""

from __future__ import annotations

import csv
import math
import re
from dataclasses import dataclass, field
from io import StringIO
from os import PathLike
from pathlib import Path

import numpy as np

from cellcolor.arrays import Array, Mask, stretches
from cellcolor.data.value import (
    Document,
    Integers,
    Numbers,
    Rows,
    RowsOfThree,
    Truths,
    Value,
    WithArrays,
    check_lengths,
)
from cellcolor.data.wording import count
from cellcolor.errors import InputError, naming
from cellcolor.files.documents import read_text
from cellcolor.files.validation import FreeContent, settle

_ARRAYS = ("joints", "points", "normals", "contact", "segment")


@dataclass(frozen=True, slots=True)
class ExtraLiftOff(Value):
    """A lift-off beyond the proven minimum, and why it is there.

    Attributes:
        sample: the last sample in contact before it.
        segment: the segment that is left and taken up again.
        reason: ``winding`` where a joint would run out of its limits, ``trimmed`` where a place
            that no sample may touch parts the segment.
        text: the reason in a sentence, with joint or test.
        place: where, m.
    """

    sample: int
    segment: int
    reason: str
    text: str
    place: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class LeftOut(Value):
    """A part of a segment that the tool does not go to, and why.

    Attributes:
        segment: the segment.
        area_m2: how large it is.
        reason: the first test that fails there, or another short cause.
        place: a point of it, m.
    """

    segment: int
    area_m2: float
    reason: str
    place: tuple[float, float, float]

    def __str__(self) -> str:
        place = ", ".join(f"{value:.3f}" for value in self.place)
        area = f"{self.area_m2 * 1e6:.1f} mm²"
        return f"{area} of segment {self.segment} at ({place}): {self.reason}"


@dataclass(frozen=True, slots=True)
class RepeatedStretch(Value):
    """Samples in contact that run along an earlier pass on purpose, and why.

    Attributes:
        sample: the first of them.
        last_sample: the last of them.
        reason: a short cause, such as ``beside another pass`` where there is no room for two.
    """

    sample: int
    last_sample: int
    reason: str


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory(WithArrays, Document):
    """Joint positions over time.

    Between two samples every joint moves in proportion to time. A stretch of samples in contact
    without one that is not is a **stroke**; between two strokes the tool is lifted off.

    Attributes:
        name: what to call it.
        joint_names: the arm's joints, base first.
        times: (k,) float64, s.
        joints: (k, joints) float64, rad, or m of prismatic ones; unwound: no jumps by full circles.
        points: (k, 3) float64, where the tool's tip is, in the world, m.
        normals: (k, 3) float64, unit vectors out of the surface; against the tool's axis where the
            task holds it against the normal.
        contact: (k,) whether the tool is on the surface.
        segment: (k,) int64, the segment of the painting that is worked on, -1 between them.
        unplanned: samples, ascending, after which the move to the next one was not planned: the
            arm is not known to get there.
        extra_lift_offs: see :class:`ExtraLiftOff`.
        left_out: see :class:`LeftOut`.
        repeated: see :class:`RepeatedStretch`.
        meta: free, JSON-able.

    Raises:
        InputError: an array has another shape or kind; names the member. Whether times ascend and
            joints keep their limits is left to the judge of trajectories.
    """

    FORMAT = "cellcolor/trajectory"
    LINES = ("extra_lift_offs", "left_out", "repeated")
    ALWAYS = ("unplanned", *LINES)

    name: str
    joint_names: tuple[str, ...]
    times: Numbers
    joints: Rows
    points: RowsOfThree
    normals: RowsOfThree
    contact: Truths
    segment: Integers
    unplanned: tuple[int, ...] = ()
    extra_lift_offs: tuple[ExtraLiftOff, ...] = ()
    left_out: tuple[LeftOut, ...] = ()
    repeated: tuple[RepeatedStretch, ...] = ()
    meta: FreeContent = field(default_factory=dict)

    def __post_init__(self) -> None:
        settle(self)
        if not self.joints.size:
            empty = self.joints.reshape(0, len(self.joint_names))
            object.__setattr__(self, "joints", empty)
        elif self.joints.shape[1] != len(self.joint_names):
            message = f"each entry needs {len(self.joint_names)} numbers"
            raise InputError(None, "joints", message)
        check_lengths(self, _ARRAYS, len(self.times), "times")

    @property
    def strokes(self) -> tuple[tuple[int, int], ...]:
        """First sample of each stroke, and the one after its last."""
        return tuple(stretches(self.contact))

    @property
    def lift_offs(self) -> int:
        """How often the tool is lifted off between two strokes."""
        return max(0, len(self.strokes) - 1)

    @property
    def seconds(self) -> float:
        """From the first sample to the last, s."""
        return float(self.times[-1] - self.times[0]) if len(self.times) else 0.0

    def __str__(self) -> str:
        strokes = count(len(self.strokes), "stroke")
        lift_offs = count(self.lift_offs, "lift-off")
        samples = count(len(self.times), "sample")
        return f"{self.name}: {strokes}, {lift_offs}, {self.seconds:.1f} s, {samples}"


_POSE = ("x", "y", "z", "nx", "ny", "nz")
COLUMNS = ("time_s", "segment", "contact", *_POSE)
"""Of a table, before those of the joints."""
STATED = ("repeated", "unplanned", "extra_lift_off")
"""Columns after them: what the trajectory states of a sample."""


@dataclass(frozen=True, eq=False)
class TrajectoryTable:
    """What a table says of a trajectory.

    Attributes:
        name: of the file, without its ending.
        columns: (k,) the numbers of each column that the table has.
    """

    name: str
    columns: dict[str, Array]

    @property
    def joints(self) -> Array:
        """(k, joints) in rad."""
        joints = sum(column.startswith("q") for column in self.columns)
        return np.column_stack([self.columns[f"q{k + 1}"] for k in range(joints)])

    @property
    def poses(self) -> Array | None:
        """(k, 6) point in m and normal; None without these columns."""
        has = "x" in self.columns
        return np.column_stack([self.columns[title] for title in _POSE]) if has else None

    def marked(self, title: str) -> Mask:
        """Where (k,) a column is 1; nowhere without it."""
        none = np.zeros(len(self.columns["contact"]))
        return np.asarray(self.columns.get(title, none) == 1)


def read_trajectory_csv(path: str | PathLike[str]) -> TrajectoryTable:
    """The table in a file.

    Raises:
        InputError: unreadable, no such table, or a cell that is not what its column says; names
            file, line and column.
    """
    with naming(path):
        return _parsed(Path(path).stem, read_text(path))


def _parsed(name: str, text: str) -> TrajectoryTable:
    reader = csv.reader(StringIO(text.removeprefix("\ufeff"), newline=""), strict=True)
    try:
        columns = [cell.strip() for cell in next(reader, [])]
        _check_header(columns)
        rows = []
        for cells in reader:
            if not cells:  # an empty line
                continue
            line = f"line {reader.line_num}"
            if len(cells) != len(columns):
                message = f"has {len(cells)} cells, the header has {len(columns)} columns"
                raise InputError(None, line, message)
            rows.append(
                [_number(cell, f"{line}, column {columns[k]}") for k, cell in enumerate(cells)]
            )
            _check_kinds(columns, rows[-1], line)
    except csv.Error as error:
        raise InputError(None, f"line {reader.line_num}", f"is not CSV: {error}") from error
    table = np.array(rows, dtype=np.float64).reshape(len(rows), len(columns))
    return TrajectoryTable(name, dict(zip(columns, table.T, strict=True)))


def _check_header(columns: list[str]) -> None:
    """Refuse columns that are not as they have to be."""
    for number, column in enumerate(columns, start=1):
        field = f"line 1, column {number}"
        if column in columns[: number - 1]:
            raise InputError(None, field, f"{column!r} appears twice")
        if column not in (*COLUMNS, *STATED) and not re.fullmatch(r"q[1-9][0-9]?", column):
            known = ", ".join((*COLUMNS, *STATED, "q1", "q2", "…"))
            raise InputError(None, field, f"{column!r} is not a known column: {known}")
    joints = [f"q{k}" for k in range(1, 1 + sum(column.startswith("q") for column in columns))]
    needed = ["contact", *(joints or ["q1"])]
    if set(columns) & set(_POSE):
        needed += _POSE
    missing = [column for column in needed if column not in columns]
    if missing:
        raise InputError(None, "line 1", f"there is no column {missing[0]}")


def _number(cell: str, field: str) -> float:
    try:
        number = float(cell)
    except ValueError as error:
        raise InputError(None, field, f"is not a number: {cell.strip()[:40]!r}") from error
    if not math.isfinite(number):
        raise InputError(None, field, "is not a finite number")
    return number


def _check_kinds(columns: list[str], row: list[float], line: str) -> None:
    for column, number in zip(columns, row, strict=True):
        if column in ("contact", *STATED) and number not in (0, 1):
            raise InputError(None, f"{line}, column {column}", f"must be 0 or 1, is {number:g}")
        if column == "segment" and (number != int(number) or abs(number) > 2**53):
            raise InputError(None, f"{line}, column segment", f"must be an integer, is {number:g}")
