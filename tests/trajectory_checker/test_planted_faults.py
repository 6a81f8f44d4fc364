"""Planted faults are found with kind, joint and time; the benchmark does the same 1,000 times."""

from __future__ import annotations

import numpy as np
import pytest
import rasters
from planted_faults import PLANTERS, found

from cellcolor.trajectory_checker.check import check_trajectory

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("make", [rasters.cap, rasters.square])
def test_the_untouched_ones_have_none(make: rasters.Maker) -> None:
    assert check_trajectory(*make()[1:]).faults == ()


@pytest.mark.parametrize("name", PLANTERS)
def test_planted_faults_are_found(name: str) -> None:
    for seed in range(4):
        prepared, built, trajectory = rasters.cap() if seed % 2 == 0 else rasters.square()
        if name == "1 mm inside an obstacle":  # only one of them has one
            prepared, built, trajectory = rasters.cap()
        planted = PLANTERS[name](prepared, trajectory, np.random.default_rng(seed))
        verdict = check_trajectory(built, planted.trajectory)
        assert found(planted, verdict), (seed, planted.joint, planted.samples, verdict.faults)
