"""What a build takes beside what it returns, and what is refused before it is begun."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from shipped import shipped

from cellcolor import memory
from cellcolor.errors import TooLarge
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.trajectory_checker.area import _near

pytestmark = pytest.mark.second


@cache
def prepared(arm: str) -> PreparedScene:
    return prepare(shipped(f"../arms/{arm}"))


@given(st.lists(st.integers(0, 50), max_size=60), st.integers(1, 90))
def test_batches_are_whole_and_fit(sizes: list[int], most: int) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(memory, "CHUNK", most)
        parts = list(memory.batches(np.array(sizes, dtype=np.int64)))
        rows = list(memory.chunks(len(sizes)))
    for found in (parts, rows):
        assert [k for part in found for k in range(part.start, part.stop)] == list(
            range(len(sizes))
        )
    assert all(part.stop - part.start <= most for part in rows)
    for part in parts:
        assert part.stop - part.start == 1 or sum(sizes[part]) <= most


def test_more_than_the_machine_has_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "machine_memory", lambda: 10_000_000)
    with pytest.raises(
        TooLarge, match=r"judging 100,000 configurations of the arm would take 0.0 GB"
    ):
        prepared("ur5e_wok").judge(np.full((100_000, 6), np.nan))
    with pytest.raises(TooLarge, match="passes the same place too often"):
        points = np.zeros((400, 3))
        next(_near(cKDTree(points), points, 1.0))
