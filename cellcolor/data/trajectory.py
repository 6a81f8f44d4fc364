"""Trajectories: joint angles over time, in contact and between, of this planner or another."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

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
from cellcolor.errors import InputError
from cellcolor.files.validation import json_content, settle

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
    meta: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        settle(self)
        object.__setattr__(self, "meta", json_content(self.meta, "meta"))
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
        steps = np.diff(np.concatenate([[0], self.contact.astype(np.int8), [0]]))
        return tuple(
            zip(np.flatnonzero(steps > 0).tolist(), np.flatnonzero(steps < 0).tolist(), strict=True)
        )

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
