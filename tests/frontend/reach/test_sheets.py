"""Continuity without names: the same colors as with names, and cuspidal arms refused."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import dh_arms
import numpy as np
import pytest
from arm_plates import cuspidal_scene, plate
from continuation import Follower
from independent import wrapped
from library import INSTANCES
from scipy.sparse import coo_array
from scipy.sparse.csgraph import shortest_path
from shipped import ROBOTS, shipped

import cellcolor
from cellcolor.arrays import Array
from cellcolor.deadline import NEVER
from cellcolor.errors import InputError
from cellcolor.frontend import BuildResult, Scene, build_surface
from cellcolor.frontend.arm.inverse import InverseKinematics
from cellcolor.frontend.arm.kinematics import forward, signed_task_determinant
from cellcolor.frontend.build import StageClock, build_prepared
from cellcolor.frontend.prepared import PreparedScene, named, prepare
from cellcolor.frontend.reach.sheets import Followed
from cellcolor.frontend.reach.smooth import Tracker

pytestmark = pytest.mark.second


class Unnamed(InverseKinematics):
    """A family of arms without its names: at every point its solutions are in another order, and
    their joints turned by full circles."""

    branches = ()

    def __init__(self, inner: InverseKinematics) -> None:
        self._inner = inner
        self.lever, self.reach, self.viewpoints = inner.lever, inner.reach, inner.viewpoints

    def solve(self, points: Array, directions: Array, branches: Any = None) -> Array:
        assert branches is None
        found = self._inner.solve(points, directions)
        salt = np.remainder(np.sin(1e5 * points.sum(axis=1))[:, None] * np.arange(1, 9), 1)
        turned = found + 2 * np.pi * np.rint(3 * salt - 1.5)[:, :, None]
        return np.take_along_axis(turned, np.argsort(salt, axis=1)[:, :, None], axis=1)


def without_names(scene: Scene) -> tuple[PreparedScene, PreparedScene]:
    """A scene as it is, and with its arm's solutions told apart by continuity alone."""
    prepared = prepare(scene)
    arm = replace(prepared.arm, kinematics=Unnamed(prepared.arm.kinematics))
    unnamed = named(replace(prepared, arm=arm))
    return prepared, unnamed


def both(scene: Scene) -> tuple[BuildResult, BuildResult]:
    """What comes out with names and without."""
    first, second = (build_prepared(each, StageClock(NEVER, None)) for each in without_names(scene))
    return first, second


def as_sets(built: BuildResult, named: BuildResult) -> set[frozenset[tuple[int, int]]]:
    """The colors as sets of vertices with the branches that their configurations have by name."""
    node_color = built.coloring.node_color
    vertex, column = np.nonzero(node_color >= 0)
    off = wrapped(named.configurations[vertex] - built.configurations[vertex, column][:, None])
    far = np.nan_to_num(off.max(axis=2), nan=np.inf)
    assert far.min(axis=1).max() < 1e-6
    colors: dict[int, set[tuple[int, int]]] = {}
    color = node_color[vertex, column].tolist()
    for each, node in zip(color, zip(vertex, far.argmin(axis=1), strict=True), strict=True):
        colors.setdefault(each, set()).add((int(node[0]), int(node[1])))
    return set(map(frozenset, colors.values()))


def check_without_names(scene: Scene) -> None:
    """The same colors, cracks and minimum as with names; and reasons, but for the order."""
    own, unnamed = both(scene)
    assert len(as_sets(own, own)) >= 1
    assert as_sets(unnamed, own) == as_sets(own, own)
    assert [(c.i, c.j) for c in unnamed.coloring.cracks] == [
        (c.i, c.j) for c in own.coloring.cracks
    ]
    assert unnamed.all_colors.linked.sum() == own.all_colors.linked.sum()
    assert (np.sort(own.reasons, axis=1) == np.sort(unnamed.reasons, axis=1)).all()
    assert unnamed.branches[0] == "sheet-1"
    minima = [cellcolor.solve(each.surface).solution for each in (own, unnamed)]
    assert len({(each.segments, each.status) for each in minima}) == 1


@pytest.mark.parametrize("name", ["wok", "square", "half_pipe"])
def test_colors_are_the_same_without_names(name: str) -> None:
    check_without_names(shipped(name, 200))


@pytest.mark.slow
@pytest.mark.parametrize(
    "file",
    [
        file
        for folder in ("scenes", "arms", "parts")
        for file in sorted((INSTANCES / folder).glob("*.toml"))
        if "refused" not in file.stem
    ],
    ids=lambda file: file.stem,
)
def test_shipped_scenes_and_parts_are_the_same_without_names(file: Path) -> None:
    check_without_names(Scene.read(file))


