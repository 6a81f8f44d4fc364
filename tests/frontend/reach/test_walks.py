"""The promise of a color: random walks in its domain, followed millimeter by millimeter.

A walk runs along mesh edges that are no crack of its color; segments are parts of such domains.
Every edge is cut into pieces of at most 1 mm. Positions are on the mesh, straight between its
vertices, and the tool turns with the normal; both are stated below against the smooth object.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
import pytest
from independent import shorter_way
from reasons import Reason
from shipped import shipped
from world import PAIRS, World

from cellcolor.arrays import Array
from cellcolor.configurations.matching import farthest, stays_within
from cellcolor.frontend import BuildResult, build_surface
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.contact.obstacle import SphereObstacle
from cellcolor.frontend.parts.surface import along_edges
from cellcolor.frontend.prepared import PreparedScene, prepare

pytestmark = pytest.mark.slow

NAMES = ["hemisphere_flat", "hemisphere_tilted", "half_pipe", "wok", "wok_obstacle", "square"]
STEPS = 25
MILLIMETER = 0.001
FAST = 0.1  # rad


def walks(result: BuildResult, count: int, seed: int) -> Iterator[tuple[list[int], int]]:
    """Vertices of random walks and their branch, colors taken by the area that they reach."""
    random = np.random.default_rng(seed)
    surface = result.surface
    torn = {(c.i, c.j, k) for c in surface.cracks for k in c.colors}
    beside: dict[int, set[int]] = {}
    for face in surface.faces.tolist():
        for i, j in zip(face, face[1:] + face[:1], strict=True):
            beside.setdefault(i, set()).add(j)
            beside.setdefault(j, set()).add(i)
    nodes = np.argwhere(result.node_color >= 0)
    for vertex, branch in random.choice(nodes, count).tolist():
        color, way = result.node_color[vertex, branch], [vertex]
        for _ in range(STEPS):
            onward = [
                other
                for other in sorted(beside[way[-1]])
                if result.node_color[other, branch] == color
                and (min(way[-1], other), max(way[-1], other), color) not in torn
            ]
            if not onward:
                break
            way.append(int(random.choice(onward)))
        yield way, branch


def follow(prepared: PreparedScene, way: list[int], branch: int) -> tuple[Array, Array, Array]:
    """Points, tool directions and configurations along a walk."""
    edges = np.array(list(itertools.pairwise(way)), dtype=np.int64).reshape(-1, 2)
    pieces = np.ceil(prepared.surface.lengths(edges) / MILLIMETER).astype(int)
    rows = np.repeat(np.arange(len(edges)), pieces)
    at = np.concatenate([np.arange(count) / count for count in pieces] or [np.zeros(0)])
    points, directions = along_edges(prepared.surface, edges[rows], at)
    return points, directions, prepared.arm.follow(points, directions, np.full(len(points), branch))


def largest_part(
    prepared: PreparedScene, points: Array, directions: Array, branch: int, piece: int
) -> float:
    """Largest of 50 steps between two successive points: all of it for a jump."""
    at = np.linspace(0, 1, 51)[:, None]
    between = (1 - at) * points[piece] + at * points[piece + 1]
    turned = (1 - at) * directions[piece] + at * directions[piece + 1]
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    joints = prepared.arm.follow(between, turned, np.full(len(at), branch))
    return float(farthest(joints[:-1], joints[1:]).max())


@pytest.mark.parametrize(("vertices", "count"), [(300, 40), (1000, 1000)])
@pytest.mark.parametrize("name", NAMES)
def test_random_walks(name: str, vertices: int, count: int) -> None:
    scene = shipped(name, vertices)
    result, prepared = build_surface(scene), prepare(scene)
    robot = prepared.robot
    all_points, all_directions, all_joints = [], [], []
    for way, branch in walks(result, count, seed=7):
        points, directions, joints = follow(prepared, way, branch)
        if not len(points):
            continue
        # Beside a singularity a motion is fast, but in fifty parts of a piece it is even.
        step = farthest(joints[:-1], joints[1:])
        for piece in {int(np.argmax(step)), *np.flatnonzero(step > FAST).tolist()}:
            assert largest_part(prepared, points, directions, branch, piece) < 0.1 * step[piece]
        way_there = shorter_way(joints[:-1], joints[1:])
        assert stays_within((robot.lower, robot.upper), joints[:-1], *way_there).all()
        all_points.append(points)
        all_directions.append(directions)
        all_joints.append(joints)
    joints = np.concatenate(all_joints)
    assert len(joints) > 50 * count
    reasons = prepared.judge(joints).reasons
    assert (reasons == Reason.VALID).all(), {Reason(r).text for r in np.unique(reasons)}
    poses = forward(robot, joints)
    assert np.abs(poses.tip - np.concatenate(all_points)).max() < 1e-9
    assert np.abs(poses.tool_axis - np.concatenate(all_directions)).max() < 1e-9
    # Once more with other code, one by one.
    world = World(robot, prepared.surface.vertices, prepared.surface.faces)
    for q in np.random.default_rng(1).choice(joints, count):
        world.place(q)
        assert world.to_itself(PAIRS) > -0.0005
        assert world.to_object() > 0
        assert prepared.scene.ground is not None
        exempt = prepared.setup.robot.may_touch_ground
        assert world.to_ground(prepared.scene.ground.height_m, exempt) > -0.0005


def linked_edges(result: BuildResult, edges: Array) -> Array:
    """Which edges (k, 2) are linked in each branch, (k, branches)."""
    i, j = edges.T
    color = result.node_color
    linked = (color[i] >= 0) & (color[i] == color[j])
    row_of = {(start, end): row for row, (start, end) in enumerate(edges.tolist())}
    for crack in result.surface.cracks:
        row = row_of[crack.i, crack.j]
        linked[row] &= ~np.isin(color[crack.i], crack.colors)
    return linked


def test_an_obstacle_between_two_vertices_is_met() -> None:
    """The elbow would pass through a sphere of 16 mm on an edge of 14 mm.

    It moves 100 mm on that edge. No vertex is invalid for the sphere, and no edge there lies at a
    domain's border.
    """
    ball = SphereObstacle(radius_m=0.008, position_m=(-0.369, -0.149, 0.228))
    scene = shipped("square").with_obstacle(ball)
    result, prepared = build_surface(scene), prepare(scene)
    edges = prepared.surface.mesh.edges
    branch = result.branches.index("shoulder-left elbow-up wrist-flipped")
    rows = np.flatnonzero(linked_edges(result, edges)[:, branch])
    way = np.linspace(0, 1, 21)
    points, directions = along_edges(
        prepared.surface, np.repeat(edges[rows], len(way), axis=0), np.tile(way, len(rows))
    )
    joints = prepared.arm.follow(points, directions, np.full(len(points), branch))
    assert len(rows) > 2000
    assert (prepared.judge(joints).reasons == Reason.VALID).all()
