"""A valid motion with an obstacle put in its way: the judge finds it where coal does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pinocchio", reason="the extra 'frontend' is not installed")
pytest.importorskip("coal")

import rasters
from world import KINDS, World, standing

from cellcolor.arrays import Array
from cellcolor.frontend.prepared import prepare
from cellcolor.trajectory_checker.check import check_trajectory


@pytest.mark.parametrize("kind", KINDS)
def test_an_obstacle_in_the_way_is_found(kind: str, tmp_path: Path) -> None:
    prepared, built, trajectory = rasters.square()
    middle = trajectory.points[len(trajectory.points) // 2] + np.array([0.0, 0.0, 0.15])
    obstacle, shapes = standing(kind, middle, tmp_path)
    blocked = prepare(prepared.scene.with_obstacle(obstacle))
    world = World(prepared.robot, prepared.surface.vertices, prepared.surface.faces)

    def hits(q: Array) -> bool:
        world.place(q)
        return any(world.to_solid(*shape) < 0 for shape in shapes)

    first = next(sample for sample, q in enumerate(trajectory.joints) if hits(q))
    verdict = check_trajectory(replace(built, prepared=blocked), trajectory)
    found = [f for f in verdict.of_kind("invalid") if f.reason == "obstacle collision"]
    assert found and abs(min(fault.sample for fault in found) - first) <= 1
