"""The table of ``benchmarks/path_first.py``: strokes are what the judge of trajectories accepts."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
from shipped import TOP, shipped

from cellcolor.frontend import build_surface

sys.path.append(str(TOP / "benchmarks"))
from path_first import accepted, counted


def test_strokes_of_the_square_and_a_jump_planted_in_them() -> None:
    """One stroke covers the square; a full circle in the middle of it makes two."""
    scene = shipped("square", 200)
    built = build_surface(scene.with_setup(scene.setup.varied(motion=None)))
    one = counted(built, 0.5, 0.06)
    assert (one.optimistic, one.judged, len(one.strokes)) == (0, 0, 1)
    joints = one.trajectory.joints.copy()
    middle = len(joints) // 2
    joints[middle:, 5] += 2 * np.pi
    contact = accepted(built, replace(one.trajectory, joints=joints))
    assert one.trajectory.contact[middle - 1 : middle + 2].all()
    begins = np.flatnonzero(contact[1:] & ~contact[:-1])
    assert begins.tolist() == [middle] and contact[0]
