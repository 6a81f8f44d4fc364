"""The judge asks for the margins that the planner was asked for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("pinocchio", reason="the extra 'frontend' is not installed")

import rasters

from cellcolor.frontend.prepared import prepare
from cellcolor.trajectory_checker.check import check_trajectory


@pytest.mark.parametrize(("margin", "kept"), [(0.0095, True), (0.0105, False)])
def test_the_tool_keeps_its_margin_to_the_object(margin: float, kept: bool) -> None:
    """Its body ends 10 mm above the tip, which is on a flat square, and is flat itself."""
    prepared, built, trajectory = rasters.square()
    setup = prepared.setup.varied(margins={"to_object_m": margin})
    wide = prepare(prepared.scene.with_setup(setup))
    verdict = check_trajectory(replace(built, prepared=wide), trajectory)
    faults = [f for f in verdict.of_kind("invalid") if f.reason == "object collision"]
    assert bool(faults) != kept
    if not kept:
        invalid = np.zeros(len(trajectory.times), dtype=bool)
        for fault in faults:
            invalid[fault.sample : fault.last_sample + 1] = True
        assert invalid[trajectory.contact].all()


@pytest.mark.parametrize(
    ("key", "reason"), [("to_ground_m", "ground"), ("between_links_m", "self collision")]
)
def test_other_margins_are_asked_for_as_well(key: str, reason: str) -> None:
    prepared, built, trajectory = rasters.square()
    setup = prepared.setup.varied(margins={key: 0.4})
    scene = prepared.scene.with_setup(setup).varied(ground={"height_m": -0.2})
    verdict = check_trajectory(replace(built, prepared=prepare(scene)), trajectory)
    assert {f.reason for f in verdict.of_kind("invalid")} == {reason}
