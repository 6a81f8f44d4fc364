"""The data that the page's scripts draw, thinned to what can be seen."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.data.candidate_table import VALID
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import Fault
from cellcolor.frontend.arm.kinematics import (
    forward,
    manipulability,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.pictures.arm import body_mesh, obstacle_mesh
from cellcolor.pictures.mesh_picture import SurfaceView, draw_surface
from cellcolor.pictures.report_page.content import MotionReport
from cellcolor.pictures.report_page.surface_modes import (
    SurfaceMode,
    front_mode,
    proof_mode,
    reach_mode,
    segment_mode,
)
from cellcolor.questions.front import Front

MOST_FRAMES = 1500
_MOST_DOTS = 40  # marks of left-out places, and of faults
_MOST_POINTS = 12_000  # of the drawn path
_FINEST = 2e-4  # m; how far the drawn path may be off, unless it would have too many points
_LINKS = ("#AEB6C2", "#7F8A9B")  # the links of the arm, alternating
_TOOL = "#4A5361"
_OBSTACLE, _BODY = "#882255", "#C8C4B0"


def viewer_data(report: MotionReport) -> dict[str, Any]:
    """What ``viewer.js`` and ``charts.js`` draw, as JSON; arrays are base64 (see ``_packed``)."""
    prepared, painted = report.built.prepared, report.painted
    trajectory = report.trajectory or _still(report)
    surface = report.built.surface
    modes = [reach_mode(report.built)]
    witness = () if report.solution is None else report.solution.witness
    if len(witness) > 1:
        modes.append(proof_mode(surface, report.decomposition, witness))
    answered = report.answered
    if answered is not None and len(answered.surface.vertices) == len(surface.vertices):
        modes += [
            front_mode(answered.surface, answered.decomposition, point)
            for answer in answered.answers
            if isinstance(answer, Front)
            for point in answer
        ]
    if painted is not None:  # draw on its surface, which may be finer
        surface, original = painted.surface, painted.stands_for
        modes = [replace(mode, labels=mode.labels[original]) for mode in modes]
        modes.insert(0, segment_mode(painted))
    frames = frames_of(trajectory, MOST_FRAMES)
    faults = () if report.verdict is None else report.verdict.faults
    vertices, faces = surface.vertices, surface.faces
    first_edges = np.linalg.norm(vertices[faces[:, 0]] - vertices[faces[:, 1]], axis=1)
    lift, ground = 0.05 * float(first_edges.mean()), prepared.workplace.ground
    return {
        "mesh": {"vertices": _packed(vertices, "f4"), "faces": _packed(faces, "u4")},
        "modes": [_mode(surface, mode) for mode in modes],
        "arm": _arm(prepared.robot),
        "solids": _solids(prepared),
        "ground": None if ground is None else [*ground.normal, ground.offset_m],
        "trace": (
            _trace(report.trajectory, lift)
            if report.trajectory is not None
            else _paths(report.paths, lift)
        ),
        "frames": _frames(prepared, trajectory, frames),
        "limits": _limits(prepared),
        "joint_names": list(trajectory.joint_names),
        "places": _places(trajectory, faults, vertices, surface.vertex_normals),
        "faults": [fault.time for fault in faults if fault.time is not None],
        "eye": _eye(surface).tolist(),
    }


def _packed(values: Any, kind: str) -> dict[str, str]:
    """An array as little-endian bytes; the kind is ``f4``, ``u4``, ``i2`` or ``u1``."""
    content = np.ascontiguousarray(values, dtype=f"<{kind}")
    return {"kind": kind, "base64": base64.b64encode(content.tobytes()).decode()}


def _mode(surface: LabelledSurface, mode: SurfaceMode) -> dict[str, Any]:
    used = set(np.unique(mode.labels).tolist())
    drawn = draw_surface(surface, SurfaceView(mode.name, mode.labels, mode.classes))
    return {
        "name": mode.name,
        "texts": [
            {"text": text.text, "at": text.at.tolist(), "outward": text.outward.tolist()}
            for text in drawn.texts
        ],
        "classes": [
            {"name": own.name, "rgb": own.rgb, "used": label in used}
            for label, own in enumerate(mode.classes)
        ],
        "labels": _packed(mode.labels, "i2"),
    } | ({} if mode.button else {"button": False})


def _arm(robot: Robot) -> dict[str, Any]:
    """Joint frames and the bodies on them: the collision shapes, since these are what is tested."""
    links = list(dict.fromkeys(body.link for body in robot.bodies))
    last = max(min(body.joint, robot.joints) for body in robot.bodies)
    bodies = []
    for body in robot.bodies:
        points, triangles = body_mesh(body)
        fill = _TOOL if body.joint == last else _LINKS[links.index(body.link) % len(_LINKS)]
        bodies.append(
            {
                "joint": body.joint,
                "rgb": fill,
                "points": _packed(points, "f4"),
                "triangles": _packed(triangles, "u4"),
            }
        )
    return {
        "placement": robot.placement.reshape(-1, 16).tolist(),  # row by row
        "axis": robot.axis.tolist(),
        "slides": robot.slides.tolist(),
        "tip": robot.tip.ravel().tolist(),
        "followers": [
            {
                "parent": each.parent,
                "placement": each.placement.ravel().tolist(),
                "back": np.linalg.inv(each.placement).ravel().tolist(),
                "axis": each.axis.tolist(),
                "slides": each.slides,
                "leader": each.leader,
                "multiplier": each.multiplier,
                "offset": each.offset,
            }
            for each in robot.followers
        ],
        "bodies": bodies,
    }


def _solids(prepared: PreparedScene) -> list[dict[str, Any]]:
    """Obstacles and the body of the part, in the world frame."""
    scene = prepared.scene
    meshes = [(_OBSTACLE, *obstacle_mesh(each, scene.folder)) for each in scene.obstacle]
    if scene.solid_object is not None:
        body = scene.solid_object.surface(scene.folder).placed(scene.placement)
        meshes.append((_BODY, body.vertices, body.faces))
    return [
        {"rgb": fill, "points": _packed(points, "f4"), "triangles": _packed(triangles, "u4")}
        for fill, points, triangles in meshes
    ]


def _trace(trajectory: Trajectory, lift: float) -> dict[str, Any]:
    """The tip's path with times, a polyline drawn ``lift`` m above the surface to be visible."""
    points = trajectory.points + lift * trajectory.normals
    contact = trajectory.contact
    # The line changes its color where contact begins or ends, so these points are kept.
    turns = np.flatnonzero(contact[1:] != contact[:-1])
    jumps = np.array(trajectory.unplanned, dtype=np.int64)
    stays = np.concatenate([turns, turns + 1, jumps, jumps + 1])
    tolerance, kept = _FINEST, straightened(points, stays, _FINEST)
    while len(kept) > _MOST_POINTS:
        tolerance *= 2
        kept = straightened(points, stays, tolerance)
    touching = contact[kept] & contact[np.append(kept[1:], kept[-1])]
    return {
        "points": _packed(points[kept], "f4"),
        "times": _packed(trajectory.times[kept], "f4"),
        # Of the line from each point to the next: 0 between strokes, 1 in contact, 2 not planned.
        "state": _packed(np.where(np.isin(kept, jumps), 2, touching), "u1"),
    }


