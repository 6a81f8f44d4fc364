"""Transfers keep clear of every kind of obstacle, and of a tilted ground, by coal's distances."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import rasters
from shipped import shipped
from world import KINDS, World, standing

from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.scene import Ground, Scene
from cellcolor.motion.free_space import FreeSpace

ARMS = Path(__file__).parents[2] / "instances" / "arms"
CLEARANCE, CLOSE = 0.005, 0.0005  # m; what is kept, and where verdicts may differ


@pytest.mark.second
@pytest.mark.parametrize("kind", [*KINDS, "ground"])
def test_what_is_clear_without_it_is_clear_with_it_where_it_is_far(
    kind: str, tmp_path: Path
) -> None:
    scene = shipped("wok", 200).varied(ground=None)
    prepared = prepare(scene)
    world = World(prepared.robot, prepared.surface.vertices, prepared.surface.faces)
    joints = np.random.default_rng(4).uniform(-np.pi, np.pi, (1500, 6))
    joints = joints[FreeSpace(prepared, CLEARANCE).clear(joints)]
    exempt = prepared.setup.robot.may_touch_ground
    shapes = []
    if kind == "ground":
        other = scene.varied(ground=Ground(height_m=-0.3, normal=(0.4, 0.1, 1.0)))
    else:
        place = np.array([0.4 if kind == "half-space" else -0.4, 0.3, 0.3])
        obstacle, shapes = standing(kind, place, tmp_path)
        other = scene.with_obstacle(obstacle)
    clear = FreeSpace(prepare(other), CLEARANCE).clear(joints)
    gaps = []
    for q in joints:
        world.place(q)
        if kind == "ground":
            gaps.append(world.to_ground(-0.3, exempt, (0.4, 0.1, 1.0)))
        else:
            gaps.append(min(world.to_solid(*shape) for shape in shapes))
    gap = np.array(gaps)
    # The region at the tip is a body here as well, and coal is not asked about it.
    assert not clear[gap < CLEARANCE - CLOSE].any()
    assert clear.any() and not clear.all()
    far = gap > CLEARANCE + 0.02  # the tip's region ends within 16 mm of the tool's body
    assert clear[far].all()


@pytest.mark.parametrize(("scene", "clearance"), [("irb120_half_pipe", 0.02), ("kr6_wok", 0.05)])
def test_what_is_clear_with_more_room_is_clear_with_less(scene: str, clearance: float) -> None:
    """Links that are never so far apart as the whole clearance are a part of this."""
    prepared = prepare(Scene.read(ARMS / f"{scene}.toml"))
    joints = np.random.default_rng(4).uniform(-np.pi, np.pi, (400, len(prepared.robot.lower)))
    joints = joints[FreeSpace(prepared, clearance).clear(joints)]
    assert len(joints)
    for share in (0.4, 0.1):
        assert FreeSpace(prepared, clearance, share).clear(joints).all()


def test_an_arm_without_any_body_is_free_but_for_its_tip() -> None:
    prepared = prepare(shipped("wok", 200))
    bare = replace(prepared.robot, bodies=(), tested_pairs=())
    armless = replace(prepared, arm=replace(prepared.arm, robot=bare))
    joints = np.random.default_rng(8).uniform(-np.pi, np.pi, (300, 6))
    clear = FreeSpace(armless, CLEARANCE).clear(joints)
    assert clear.any() and not clear.all()
    assert clear[FreeSpace(prepared, CLEARANCE).clear(joints)].all()


@pytest.mark.parametrize(("height", "free"), [(0.003, True), (-0.0005, True), (-0.003, False)])
def test_a_tool_that_leaves_may_touch_the_object_but_not_pass_through_it(
    height: float, free: bool
) -> None:
    """The tip above a sheet, a hair under it, and 3 mm under it."""
    prepared, _, drive = rasters.square()
    at = np.flatnonzero(drive.contact)[[10, 200]]
    normals = drive.normals[at]
    points = drive.points[at] + height * normals
    all_branches = prepared.arm.inverse(points, -normals)
    off = np.abs(all_branches - drive.joints[at][:, None]).max(axis=2)
    joints = all_branches[np.arange(len(at)), np.nanargmin(off, axis=1)]
    clear = FreeSpace(prepared, 0.0, leaving=True).clear(joints)
    assert clear.tolist() == [free] * len(at)
