"""Joint angles of another planner, to be judged by an oracle: one per vertex, or along a path."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_csv import TrajectoryTable
from cellcolor.data.value import numbered_rows, rows_of_three, truths
from cellcolor.data.wording import count
from cellcolor.errors import InputError


@dataclass(frozen=True, eq=False, repr=False)
class JointPlan:
    """A configuration for each vertex of a scene's surface.

    It has its own type because a bare array of joint angles could also be a path.

    Attributes:
        joints: (n, joints) float64, rad, modulo full circles (m for prismatic joints); a row of NaN
            where the vertex gets no contact.

    Raises:
        InputError: it is not such an array, or a row has some numbers and some NaN.
    """

    joints: NDArray[np.float64]

    def __post_init__(self) -> None:
        joints = numbered_rows(self.joints, "joints")
        torn = np.isnan(joints).any(axis=1) & ~np.isnan(joints).all(axis=1)
        if torn.any():
            message = "has NaN and numbers; a vertex without contact has NaN throughout"
            raise InputError(None, f"joints[{int(np.argmax(torn))}]", message)
        object.__setattr__(self, "joints", joints)

    def __repr__(self) -> str:
        touched = int((~np.isnan(self.joints)).any(axis=1).sum())
        vertices = count(len(self.joints), "vertex", "vertices")
        return f"<{type(self).__name__}: {vertices}, {touched} of them with a configuration>"


@dataclass(frozen=True, eq=False, repr=False)
class ContactPath:
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

    joints: NDArray[np.float64]
    points: NDArray[np.float64] | None = None
    contact: NDArray[np.bool_] | None = None

    def __post_init__(self) -> None:
        joints = numbered_rows(self.joints, "joints")
        bad = np.argwhere(np.isnan(joints))
        if len(bad):
            place = "".join(f"[{number}]" for number in bad[0])
            raise InputError(None, f"joints{place}", "is not a finite number")
        members: dict[str, Any] = {"joints": joints}
        if self.points is not None:
            members["points"] = rows_of_three(self.points, "points")
        if self.contact is not None:
            members["contact"] = truths(self.contact, "contact")
        for name, content in members.items():
            if len(content) != len(joints):
                message = f"has {len(content)} entries for {len(joints)} rows of joints"
                raise InputError(None, name, message)
            object.__setattr__(self, name, content)

    @classmethod
    def of(cls, trajectory: Trajectory | TrajectoryTable) -> ContactPath:
        """The path of a trajectory or of its table, without times."""
        if isinstance(trajectory, Trajectory):
            return cls(trajectory.joints, trajectory.points, trajectory.contact)
        points = None if trajectory.poses is None else trajectory.poses[:, :3]
        return cls(trajectory.joints, points, trajectory.contact)

    @property
    def stroke(self) -> NDArray[np.int64]:
        """The number (k,) of the stroke that each sample is in, -1 without contact."""
        if self.contact is None:
            return np.zeros(len(self.joints), dtype=np.int64)
        begins = self.contact & ~np.concatenate([[False], self.contact[:-1]])
        return np.where(self.contact, np.cumsum(begins) - 1, -1)

    @property
    def strokes(self) -> int:
        """How many strokes there are."""
        return int(self.stroke.max(initial=-1)) + 1

    def __repr__(self) -> str:
        samples, strokes = count(len(self.joints), "sample"), count(self.strokes, "stroke")
        return f"<{type(self).__name__}: {samples}, {strokes}>"


@dataclass(frozen=True, eq=False)
class VertexContacts:
    """Where a path touches vertices in one of their colors, in the order of the path.

    Attributes:
        stroke: (c,) the stroke of each contact.
        vertex: (c,) the vertex touched.
        color: (c,) the color there, one of the vertex's.
    """

    stroke: NDArray[np.int64]
    vertex: NDArray[np.int64]
    color: NDArray[np.int64]
