"""A valid motion with an obstacle put in its way: the judge finds it where coal does."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pinocchio", reason="the extra 'frontend' is not installed")
pytest.importorskip("coal")

import rasters
from standing import KINDS, standing
from world import World

from cellcolor.frontend.prepared import prepare
from cellcolor.trajectory_checker.check import check_trajectory


@pytest.mark.parametrize("kind", KINDS)
def test_an_obstacle_in_the_way_is_found(kind: str, tmp_path: Path) -> None:
    prepared, built, trajectory = rasters.square()
    middle = trajectory.points[len(trajectory.points) // 2] + np.array([0.0, 0.0, 0.15])
    obstacle, shapes = standing(kind, middle, tmp_path)
    blocked = prepare(prepared.scene.with_obstacle(obstacle))
    world = World(prepared.robot, prepared.surface.vertices, prepared.surface.faces)
    gaps = []
    for q in trajectory.joints:
        world.place(q)
        gaps.append(min(world.to_solid(*shape) for shape in shapes))
    hit = np.flatnonzero(np.array(gaps) < 0)
    assert len(hit) > 0
    verdict = check_trajectory(blocked, built, trajectory)
    found = [f for f in verdict.of_kind("invalid") if f.reason == "obstacle collision"]
    assert found and abs(min(fault.sample for fault in found) - hit[0]) <= 1
