"""What a build takes beside what it returns, and what is refused before it is begun."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from shipped import shipped

from cellcolor import memory
from cellcolor.errors import TooLarge
from cellcolor.frontend import build_surface
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.trajectory_checker.area import _near

pytestmark = pytest.mark.second

SMALL = 4_000_000  # bytes, for parts of 300 configurations, so that little work has many

Step = Callable[[], object]


@cache
def prepared(arm: str) -> PreparedScene:
    return prepare(shipped(f"../arms/{arm}"))


def temporary(step: Step) -> int:
    """What numpy holds at one time, beside what was there before and what is there after."""
    tracemalloc.start()
    try:
        result = step()
        kept, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert result is not None
    return peak - kept


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


@pytest.mark.slow
@pytest.mark.parametrize("arm", ["ur5e_wok", "kr6_wok"])
def test_a_whole_build(arm: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside what is kept for each vertex, no more than the steps that call each other may take."""
    scene = prepared(arm).scene.varied(object={"target_vertices": 1_000})
    monkeypatch.setattr(memory, "CHUNK", 300)
    vertices = 1_000
    slots, joints, points = 8, 6, len(prepared(arm).judge.tracked_steps)
    # Of a solution: joints twice, determinant, reason, color, bodies; three edges a vertex, each
    # with a link and its copies.
    solution = 2 * 8 * joints + 8 + 1 + 8 + 24 * points
    of_vertex = slots * (solution + 3 * 4 * 8) + 2_048  # the mesh, and its lists of colors
    # An edge's links, points on them, solving, Newton's method.
    assert temporary(lambda: build_surface(scene)) <= 2 * vertices * of_vertex + 4 * SMALL