def _paths(paths: ToolPaths | None, lift: float) -> dict[str, Any]:
    """Tool paths without a motion: all times are 0, and nothing joins two paths (state 3)."""
    drawn = () if paths is None else paths.paths
    points = [path.points + lift * path.normals for path in drawn]
    states = [np.append(np.ones(len(path.points) - 1), 3) for path in drawn]
    return {
        "points": _packed(np.concatenate([np.empty((0, 3)), *points]), "f4"),
        "times": _packed(np.zeros(sum(map(len, points))), "f4"),
        "state": _packed(np.concatenate([np.empty(0), *states]), "u1"),
    }


def _still(report: MotionReport) -> Trajectory:
    """One sample: the arm at home, or in some valid configuration on the part."""
    robot, motion = report.built.robot, report.built.scene.setup.motion
    if motion is not None and motion.home is not None:
        joints = np.array([motion.home])
    else:
        joints = report.built.configurations[report.built.reasons == VALID][:1]
    poses = forward(robot, joints)
    return Trajectory(
        report.built.surface.name,
        tuple(robot.joint_names),
        np.zeros(1),
        joints,
        poses.tip,
        -poses.tool_axis,
        np.zeros(1, dtype=bool),
        np.full(1, -1),
    )


def _frames(prepared: PreparedScene, trajectory: Trajectory, frames: Index) -> dict[str, Any]:
    robot = prepared.robot
    poses = forward(robot, trajectory.joints)
    linear, angular = tip_jacobian(poses)
    measures = {
        "determinant": task_determinant(linear, angular, poses.tool_axis, robot.task),
        "manipulability": manipulability(linear, robot.task),
    }
    return {
        "samples": len(trajectory.times),
        "times": _packed(trajectory.times[frames], "f4"),
        "joints": _packed(trajectory.joints[frames], "f4"),
        "contact": _packed(trajectory.contact[frames], "u1"),
        "segment": _packed(trajectory.segment[frames], "i2"),
        "unplanned": _packed(np.isin(frames, trajectory.unplanned), "u1"),
    } | {
        # The least value from each frame to just before the next, so that no dip is lost.
        name: _packed(np.minimum.reduceat(own, frames), "f4")
        for name, own in measures.items()
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


def _places(
    trajectory: Trajectory, faults: Sequence[Fault], vertices: Array, normals: Array
) -> list[dict[str, Any]]:
    """Marks on the part: extra lift-offs, faults, and left-out places.

    ``outward`` is the normal of the nearest vertex: marks that face away are hidden.
    """
    marks: list[dict[str, Any]] = [
        {
            "place": extra.place,
            "kind": "mark",
            "text": f"extra lift-off: {extra.reason}",
        }
        for extra in trajectory.extra_lift_offs
    ]
    largest = sorted(trajectory.left_out, key=lambda part: -part.area_m2)[:_MOST_DOTS]
    marks += [{"place": part.place, "kind": "dot", "text": ""} for part in largest]
    marks += [
        {"place": fault.place, "kind": "mark fault", "text": fault.kind, "time": fault.time}
        for fault in faults[:_MOST_DOTS]
        if fault.place is not None and fault.time is not None
    ]
    for mark in marks:
        nearest = np.argmin(np.linalg.norm(vertices - mark["place"], axis=1))
        mark["outward"] = normals[nearest].tolist()
    return marks


def _eye(surface: LabelledSurface) -> Array:
    """A unit vector from the scene to the eye, so that arm and part are seen side by side.

    Of 24 directions around the vertical at two heights, this is the one that sees most of the
    part's outside. Directions in which the arm hides the part, or the part the arm, lose points.
    """
    normals, middle = surface.vertex_normals, surface.vertices.mean(axis=0)
    away = middle[:2] / max(float(np.linalg.norm(middle[:2])), 1e-9)
    around = np.tile(np.radians(np.arange(0, 360, 15)), 2)
    rises = np.repeat(np.radians([28, 40]), 24)
    flat = np.stack([np.cos(around), np.sin(around)], axis=1)
    eyes = np.column_stack([np.cos(rises)[:, None] * flat, np.sin(rises)])
    seen = np.maximum(eyes @ normals.T, 0).mean(axis=1)
    score = seen - 0.15 * np.abs(flat @ away) + 0.05 * (flat @ away)
    best: Array = eyes[np.argmax(score)]
    return best


def frames_of(trajectory: Trajectory, most: int) -> Index:
    """The samples to draw, ascending, evenly spread over the travel of the joints.

    Time has a small weight as well, so that there are samples where the joints rest. The ends of
    strokes and of moves that were not planned are always included.

    Args:
        trajectory: one sample or more.
        most: the most samples, not counting these ends.
    """
    count = len(trajectory.times)
    inside = [end for first, after in trajectory.strokes for end in (first, after - 1)]
    inside += [end for sample in trajectory.unplanned for end in (sample, sample + 1)]
    ends = np.array([0, count - 1, *inside], dtype=np.int64)
    if count <= most:
        return np.arange(count)
    travel = np.abs(np.diff(trajectory.joints, axis=0)).max(axis=1)
    steps = travel / (travel.sum() or 1.0) + 0.2 * np.diff(trajectory.times) / trajectory.seconds
    along = np.concatenate([[0.0], np.cumsum(steps)])
    even = np.searchsorted(along, np.linspace(0, along[-1], most))
    return np.unique(np.concatenate([ends, np.minimum(even, count - 1)]))


def straightened(points: Array, kept: Index, tolerance: float) -> Index:
    """Which points of a polyline to keep, ascending, so that it moves by at most a tolerance.

    The algorithm of Douglas and Peucker, "Algorithms for the reduction of the number of points
    required to represent a digitized line", 1973.

    Args:
        points: (k, 3) of the polyline, two or more, m.
        kept: points that stay in any case.
        tolerance: the largest distance of a dropped point from the new polyline, m.
    """
    chosen = np.zeros(len(points), dtype=bool)
    chosen[[0, len(points) - 1]] = True
    chosen[kept] = True
    stops = np.flatnonzero(chosen).tolist()
    pieces = list(pairwise(stops))
    while pieces:
        first, last = pieces.pop()
        if last - first < 2:
            continue
        between = points[first + 1 : last] - points[first]
        way = points[last] - points[first]
        share = np.clip(between @ way / (way @ way or 1.0), 0, 1)
        far = np.linalg.norm(between - share[:, None] * way, axis=1)
        worst = int(np.argmax(far))
        if far[worst] > tolerance:
            middle = first + 1 + worst
            chosen[middle] = True
            pieces += [(first, middle), (middle, last)]
    return np.flatnonzero(chosen)
