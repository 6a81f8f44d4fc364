"""Plans in joint angles at the front door, converted to colors of their scene.

What holds of the coloring that a tool path makes is proved in docs/semantics.md, section 9.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.data.plan import ContactPath, JointPlan, Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.trajectory import Trajectory, TrajectoryTable
from cellcolor.deadline import NEVER, Deadline
from cellcolor.door.subject import Subject
from cellcolor.errors import InputError
from cellcolor.oracle import JointViolation, PathVerdict

if TYPE_CHECKING:
    from cellcolor.frontend import BuildResult

AnyPath: TypeAlias = ContactPath | Trajectory | TrajectoryTable
"""A tool path with its joints."""

_NO_COLOR = -1  # in a plan: a configuration of no color, which no vertex has


def colors_of_joints(
    subject: Subject, plan: JointPlan, deadline: Deadline = NEVER
) -> tuple[Plan, tuple[JointViolation, ...]]:
    """The plan in colors that one configuration per vertex gives, and what is wrong in it.

    In the plan -1 stands for a configuration of no color, which no vertex has.

    Raises:
        InputError: the subject is no scene, or has other numbers of vertices or joints.
    """
    built = subject.build()
    from cellcolor.trajectory_checker.at_vertices import at_vertices

    surface, joints = built.surface, plan.joints
    if len(joints) != len(surface.vertices):
        message = f"{len(joints)} rows for {len(surface.vertices)} vertices"
        raise InputError(None, "joints", message)
    given = np.flatnonzero(~np.isnan(joints).all(axis=1))
    found, why = at_vertices(built, given, joints[given], deadline)
    colors: list[int | None] = [None] * len(joints)
    reasons: dict[int, str] = {
        vertex: f"no configuration, but colors {list(own)} reach this vertex"
        for vertex, own in enumerate(surface.vertex_colors)
        if own
    }
    for row, (vertex, color) in enumerate(zip(given.tolist(), found.tolist(), strict=True)):
        colors[vertex] = color if color >= 0 else _NO_COLOR
        reasons.pop(vertex, None)
        if color < 0:
            reasons[vertex] = why[row]
    violations = tuple(
        _violation(built, vertex, reasons[vertex], joints[vertex]) for vertex in sorted(reasons)
    )
    return Plan(tuple(colors)), violations


def path_verdict(subject: Subject, given: AnyPath, deadline: Deadline = NEVER) -> PathVerdict:
    """What is known of a tool path before its segments are counted: how it colors the surface.

    Raises:
        InputError: the subject is no scene, or the path is of another arm.
    """
    built = subject.build()
    from cellcolor.trajectory_checker.at_vertices import touches

    names = built.robot.joint_names
    if isinstance(given, Trajectory) and given.joint_names != names:
        message = f"must be {', '.join(names)}, are {', '.join(given.joint_names)}"
        raise InputError(None, "joint_names", message)
    path = given if isinstance(given, ContactPath) else ContactPath.of(given)
    found = touches(built, path, deadline)
    surface = built.surface
    plan, changes, runs = coloring_of(surface, found.stroke, found.vertex, found.color)
    reachable = [vertex for vertex, own in enumerate(surface.vertex_colors) if own]
    missing = [v for v in reachable if plan.vertex_colors[v] is None]
    violations = []
    for vertex in missing:
        joints: Array | None = None
        if vertex in found.in_no_color:
            sample, why = found.in_no_color[vertex]
            joints = path.joints[sample]
            reason = f"in contact at sample {sample}, but {why}"
        elif np.isinf(found.nearest[vertex]):
            reason = "no contact"
        else:
            reason = f"no contact nearer than {1000 * found.nearest[vertex]:.4g} mm"
        violations.append(_violation(built, vertex, reason, joints))
    misplaced = [
        f"points[{sample}]: the joints put the tip {1000 * by:.4g} mm from there"
        for sample, by in found.misplaced.items()
    ]
    problems = (*misplaced, *map(str, violations))
    return PathVerdict(
        problems,
        None,
        None,
        tuple(violations),
        surface=surface,
        plan=plan,
        strokes=path.strokes,
        color_changes=changes,
        runs=None if problems else runs,
        reachable=len(reachable),
        untouched=len(missing),
    )


def coloring_of(
    surface: LabelledSurface, stroke: Index, vertex: Index, color: Index
) -> tuple[Plan, int, int]:
    """The coloring that the first contacts make, and the path's stretches in it.

    Args:
        stroke, vertex, color: (c,) of each contact, in the order of the path.

    Returns:
        The plan with each vertex in the color of its first contact, None without any.

        How often the color changes in contact: between a contact and the next of the same stroke.

        Into how many stretches the contacts fall that are in the color of the plan, if they are cut
        wherever the stroke ends, the color changes, or the path does not stay at its vertex or go
        on to a neighbor along an uncracked edge.
    """
    touched, first = np.unique(vertex, return_index=True)
    own = np.full(len(surface.vertices), -1, dtype=np.int64)
    own[touched] = color[first]
    together = stroke[1:] == stroke[:-1]
    changes = int((together & (color[1:] != color[:-1])).sum())
    kept = np.flatnonzero(color == own[vertex])
    joined = 0
    for one, other in zip(kept[:-1].tolist(), kept[1:].tolist(), strict=True):
        if stroke[one] == stroke[other] and color[one] == color[other]:
            joined += _adjoin(surface, int(vertex[one]), int(vertex[other]), int(color[one]))
    plan = Plan(tuple([None if number < 0 else number for number in own.tolist()]))
    return plan, changes, len(kept) - joined


def _adjoin(surface: LabelledSurface, a: int, b: int, color: int) -> bool:
    """Whether two vertices are one, or have an edge along which a color is continuous."""
    if a == b:
        return True
    edge = (a, b) in surface.left_of or (b, a) in surface.left_of
    return edge and color not in surface.cracked(a, b)


def _violation(
    built: BuildResult, vertex: int, reason: str, joints: Array | None
) -> JointViolation:
    x, y, z = built.surface.vertices[vertex].tolist()
    own = None if joints is None or np.isnan(joints).any() else tuple(joints.tolist())
    slides = tuple(np.flatnonzero(built.robot.slides).tolist())
    return JointViolation(vertex, None, (x, y, z), reason, own, slides)
