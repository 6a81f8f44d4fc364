"""What the page's scripts draw: the motion, thinned to what can be seen, and modes of the part."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.data.candidate_table import VALID
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import Fault
from cellcolor.decomposition import Decomposition
from cellcolor.exports.interface import via_points
from cellcolor.frontend.arm.kinematics import (
    forward,
    manipulability,
    task_determinant,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.pictures.arm import (
    BESIDE,
    arm_points,
    draw_arm,
    grid,
    link_fills,
    surroundings,
)
from cellcolor.pictures.mesh_picture import SurfaceView, draw_surface, eye
from cellcolor.pictures.picture import WARNING, Layer, Picture3D, SpaceLines, Text, VertexClass
from cellcolor.pictures.report_page.content import MotionReport
from cellcolor.pictures.surface_pictures import (
    CUT,
    by_reason,
    by_segment,
    segment_classes,
    with_shares,
)
from cellcolor.pictures.viewer.page import layer_data, lines_data, packed, picture_data, text_data
from cellcolor.pictures.why_not_fewer import view_of_cells
from cellcolor.questions.answers import Front, FrontPoint


def modes_of(report: MotionReport) -> tuple[list[Picture3D], int]:
    """Pictures of one mesh, and how many of them, the first ones, have a button.

    The others are for rows of tables to show.
    """
    surface, painted = report.built.surface, report.painted
    views = [replace(by_reason(surface, report.built.candidates), title="Out of reach")]
    witness = () if report.solution is None else report.solution.witness
    if len(witness) > 1:
        proof = view_of_cells(surface, report.decomposition, "Cells of the proof", witness)
        views.append(replace(proof, cracks=()))
    buttons = len(views)
    answered = report.answered
    if answered is not None and len(answered.surface.vertices) == len(surface.vertices):
        views += [
            _front_view(answered.surface, answered.decomposition, point)
            for answer in answered.answers
            if isinstance(answer, Front)
            for point in answer
        ]
    if painted is not None:  # draw on its surface, which may be finer
        surface, original = painted.surface, painted.stands_for
        views = [replace(view, labels=view.labels[original]) for view in views]
        views.insert(0, replace(by_segment(painted), title="Segments"))
        buttons += 1
    return [draw_surface(surface, view) for view in views], buttons


def _front_view(
    surface: LabelledSurface, decomposition: Decomposition, point: FrontPoint
) -> SurfaceView:
    """What a point of a front covers: each cell by its segment.

    Where a cut would run within a cell is not drawn.
    """
    segments = point.segments
    divided, left_out = segments, segments + 1
    left = set(point.left_out)
    kept = [cell.id for cell in decomposition.instance.cells if cell.id not in left]
    of_cell = np.full(len(decomposition.instance.cells) + 1, left_out)
    of_cell[OUTSIDE] = OUTSIDE
    colors: dict[int, int] = {}
    for division in point.solution.cells or ():
        own = {sub.segment for sub in division.subcells}
        colors |= {sub.segment: sub.color for sub in division.subcells}
        of_cell[kept[division.id]] = own.pop() if len(own) == 1 else divided
    classes = segment_classes(surface, [colors.get(number) for number in range(segments)])
    classes.append(VertexClass("divided between segments", CUT))
    classes.append(VertexClass("left out", WARNING))
    labels = of_cell[np.array(decomposition.vertex_cell, dtype=np.int64)]
    return with_shares(surface, point.in_short, labels, classes)


OFF, OFF_M, OFF_SHARE = 2e-3, 2e-4, 0.01
"""How far samples that are not drawn may be off: joints in rad or m, the tip in m, and measures as
a share of their range."""
_MOST_MARKS, _MOST_DOTS = 40, 12  # of faults, and of left-out places
_STOPS = 20  # at which the part beside the tool is to be seen
_CONTACT = "#00508F"
_LEFT_OUT = "not covered, the largest"  # what the legend calls the dots


def report_data(report: MotionReport) -> dict[str, Any]:
    """The part in its modes, the arm and what is around it, and the motion if there is one."""
    modes, buttons = modes_of(report)
    mesh = modes[0].mesh
    assert mesh is not None
    surface, prepared = TriangleMesh(mesh.points, mesh.faces), report.built.prepared
    layers, lines = surroundings(prepared), []
    ground = prepared.ground
    if ground is not None:
        around = np.concatenate([surface.points, *(layer.points for layer in layers)])
        lines.append(grid(ground, around))
    lift = 0.05 * float(surface.lengths.mean())  # m above the surface, to be visible
    if report.trajectory is None:
        lines += [] if report.paths is None else [_paths(report.paths, lift)]
        layers += _still(report)
    data = picture_data(modes, buttons) | {
        "lines": list(map(lines_data, lines)),
        "layers": list(map(layer_data, layers)),
        "towards": eye(report.built.surface, BESIDE, _stops(report)).tolist(),
    }
    if report.trajectory is not None:
        faults = () if report.verdict is None else report.verdict.faults
        data["layers"] += _bodies(prepared.robot)
        data["marks"] = _marks(report.trajectory, faults, surface)
        data["motion"] = _motion(prepared, report.trajectory, faults, lift)
    return data


def _stops(report: MotionReport) -> list[tuple[Array, Array, Array]]:
    """The tip's place and normal at some moments in contact, and the arm's points there."""
    moved, robot = report.trajectory, report.built.robot
    if moved is None or not moved.contact.any():
        return []
    touching = np.flatnonzero(moved.contact)
    some = touching[np.linspace(0, len(touching) - 1, _STOPS).astype(np.int64)]
    return [(moved.points[k], moved.normals[k], arm_points(robot, moved.joints[k])) for k in some]


def _still(report: MotionReport) -> list[Layer]:
    """The arm in a valid configuration on the part."""
    vertex, branch = np.argwhere(report.built.reasons == VALID)[0].tolist()
    links = {body.link for body in report.built.robot.bodies}
    drawn = draw_arm(report.built, vertex, branch).layers
    return [replace(layer, name="arm") for layer in drawn if layer.name in links]


def _bodies(robot: Robot) -> list[dict[str, Any]]:
    """The collision shapes, since these are what is tested, in the frames of their joints."""
    fills = link_fills(robot)
    return [
        layer_data(Layer("arm", fills[body.link], *body.shape.shell()), body.joint)
        for body in robot.bodies
    ]


def _paths(paths: ToolPaths, lift: float) -> SpaceLines:
    """Tool paths without a motion."""
    places = [path.points + lift * path.normals for path in paths.paths]
    ends = [np.stack([each[:-1], each[1:]], axis=1) for each in places]
    return SpaceLines("tool paths", _CONTACT, np.concatenate([np.empty((0, 2, 3)), *ends]))


def _motion(
    prepared: PreparedScene, trajectory: Trajectory, faults: Sequence[Fault], lift: float
) -> dict[str, Any]:
    """The frames of a trajectory, the arm's kinematics, and what its joints are held to."""
    robot = prepared.robot
    poses = forward(robot, trajectory.joints)
    measures = {
        "determinant": task_determinant(poses, robot.task),
        "manipulability": manipulability(poses, robot.task),
    }
    frames = frames_of(trajectory, np.column_stack([*measures.values()]))
    contact = trajectory.contact[frames]
    states = (contact & np.append(contact[1:], contact[-1])).astype(np.uint8)
    states[np.isin(frames, trajectory.unplanned)] = 2
    places = trajectory.points + lift * trajectory.normals
    return {
        "arm": _kinematics(robot),
        "names": list(trajectory.joint_names),
        "limits": _limits(prepared),
        "times": packed(trajectory.times[frames], "f4"),
        "joints": packed(trajectory.joints[frames], "f4"),
        # From each frame to the next: 0 between strokes, 1 in contact, 2 not planned.
        "states": packed(states, "u1"),
        "segment": packed(trajectory.segment[frames], "i2"),
        "trace": packed(places[frames], "f4"),
        "faults": [
            {"time": fault.time, "text": fault.kind} for fault in faults if fault.time is not None
        ],
    } | {
        # The least value from each frame to just before the next, so that no dip is lost.
        name: packed(np.minimum.reduceat(own, frames), "f4")
        for name, own in measures.items()
    }


