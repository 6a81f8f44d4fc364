"""Trajectories and verdicts on them as values."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from documents import TRAJECTORY, VERDICT
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import Fault, TrajectoryVerdict
from cellcolor.errors import InputError


def in_contact(contact: list[bool]) -> Trajectory:
    k = len(contact)
    none = np.zeros((k, 3))
    segment = np.where(contact, 0, -1) if k else np.zeros(0, dtype=int)
    return Trajectory("t", ("pan",), np.arange(k), np.zeros((k, 1)), none, none, contact, segment)


@given(contact=st.lists(st.booleans(), max_size=12))
def test_strokes_are_the_stretches_in_contact(contact: list[bool]) -> None:
    trajectory = in_contact(contact)
    inside = [k for first, after in trajectory.strokes for k in range(first, after)]
    assert inside == [k for k, on in enumerate(contact) if on]
    text = "".join("x" if on else " " for on in contact)
    assert len(trajectory.strokes) == len(text.split())
    assert trajectory.lift_offs == max(0, len(text.split()) - 1)


def test_seconds_and_text() -> None:
    trajectory = Trajectory.from_document(TRAJECTORY)
    assert trajectory.seconds == 1.0
    assert str(trajectory) == "three samples: 2 strokes, 1 lift-off, 1.0 s, 3 samples"
    assert in_contact([]).seconds == 0


def test_a_verdict_is_valid_without_faults_only() -> None:
    verdict = TrajectoryVerdict.from_document(VERDICT)
    assert not verdict.valid
    assert str(verdict) == "three samples: not valid, 1 fault, 1 lift-off"
    assert verdict.of_kind("jump") == verdict.faults
    assert verdict.of_kind("time") == ()
    clean = copy.deepcopy(VERDICT) | {"fault_counts": {}, "faults": []}
    with pytest.raises(InputError, match="valid: says something else"):
        TrajectoryVerdict.from_document(clean)
    assert TrajectoryVerdict.from_document(clean | {"valid": True}).valid


def test_a_fault_in_a_line() -> None:
    fault = Fault("jump", "pan moves", 3, 4, 0.5, "pan", None, (0.0, 0.25, 1.0))
    assert str(fault) == "jump: samples 3 to 4 at 0.500 s (0.000, 0.250, 1.000) m: pan moves"
    assert str(Fault("repeated", "too often")) == "repeated: too often"
