"""What a trajectory states: its lift-offs against the proof, and the places that it leaves out."""

from __future__ import annotations

from dataclasses import replace

import pytest

pytest.importorskip("pinocchio", reason="the extra 'frontend' is not installed")

import numpy as np
import rasters

from cellcolor.data.trajectory import LeftOut
from cellcolor.deadline import NEVER
from cellcolor.frontend.parts.surface import Surface
from cellcolor.trajectory_checker.claims import judge_left_out, judge_lift_offs
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.fine_mesh import refined


@pytest.mark.parametrize(
    ("segments", "faults"), [((), 1), ((0,), 1), ((7,), 0), ((7, 8), 0)], ids=str
)
def test_a_whole_segment_left_out_allows_one_fewer(segments: tuple[int, ...], faults: int) -> None:
    """Three segments are needed for all of the surface, and the drive has two of them.

    With the third stated as left out it is no contradiction. A part of a segment that is driven
    makes no difference.
    """
    drive = rasters.cap()[2]
    assert drive.lift_offs == 1
    assert 0 in drive.segment[drive.contact] and 7 not in drive.segment
    left_out = tuple(LeftOut(number, 1e-5, "ground", (0.0, 0.0, 0.0)) for number in segments)
    found = FaultList(drive, timed=True)
    judge_lift_offs(replace(drive, left_out=left_out, extra_lift_offs=()), 2, found)
    assert found.counts["lift-offs"] == faults


@pytest.mark.parametrize(("beside", "faults"), [(0, 0), (1, 0), (2, 0), (3, 1)])
def test_a_place_is_left_out_rightly_with_its_neighbors(beside: int, faults: int) -> None:
    """A strip of triangles; its last vertex is stated, and one before it is out of reach."""
    places = np.array([[x, y, 0.0] for x in range(6) for y in range(2)])
    corner = 2 * np.arange(5)[:, None]
    faces = np.concatenate([corner + np.array([0, 2, 1]), corner + np.array([1, 2, 3])])
    fine = refined(Surface(places, faces, np.tile([0.0, 0.0, 1.0], (12, 1))), 2.0, NEVER)
    drive = rasters.cap()[2]
    stated = replace(drive, left_out=(LeftOut(0, 0.5, "self collision", (5.0, 0.0, 0.0)),))
    right = np.zeros(12, dtype=bool)
    right[2 * (5 - beside)] = True
    found, areas = FaultList(drive, timed=True), np.full(12, 0.5)
    judge_left_out(stated, fine, areas, ~np.ones(12, bool), right, np.ones(12, bool), 0.1, found)
    assert found.counts["claim"] == faults
