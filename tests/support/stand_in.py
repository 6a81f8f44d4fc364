"""A motion made quickly, for what is done with motions: along mesh edges, and straight between.

It is no plan: a segment is walked round a spanning tree of its mesh edges, and nothing is tested.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise

import networkx
import numpy as np
from joint_paths import walk_round
from shipped import shipped

import cellcolor
from cellcolor.arrays import Array
from cellcolor.data.solution import Solution
from cellcolor.data.tool_paths import ToolPath, ToolPaths
from cellcolor.data.trajectory import ExtraLiftOff, LeftOut, Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.door.subject import Result
from cellcolor.frontend import BuildResult, build_surface
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.painting.paint import Painted
from cellcolor.trajectory_checker.check import check_trajectory

SPEED = 0.5  # m/s, so that it is short
RETRACT = 0.05  # m


@dataclass(frozen=True)
class StandIn:
    """A scene and all that comes of it, the motion made by hand."""

    prepared: PreparedScene
    built: BuildResult
    result: Result
    painted: Painted
    normals: Array
    paths: ToolPaths
    trajectory: Trajectory

    @property
    def solution(self) -> Solution:
        return self.result.solution

    @cached_property
    def verdict(self) -> TrajectoryVerdict:
        least = self.solution.lift_offs
        return check_trajectory(self.built, self.trajectory, minimum_lift_offs=least)


@cache
def stand_in(name: str = "wok", vertices: int = 200) -> StandIn:
    prepared = prepare(shipped(name, vertices))
    built = build_surface(prepared.scene)
    result = cellcolor.solve(built)
    painted = cellcolor.paint(built, result)
    normals = prepared.surface.normals[painted.stands_for]
    walks = [_walk(painted, segment) for segment in range(painted.segments)]
    paths = tuple(_path(painted, normals, segment, walk) for segment, walk in enumerate(walks))
    radius = prepared.setup.motion.tool_radius_m
    sha256 = painted.surface.sha256
    tool_paths = ToolPaths(built.surface.name, "tree", 0.01, radius, paths, sha256)
    return StandIn(
        prepared, built, result, painted, normals, tool_paths, _driven(prepared, built, paths)
    )


def _walk(painted: Painted, segment: int) -> list[int]:
    """Vertices round a spanning tree of a segment, the first one at both ends."""
    surface, own = painted.surface, painted.segment_of == segment
    color = painted.plan.vertex_colors[int(np.flatnonzero(own)[0])]
    graph: networkx.Graph = networkx.Graph()
    for a, b in surface.left_of:
        if own[a] and own[b] and color not in surface.cracked(a, b):
            graph.add_edge(a, b)
    return walk_round(graph, min(graph))


def _path(painted: Painted, normals: Array, segment: int, walk: list[int]) -> ToolPath:
    surface = painted.surface
    color = painted.plan.vertex_colors[walk[0]]
    faces = [surface.left_of.get((a, b), surface.left_of.get((b, a))) for a, b in pairwise(walk)]
    return ToolPath(segment, color, surface.vertices[walk], normals[walk], faces)


def _driven(prepared: PreparedScene, built: BuildResult, paths: tuple[ToolPath, ...]) -> Trajectory:
    branch_of = built.coloring.branch
    times, joints, points, normals, contact, segments = [0.0], [], [], [], [], []

    def go(seconds: float, number: int, arm: Array, point: Array, normal: Array) -> None:
        if joints:
            turns = np.round((joints[-1] - arm) / (2 * np.pi))
            arm = arm + 2 * np.pi * turns if number < 0 or contact[-1] else arm
            times.append(times[-1] + seconds)
        joints.append(arm)
        points.append(point)
        normals.append(normal)
        contact.append(number >= 0)
        segments.append(number)

    for path in paths:
        branches = np.full(len(path.points), branch_of[path.color])
        arms = prepared.arm.follow(path.points, -path.normals, branches)
        above = path.points[[0, -1]] + RETRACT * path.normals[[0, -1]]
        ends = prepared.arm.follow(above, -path.normals[[0, -1]], branches[[0, -1]])
        ends = np.where(np.isnan(ends), arms[[0, -1]], ends)
        go(2.0, -1, ends[0], above[0], path.normals[0])
        steps = np.linalg.norm(np.diff(path.points, axis=0), axis=1)
        spent = [1.0, *(np.maximum(steps, 1e-4) / SPEED).tolist()]
        for row in range(len(arms)):
            go(spent[row], path.segment, arms[row], path.points[row], path.normals[row])
        go(1.0, -1, ends[1], above[1], path.normals[-1])
    last = int(np.flatnonzero(contact)[0])
    return Trajectory(
        name=built.surface.name,
        joint_names=prepared.robot.joint_names,
        times=times,
        joints=np.array(joints),
        points=np.array(points),
        normals=np.array(normals),
        contact=contact,
        segment=segments,
        unplanned=(0,),
        extra_lift_offs=(
            ExtraLiftOff(last, 0, "winding", "wrist_2_joint would turn beyond 360°", points[last]),
        ),
        left_out=(LeftOut(0, 1.5e-4, "manipulability", points[last]),),
    )