def _kinematics(robot: Robot) -> dict[str, Any]:
    """Frames as matrices, row by row."""
    return {
        "placement": robot.placement.reshape(-1, 16).tolist(),
        "axis": robot.axis.tolist(),
        "slides": robot.slides.tolist(),
        "tip": robot.tip.ravel().tolist(),
    }


def _limits(prepared: PreparedScene) -> dict[str, Any]:
    least, robot = prepared.arm.conditioning, prepared.robot
    tested = prepared.setup.constraints.conditioning
    lower, upper = (
        [limit if np.isfinite(limit) else None for limit in limits.tolist()]
        for limits in (robot.lower, robot.upper)
    )
    return {
        "lower": lower,
        "upper": upper,
        "determinant": least.min_task_determinant if tested else None,
        "manipulability": least.min_manipulability if tested else None,
    }


def _marks(
    trajectory: Trajectory, faults: Sequence[Fault], surface: TriangleMesh
) -> list[dict[str, Any]]:
    """Marks on the part: extra lift-offs, the largest left-out places, and faults."""

    def mark(place: Sequence[float], text: str, **more: Any) -> dict[str, Any]:
        nearest = np.argmin(np.linalg.norm(surface.points - place, axis=1))
        at = Text(text, np.array(place), surface.vertex_normals[nearest])
        return text_data(at) | more

    marks = [mark(own.place, f"extra lift-off: {own.reason}") for own in trajectory.extra_lift_offs]
    largest = sorted(trajectory.left_out, key=lambda part: -part.area_m2)[:_MOST_DOTS]
    marks += [mark(part.place, "", kind="dot", name=_LEFT_OUT) for part in largest]
    marks += [
        mark(fault.place, fault.kind, kind="mark fault", time=fault.time)
        for fault in faults[:_MOST_MARKS]
        if fault.place is not None and fault.time is not None
    ]
    return marks


def frames_of(trajectory: Trajectory, measures: Array) -> Index:
    """The samples to draw, ascending: all between two of them are nearly on a line over time.

    The ends of strokes and of moves that were not planned are always included.

    Args:
        measures: (k, m) what charts show beside the joints.
    """
    inside = [end for first, after in trajectory.strokes for end in (first, after - 1)]
    inside += [end for sample in trajectory.unplanned for end in (sample, sample + 1)]
    spans = np.maximum(np.ptp(measures, axis=0), 1e-12)
    asked = trajectory.joints / OFF, trajectory.points / OFF_M, measures / (OFF_SHARE * spans)
    return via_points(trajectory.times, np.column_stack(asked), np.array(inside, dtype=np.int64))
