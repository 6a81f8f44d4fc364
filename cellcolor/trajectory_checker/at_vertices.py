"""The colors that configurations have at the vertices of a scene's surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.data.plan import ContactPath
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.arm.inverse import is_tool_on_last_axis
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.build import BuildResult
from cellcolor.memory import chunks
from cellcolor.trajectory_checker.dense import across_of, angles, joints_off, poses_of, turns_off
from cellcolor.trajectory_checker.tolerances import AT_VERTEX, OFF_SURFACE, TILT, TURN


@dataclass(frozen=True)
class Touches:
    """Where a path touches vertices in one of their colors, and where it does not.

    Attributes:
        stroke: (c,) the stroke of each contact, in the order of the path.
        vertex: (c,) the vertex touched.
        color: (c,) the color there, one of the vertex's.
        in_no_color: of vertices with others the first sample, and why it has no color there.
        nearest: (n,) distance of each vertex from the nearest sample in contact, m; infinite if
            there is none.
        misplaced: samples whose joints put the tip somewhere else than they say, and how far, m.
    """

    stroke: Index
    vertex: Index
    color: Index
    in_no_color: dict[int, tuple[int, str]]
    nearest: Array
    misplaced: dict[int, float]


def at_vertices(
    built: BuildResult, vertex: Index, joints: Array, deadline: Deadline = NEVER
) -> tuple[Index, list[str]]:
    """The color (k,) that each configuration has at its vertex, -1 for none, and why it has none.

    It has to put tip and tool there as in any contact; the tool's direction counts if the task asks
    for it. Then it is of the branch of the nearest of the scene's configurations, which may be no
    farther than ``AT_VERTEX`` in any joint modulo full circles (m for prismatic joints). A last
    joint that only turns the tool about its axis is not compared: the scene keeps it locked, and
    the task leaves it free. If the setup gives the turn, it is compared.

    Args:
        vertex: (k,) vertices.
        joints: (k, joints) in rad, finite.

    Returns:
        The colors, and a clause for each configuration, empty where it has a color.

    Raises:
        InputError: the arm has another number of joints.
    """
    robot, surface = built.robot, built.prepared.surface
    _check_width(robot, joints)
    tips, axes = poses_of(robot, joints, deadline)
    off = np.linalg.norm(tips - surface.vertices[vertex], axis=1)
    tilt = np.zeros(len(joints))
    if robot.task.direction:
        tilt = angles(axes, -surface.normals[vertex])
    compared = _compared(robot)
    branch, apart = np.zeros(len(joints), dtype=np.int64), np.full(len(joints), np.inf)
    for rows in chunks(len(joints)):
        deadline.check()
        known = built.configurations[vertex[rows]][:, :, compared]
        way = joints_off(robot.slides[compared], joints[rows][:, compared], known)
        branch[rows] = np.argmin(way, axis=1)
        apart[rows] = way[np.arange(len(way)), branch[rows]]
    turned = _turned(built, vertex, branch, joints, axes, deadline)
    reached = (off <= OFF_SURFACE) & (tilt <= TILT) & (apart <= AT_VERTEX) & (turned <= TURN)
    color = np.where(reached, built.node_color[vertex, branch], -1)
    for divided, positions in built.limits.positions.items():
        # Of the colors of one branch it is the one whose joints are turned as those asked about.
        way = np.abs(joints - positions[vertex])[:, compared].max(axis=1)
        same = (color >= 0) & (branch == built.color_branch[divided]) & (way <= np.pi)
        color[same] = divided

    def why_none(row: int) -> str:
        if off[row] > OFF_SURFACE:
            most = f"{1000 * OFF_SURFACE:g}"
            return f"the tip is {1000 * off[row]:.4g} mm off the vertex, allowed: {most}"
        if tilt[row] > TILT:
            by, most = np.degrees(tilt[row]), np.degrees(TILT)
            return f"the tool is {by:.4g} degrees off the normal, allowed: {most:g}"
        if np.isinf(apart[row]):
            return "the scene has no configuration there"
        name = built.branches[branch[row]]
        if apart[row] > AT_VERTEX:
            meters = " (or m)" if robot.slides.any() else ""
            return (
                f"the scene's nearest configuration there, {name!r}, is {apart[row]:.4g} "
                f"rad{meters} off, allowed: {AT_VERTEX:g}"
            )
        if turned[row] > TURN:
            by, most = np.degrees(turned[row]), np.degrees(TURN)
            return f"the tool is {by:.4g} degrees off its turn there, allowed: {most:g}"
        code = int(built.reasons[vertex[row], branch[row]])
        if code != VALID:
            return f"{name!r} fails the test {built.reason_names[code]!r} there"
        return f"{name!r} was removed there by the sliver policy"

    return color, [why_none(row) if color[row] < 0 else "" for row in range(len(color))]


def _turned(
    built: BuildResult,
    vertex: Index,
    branch: Index,
    joints: Array,
    axes: Array,
    deadline: Deadline,
) -> Array:
    """How far the tool is from the turn that the setup gives for the branch, (k,) rad.

    Args:
        axes: (k, 3) the tool's own direction, which counts if the task asks for none.
    """
    turn, surface = built.scene.setup.task.turn, built.prepared.surface
    if turn is None:
        return np.zeros(len(vertex))
    across = across_of(built.robot, joints, deadline)
    directions = -surface.normals[vertex] if built.robot.task.direction else axes
    off = turns_off(turn, surface.vertices[vertex], directions, across)
    each = len(built.branches) // len(turn.degrees) if turn.is_choice else len(built.branches)
    return np.asarray(off[np.arange(len(vertex)), branch // each])


def touches(built: BuildResult, path: ContactPath, deadline: Deadline = NEVER) -> Touches:
    """Where a path touches the vertices: the samples in contact whose tips are at one.

    Args:
        path: its samples.

    Raises:
        InputError: the arm has another number of joints.
    """
    _check_width(built.robot, path.joints)
    tips, _ = poses_of(built.robot, path.joints, deadline)
    off = np.linalg.norm(tips - (tips if path.points is None else path.points), axis=1)
    misplaced = {row: float(off[row]) for row in np.flatnonzero(off > OFF_SURFACE).tolist()}
    vertices, stroke = built.surface.vertices, path.stroke
    rows = np.flatnonzero(stroke >= 0)
    nearest = np.full(len(vertices), np.inf)
    sample = vertex = np.zeros(0, dtype=np.int64)
    if len(rows):
        nearest = np.asarray(cKDTree(tips[rows]).query(vertices)[0])
        tree = cKDTree(vertices)
        near = tree.query_ball_point(tips[rows], OFF_SURFACE, return_sorted=True)
        sample = np.repeat(rows, [len(found) for found in near])
        vertex = np.fromiter((v for found in near for v in found), np.int64, len(sample))
    color, why = at_vertices(built, vertex, path.joints[sample], deadline)
    has, in_no_color = color >= 0, dict[int, tuple[int, str]]()
    for row in np.flatnonzero(~has).tolist():
        in_no_color.setdefault(int(vertex[row]), (int(sample[row]), why[row]))
    own = stroke[sample[has]], vertex[has], color[has]
    return Touches(*own, in_no_color, nearest, misplaced)


def _check_width(robot: Robot, joints: Array) -> None:
    if joints.shape[1] != robot.joints:
        message = f"there are {joints.shape[1]} joints, the arm has {robot.joints}"
        raise InputError(None, "joints", message)


def _compared(robot: Robot) -> Mask:
    """Which joints (joints,) tell configurations apart.

    A last one about the tool's axis does not, if the tool's turn is free.
    """
    compared = np.ones(robot.joints, dtype=bool)
    compared[-1] = robot.task.turn or not is_tool_on_last_axis(robot)
    return compared
