"""The number of lift-offs held against the proof, where whole segments are left out."""

from __future__ import annotations

from dataclasses import replace

import pytest

pytest.importorskip("pinocchio", reason="the extra 'frontend' is not installed")

import rasters

from cellcolor.data.trajectory import LeftOut
from cellcolor.trajectory_checker.claims import judge_lift_offs
from cellcolor.trajectory_checker.fault_list import FaultList


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
