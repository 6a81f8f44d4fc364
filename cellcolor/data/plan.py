"""Plans of other planners, to be judged: a color or joint angles per vertex, or a tool path."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import stretch_of
from cellcolor.data.trajectory import Trajectory, TrajectoryTable
from cellcolor.data.value import (
    Document,
    Rows,
    RowsOfThree,
    RowsWithGaps,
    Truths,
    Value,
    check_lengths,
)
from cellcolor.data.wording import count
from cellcolor.errors import InputError
from cellcolor.files.validation import settle


@dataclass(frozen=True, slots=True, repr=False)
class Plan(Document):
    """One color per vertex of a labelled surface.

    Attributes:
        vertex_colors: the painted color of each vertex, by its number, None exactly where it has
            none; lists and arrays of integers become this.

    Raises:
        InputError: a color is no integer, as ``True``, 1.0 and names are not.
    """

    FORMAT = "cellcolor/plan"

    vertex_colors: tuple[int | None, ...]

    def __str__(self) -> str:
        painted = [color for color in self.vertex_colors if color is not None]
        vertices = count(len(self.vertex_colors), "vertex", "vertices")
        colors = count(len(set(painted)), "color")
        return f"plan for {vertices}, {len(painted)} of them painted, in {colors}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"


@dataclass(frozen=True, eq=False, repr=False)
class JointPlan(Value):
    """A configuration for each vertex of a scene's surface.

    It has its own type because a bare array of joint angles could also be a path.

    Attributes:
        joints: (n, joints) float64, rad, modulo full circles (m for prismatic joints); a row of NaN
            where the vertex gets no contact.

    Raises:
        InputError: it is not such an array, or a row has some numbers and some NaN.
    """

    joints: RowsWithGaps

    def __post_init__(self) -> None:
        settle(self)
        torn = np.isnan(self.joints).any(axis=1) & ~np.isnan(self.joints).all(axis=1)
        if torn.any():
            message = "has NaN and numbers; a vertex without contact has NaN throughout"
            raise InputError(None, f"joints[{int(np.argmax(torn))}]", message)

    def __repr__(self) -> str:
        touched = int((~np.isnan(self.joints)).any(axis=1).sum())
        vertices = count(len(self.joints), "vertex", "vertices")
        return f"<{type(self).__name__}: {vertices}, {touched} of them with a configuration>"


@dataclass(frozen=True, eq=False, repr=False)
class ContactPath(Value):
    """A tool path with its joint angles, as samples in order.

    A run of consecutive samples in contact is a **stroke**; the tool lifts off between strokes.

    Attributes:
        joints: (k, joints) float64, rad, modulo full circles (m for prismatic joints).
        points: (k, 3) float64, the tool's tip in the world, m, compared with the joints; None
            computes it from the joints.
        contact: (k,) whether the tool is on the surface; None for always: one stroke.

    Raises:
        InputError: these are not such arrays, or have different lengths.
    """

    joints: Rows
    points: RowsOfThree | None = None
    contact: Truths | None = None

    def __post_init__(self) -> None:
        settle(self)
        check_lengths(self, ("points", "contact"), len(self.joints), "rows of joints")

    @classmethod
    def of(cls, trajectory: Trajectory | TrajectoryTable) -> ContactPath:
        """The path of a trajectory or of its table, without times."""
        if isinstance(trajectory, Trajectory):
            return cls(trajectory.joints, trajectory.points, trajectory.contact)
        points = None if trajectory.poses is None else trajectory.poses[:, :3]
        return cls(trajectory.joints, points, trajectory.marked("contact"))

    @property
    def stroke(self) -> NDArray[np.int64]:
        """The number (k,) of the stroke that each sample is in, -1 without contact."""
        if self.contact is None:
            return np.zeros(len(self.joints), dtype=np.int64)
        return stretch_of(self.contact)

    @property
    def strokes(self) -> int:
        """How many strokes there are."""
        return int(self.stroke.max(initial=-1)) + 1

    def __repr__(self) -> str:
        samples, strokes = count(len(self.joints), "sample"), count(self.strokes, "stroke")
        return f"<{type(self).__name__}: {samples}, {strokes}>"
