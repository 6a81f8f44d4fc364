"""Each shipped scene and each arm that comes along against Pinocchio and coal, on candidates.

The slow ones are 2,000 candidates each.
"""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from independent import CONTACT, kinematics_apart
from reasons import Reason
from shipped import TOP, shipped
from world import World, in_coal

from cellcolor.frontend import build_surface
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.scene import Scene

pytestmark = pytest.mark.second

SIX = ["hemisphere_flat", "hemisphere_tilted", "half_pipe", "wok", "wok_obstacle", "square"]
SCENES = [
    *SIX,
    "irb120_half_pipe",
    "kr6_half_pipe",
    "tx2_60_half_pipe",
    "ur10e_wok",
    "ur16e_half_pipe",
    "ur3e_half_pipe",
    "ur5e_calibrated_wok",
    "ur5e_half_pipe",
    "cobra600_pipe",
]


def scene_of(name: str) -> Scene:
    """A scene in which an arm hits itself, the ground and the part now and then."""
    if name in SIX:
        return shipped(name)
    if name != "cobra600_pipe":
        return Scene.read(TOP / "instances" / "arms" / f"{name}.toml")
    scene = Scene.read(TOP / "instances" / "planar" / f"{name}.toml")
    near = scene.moved(position_m=(0.2, 0.0, 0.04), rpy_rad=(0.5, 0.0, 0.0))
    return near.varied(ground={"height_m": 0.25})


def not_neighbors(world: World) -> set[frozenset[str]]:
    """The pairs of solid links that are not next to each other on the way from base to tool."""
    shapes = zip(world.geometry.geometryObjects, world.link, strict=True)
    joint = {link: int(shape.parentJoint) for shape, link in shapes}
    # The tool hangs on the last joint, behind the arm's own link there.
    way = sorted(joint, key=lambda link: (joint[link], link == "tool_body"))
    beside = {frozenset(pair) for pair in itertools.pairwise(way)}
    return {frozenset(pair) for pair in itertools.combinations(way, 2)} - beside


@pytest.mark.parametrize(
    ("vertices", "count"), [(150, 100), pytest.param(1000, 2000, marks=pytest.mark.slow)]
)
@pytest.mark.parametrize("name", SCENES)
def test_candidates_against_pinocchio_and_coal(name: str, vertices: int, count: int) -> None:
    """Candidates that have a configuration, whatever became of them."""
    scene = scene_of(name).varied(object={"target_vertices": vertices})
    prepared, built = prepare(scene), build_surface(scene)
    flat = built.configurations.reshape(-1, prepared.robot.joints)
    solved = np.flatnonzero(built.reasons.ravel() != Reason.NO_SOLUTION)
    rows = np.random.default_rng(5).choice(solved, min(count, len(solved)), replace=False)
    joints = flat[rows]
    assert kinematics_apart(prepared.robot, joints, torques=False) < 1e-9

    robot, ground = prepared.robot, scene.ground
    assert ground is not None
    exempt = scene.setup.robot.may_touch_ground
    verdicts = {
        "ground": prepared.contacts["ground"](joints),
        "robot": prepared.contacts["self collision"](joints),
        "object": prepared.contacts["object collision"](joints),
    } | ({"obstacle": prepared.contacts["obstacle collision"](joints)} if scene.obstacle else {})
    posts = [each for post in scene.obstacle for each in in_coal(post)]
    world = World(robot, prepared.surface.vertices, prepared.surface.faces)
    pairs, hits = not_neighbors(world), dict.fromkeys(verdicts, 0)
    for row, q in enumerate(joints):
        world.place(q)
        distances = {
            "ground": world.to_ground(ground.height_m, exempt),
            "robot": world.to_itself(pairs),
            "object": world.to_object(),
        } | ({"obstacle": min(world.to_solid(*post) for post in posts)} if posts else {})
        for test, distance in distances.items():
            hits[test] += int(verdicts[test][row])
            # A shell has no depth: what coal calls 0 may be any depth.
            assert verdicts[test][row] == (distance <= 0) or 0 < abs(distance) <= CONTACT, (
                name,
                test,
                q.tolist(),
                distance,
            )
    print(f"\n{name}: {len(joints)} candidates, hits {hits}")
    assert 0 < hits["robot"] < len(joints) and 0 < hits["object"] < len(joints)
