"""Bounds of distances near known configurations, against the distances themselves and verdicts."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from meshed_arm import write_package
from world import World

from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.contact.clearance import pair_levers
from cellcolor.frontend.contact.collision import body_ends, segment_distance
from cellcolor.frontend.contact.obstacle import BoxObstacle
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.frontend.scene import Scene

pytestmark = pytest.mark.second

Varied = Callable[..., Scene]


@pytest.fixture(params=[0.0, 0.01])
def prepared(request: pytest.FixtureRequest, scene: Varied) -> PreparedScene:
    """The wok beside an obstacle, touched or kept away from by a margin."""
    margins = {"to_object_m": request.param, "to_obstacles_m": request.param}
    wok = scene(target_vertices=300, radius_m=0.22, half_angle_rad=1.5)
    wok = wok.with_setup(wok.setup.varied(margins=margins | {"between_links_m": request.param}))
    return prepare(wok.with_obstacle(BoxObstacle(size_m=(0.1, 0.1, 0.4), position_m=(0.1, 0.4, 0))))


@pytest.mark.parametrize("margin", [0.0, 0.006])
@pytest.mark.parametrize("chosen", ["hull", "exact"])
def test_verdicts_are_the_same_of_links_with_meshes(
    scene: Varied, tmp_path: Path, chosen: str, margin: float
) -> None:
    urdf = write_package(tmp_path, "toy_description") / "urdf" / "arm.urdf"
    arm = {"arm_urdf": str(urdf), "mesh_collision": chosen}
    kept = {"to_object_m": margin, "to_obstacles_m": margin, "between_links_m": margin}
    wok = scene(target_vertices=300, radius_m=0.22, half_angle_rad=1.5)
    prepared = prepare(wok.with_setup(wok.setup.varied(robot=arm, margins=kept)))
    assert prepared.robot.has_solids
    same_verdicts(prepared, 0.03)


@pytest.mark.parametrize("step", [0.003, 0.03, 0.3])
def test_verdicts_are_the_same_with_known_distances(prepared: PreparedScene, step: float) -> None:
    same_verdicts(prepared, step)


def same_verdicts(prepared: PreparedScene, step: float) -> None:
    rng = np.random.default_rng(3)
    known = rng.uniform(-np.pi, np.pi, (500, 6))
    rows = rng.integers(0, 500, 4000)
    near = known[rows] + rng.uniform(-step, step, (4000, 6))
    judge = prepared.judge
    plain, told = judge(near), judge(near, near=(judge.clearance(known), rows))
    np.testing.assert_array_equal(plain.reasons, told.reasons)
    np.testing.assert_array_equal(plain.tracked, told.tracked)
    assert len(np.unique(plain.reasons)) > 4


def test_links_that_may_not_touch_are_apart_by_coal(prepared: PreparedScene) -> None:
    rng = np.random.default_rng(4)
    known = rng.uniform(-np.pi, np.pi, (60, 6))
    near = known + rng.uniform(-0.1, 0.1, (60, 6))
    robot, tracked = prepared.robot, prepared.judge(near).tracked
    pairs, bodies = prepared.judge.clearance(known).may_touch(np.arange(60), near, tracked)
    assert 0.01 < pairs.mean() < 0.3 and 0.01 < bodies.mean() < 0.5
    links = [frozenset(robot.bodies[i].link for i in pair) for pair in robot.tested_pairs]
    world = World(robot, prepared.surface.vertices, prepared.surface.faces)
    for q, may in zip(near, pairs.T, strict=True):
        world.place(q)
        touching = {pair for pair, asked in zip(links, may, strict=True) if asked}
        assert world.to_itself(set(links) - touching) > 0


@pytest.mark.parametrize("joint", range(6))
def test_levers_bound_how_much_nearer_links_come(prepared: PreparedScene, joint: int) -> None:
    robot, rng = prepared.robot, np.random.default_rng(5)
    before = rng.uniform(-np.pi, np.pi, (2000, 6))
    after = before.copy()
    after[:, joint] += rng.uniform(-1, 1, 2000)
    turned = np.abs(after - before)[:, joint]
    levers = pair_levers(robot)[:, joint]
    first, second = (body_ends(robot, forward(robot, q)) for q in (before, after))
    for (i, j), lever in zip(robot.tested_pairs, levers, strict=True):
        was = segment_distance(*first[i], *first[j])
        now = segment_distance(*second[i], *second[j])
        assert (np.abs(now - was) <= lever * turned + 1e-9).all()


@pytest.mark.parametrize("step", [0.01, 0.1])
def test_bodies_that_may_not_touch_are_apart(prepared: PreparedScene, step: float) -> None:
    rng = np.random.default_rng(6)
    known = rng.uniform(-np.pi, np.pi, (1000, 6))
    near = known + rng.uniform(-step, step, (1000, 6))
    robot, tracked = prepared.robot, prepared.judge(near).tracked
    _, bodies = prepared.judge.clearance(known).may_touch(np.arange(1000), near, tracked)
    ends = body_ends(robot, forward(robot, near))
    place = prepared.workplace
    for number, body in enumerate(robot.bodies):
        apart = np.flatnonzero(~bodies[number])
        for solid in (place.target, *place.obstacles):
            assert not solid.touched_by(body, ends[number][:, apart]).any()
