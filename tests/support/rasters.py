"""Plain trajectories, made without any planner of the package: a raster in one branch, slowly.

Surfaces have to be graphs over the xy plane. Points are found by asking every face.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from shipped import shipped
from turned_scenes import setup

from cellcolor.arrays import Array, Index
from cellcolor.data.candidate_table import VALID
from cellcolor.data.trajectory import Trajectory
from cellcolor.frontend.build import BuildResult, build_surface
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.scene import Scene

STEP = 0.001  # m, between samples


@cache
def square() -> tuple[PreparedScene, BuildResult, Trajectory]:
    """The shipped square, made smaller, in two strokes of one branch."""
    return _made(shipped("square").varied(object={"size_x_m": 0.16, "size_y_m": 0.12}))


@cache
def cap() -> tuple[PreparedScene, BuildResult, Trajectory]:
    """The top of the shipped wok with its obstacle, in two strokes of one branch."""
    return _made(shipped("wok_obstacle").varied(object={"half_angle_rad": 0.4}))


@cache
def turned() -> tuple[PreparedScene, BuildResult, Trajectory]:
    """The small square for a tool that may have two turns, 90 degrees apart."""
    given = setup({"along": (1.0, 0.0, 0.0), "turns_deg": (0.0, 90.0)})
    scene = shipped("square").varied(object={"size_x_m": 0.16, "size_y_m": 0.12})
    return _made(scene.with_setup(given))


def _made(scene: Scene) -> tuple[PreparedScene, BuildResult, Trajectory]:
    scene = scene.varied(object={"target_vertices": 300})
    built = build_surface(scene)
    prepared = built.prepared
    counts = [(built.node_color == color).sum() for color in range(len(built.surface.colors))]
    branch = built.coloring.branch[int(np.argmax(counts))]
    return prepared, built, raster(prepared, branch)


def on_mesh(prepared: PreparedScene, xy: Array) -> tuple[Array, Array]:
    """Points above (k, 2) and their interpolated unit normals; NaN beside the surface."""
    surface = prepared.surface
    corners = surface.vertices[surface.faces]
    a, b, c = (corners[:, k, :2] for k in range(3))
    points, normals = np.full((len(xy), 3), np.nan), np.full((len(xy), 3), np.nan)
    ab, ac = b - a, c - a
    doubled = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    for k, place in enumerate(xy):
        ap = place - a
        v = (ap[:, 0] * ac[:, 1] - ap[:, 1] * ac[:, 0]) / doubled
        w = (ab[:, 0] * ap[:, 1] - ab[:, 1] * ap[:, 0]) / doubled
        least = np.minimum(np.minimum(v, w), 1 - v - w)
        face = int(np.argmax(least))
        if least[face] > -1e-9:
            weights = np.array([1 - v[face] - w[face], v[face], w[face]])
            points[k] = weights @ corners[face]
            normal = weights @ surface.normals[surface.faces[face]]
            normals[k] = normal / np.linalg.norm(normal)
    return points, normals


def raster(prepared: PreparedScene, branch: int, spacing: float = 0.009) -> Trajectory:
    """Back and forth over all that one branch reaches, lifted off once half way."""
    vertices = prepared.surface.vertices
    low, high = vertices[:, :2].min(axis=0), vertices[:, :2].max(axis=0)
    count = int(np.ceil((high[1] - low[1]) / spacing))
    ys = low[1] + (np.arange(count) + 0.5) * (high[1] - low[1]) / count
    xs = np.arange(low[0] + spacing / 2, high[0] - spacing / 2, STEP)
    lines: list[Array] = []
    for y in ys:
        xy = np.column_stack([xs, np.full(len(xs), y)])
        points, normals = on_mesh(prepared, xy)
        there = np.flatnonzero(~np.isnan(points[:, 0]))
        valid = prepared.judge(_followed(prepared, points[there], normals[there], branch))
        good = there[valid.reasons == VALID]
        if len(good):
            assert len(good) == good[-1] - good[0] + 1, "the line is torn"
            lines.append(xy[good] if len(lines) % 2 == 0 else xy[good][::-1])
    half = len(lines) // 2
    strokes = [_joined(lines[:half]), _joined(lines[half:])]
    rows = []
    for number, xy in enumerate(strokes):
        points, normals = on_mesh(prepared, xy)
        there = ~np.isnan(points[:, 0])
        rows.append(_stroke(prepared, points[there], normals[there], branch, number))
    return _timed(prepared, rows)


def _joined(lines: list[Array]) -> Array:
    parts = [lines[0]]
    for line in lines[1:]:
        start, end = parts[-1][-1], line[0]
        pieces = int(np.ceil(np.linalg.norm(end - start) / STEP))
        share = np.arange(1, pieces)[:, None] / pieces
        parts += [start + share * (end - start), line]
    return np.concatenate(parts)


def _followed(prepared: PreparedScene, points: Array, normals: Array, branch: int) -> Array:
    return prepared.arm.follow(points, -normals, np.full(len(points), branch, dtype=np.intp))


Rows = tuple[Array, Array, Array, Index]
"""Joints, points, normals and segments."""


def _stroke(
    prepared: PreparedScene, points: Array, normals: Array, branch: int, number: int
) -> Rows:
    """A stroke with its approach and its retreat along the normals."""
    heights = np.arange(0.0, 0.05, STEP)[1:]
    above = points[0] + heights[::-1, None] * normals[0]
    away = points[-1] + heights[:, None] * normals[-1]
    all_points = np.concatenate([above, points, away])
    all_normals = np.concatenate(
        [np.tile(normals[0], (len(above), 1)), normals, np.tile(normals[-1], (len(away), 1))]
    )
    joints = np.unwrap(_followed(prepared, all_points, all_normals, branch), axis=0)
    segment = np.full(len(joints), -1)
    segment[len(above) : len(above) + len(points)] = number
    return joints, all_points, all_normals, segment


def _timed(prepared: PreparedScene, strokes: list[Rows]) -> Trajectory:
    from cellcolor.frontend.arm.kinematics import forward

    joints, points, normals, segment = strokes[0]
    for more in strokes[1:]:
        way = more[0][0] - joints[-1]
        turned = more[0] - 2 * np.pi * np.round(way / (2 * np.pi))
        way = turned[0] - joints[-1]
        pieces = int(np.ceil(np.abs(way).max() / 0.004))
        move = joints[-1] + np.arange(1, pieces)[:, None] / pieces * way
        poses = forward(prepared.robot, move)
        joints = np.concatenate([joints, move, turned])
        points = np.concatenate([points, poses.tip, more[1]])
        normals = np.concatenate([normals, -poses.tool_axis, more[2]])
        segment = np.concatenate([segment, np.full(len(move), -1), more[3]])
    motion = prepared.setup.motion
    assert motion is not None
    fastest = np.array(motion.joint_accelerations_rad_per_s2) * 0.9
    bends = np.abs(np.diff(joints, 2, axis=0)) / fastest
    seconds = np.sqrt(bends.max())
    seconds = max(seconds, (np.abs(np.diff(joints, axis=0)) / 3.0).max())
    return Trajectory(
        name="raster",
        joint_names=prepared.robot.joint_names,
        times=np.arange(len(joints)) * seconds,
        joints=joints,
        points=points,
        normals=normals,
        contact=segment >= 0,
        segment=segment,
    )


Maker = Callable[[], tuple[PreparedScene, BuildResult, Trajectory]]