def test_without_names_an_arm_with_passing_wrist_axes_has_colors() -> None:
    result = build_surface(plate(dh_arms.urdf("passing"), "eaik", vertices=60))
    assert "none found on this part" in str(result.report)
    assert "not cuspidal" not in str(result.report)
    follower, linked = Follower(result.robot), result.all_colors.linked
    row, sheet = np.argwhere(linked).T
    assert len(row) > 300 and max(color.vertices for color in result.report.colors) > 40
    surface = result.prepared.surface
    # By Newton's method on Pinocchio's Jacobian the links lead to where the sheets say.
    for k in np.random.default_rng(1).choice(len(row), 8, replace=False):
        ends = surface.mesh.edges[row[k]]
        start, goal = result.configurations[ends, sheet[k]]
        path = follower.along(start, surface.vertices[ends], surface.normals[ends])
        assert path is not None and wrapped(path[-1] - goal).max() < 1e-6


def linked_nodes(prepared: PreparedScene) -> tuple[Array, Array, Array]:
    """All solutions (n, s, joints) of a scene, the valid ones (n, s), and links (l, 3) of them."""
    surface = prepared.surface
    arm = prepared.arm.bare
    found = arm.inverse(surface.vertices, -surface.normals)
    verdicts = prepared.judge(found)
    nodes = verdicts.valid
    tracker = Tracker(arm.robot, arm.measure, arm.conditioning)
    solutions = tracker.described(verdicts.configurations)
    limits = prepared.robot.lower, prepared.robot.upper
    matching = Followed.of(surface, nodes, solutions, tracker, limits)
    return solutions.joints, nodes, matching.along(surface.mesh.edges, NEVER)[0]


@pytest.mark.second
def test_a_cuspidal_arm_is_refused_with_both_configurations(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene = cuspidal_scene()
    with pytest.raises(InputError, match="cuspidal") as caught:
        build_surface(scene)
    message = str(caught.value)
    assert "\n" not in message and " m one color has " in message and " and [" in message
    vertex = int(str(caught.value.field).removeprefix("vertices[").removesuffix("]"))

    # It is true: an independent motion through regular configurations leads from one to the other.
    monkeypatch.setattr("cellcolor.frontend.prepared.named", lambda prepared, _: prepared)
    prepared = prepare(scene)
    surface, robot = prepared.surface, prepared.robot
    edges = surface.mesh.edges
    joints, nodes, pairs = linked_nodes(prepared)
    slots = nodes.shape[1]
    here, there = (edges[pairs[:, 0], end] * slots + pairs[:, 1 + end] for end in (0, 1))
    graph = coo_array((np.ones(len(pairs)), (here, there)), shape=(nodes.size,) * 2)
    own = vertex * slots + np.flatnonzero(nodes[vertex])
    ways, before = shortest_path(graph, directed=False, indices=own, return_predecessors=True)
    first, last = next(
        (i, j) for i in range(len(own)) for j in own[i + 1 :] if np.isfinite(ways[i, j])
    )
    route = [int(last)]
    while route[-1] != own[first]:
        route.append(int(before[first, route[-1]]))
    follower, q, signs = Follower(robot), joints[vertex, last % slots], []
    for a, b in pairwise(route):
        ends = [a // slots, b // slots]
        path = follower.along(q, surface.vertices[ends], surface.normals[ends])
        assert path is not None
        poses = forward(robot, path)
        signs.append(signed_task_determinant(poses))
        q = path[-1]
    values = np.concatenate(signs)
    assert wrapped(q - joints[vertex, own[first] % slots]).max() < 1e-6
    assert wrapped(q - joints[vertex, last % slots]).max() > 0.1
    assert (values > 0).all() or (values < 0).all()


@pytest.mark.slow
def test_an_arm_without_names_is_driven_and_judged_like_the_others() -> None:
    """Painting, motion and judge follow sheets where they follow branches of other arms."""
    bare = plate(dh_arms.urdf("passing"), "eaik", vertices=60)
    tool = {"tool_urdf": str(ROBOTS / "polishing_tool.urdf")}
    planned = cellcolor.plan(bare.with_setup(bare.setup.varied(robot=tool)))
    assert planned.verdict.valid and planned.verdict.lift_offs == 0
    assert planned.solution.lower_bound == 1 and "sheet" in planned.built.branches[0]
