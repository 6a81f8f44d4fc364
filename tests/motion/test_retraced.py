"""Places where a stroke goes the same way again, on walks along the lines of a grid."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

from cellcolor.motion.retraced import retraced, stretches

WAYS = st.sampled_from([(1, 0), (-1, 0), (0, 1), (0, -1)])


@given(st.lists(WAYS, min_size=1, max_size=12), st.integers(4, 9))
@example([(1, 0), (0, 1), (0, -1), (1, 0)], 5)  # a way in and back
@settings(max_examples=150, deadline=None)
def test_what_is_walked_twice_is_marked(ways: list[tuple[int, int]], pieces: int) -> None:
    """Against counting how often each line of the grid is walked; its ends are left out.

    There another line may begin that is walked once, or the walk may turn round.
    """
    nodes = np.concatenate([[[0, 0]], np.cumsum(ways, axis=0)])
    lines = [frozenset([tuple(a), tuple(b)]) for a, b in pairwise(nodes.tolist())]
    walked = Counter(lines)
    points, expected = [np.zeros(3)], [None]
    for number, (a, b) in enumerate(pairwise(nodes)):
        # Each pass has its places at other parts of the line, as samples of both ways have.
        parts = np.append((np.arange(pieces) + 0.3 + 0.05 * (number % 8)) / (pieces + 1), 1.0)
        for part in parts.tolist():
            points.append(np.append(a + part * (b - a), 0.0))
            inner = 0.25 < part < 0.75
            expected.append(walked[lines[number]] > 1 if inner else None)
    marked = retraced(np.array(points) / 100)
    for known, found in zip(expected, marked.tolist(), strict=True):
        assert known is None or known == found


def test_stretches_are_runs_of_two_points_or_more() -> None:
    marked = np.array([True, True, False, True, False, False, True, True, True])
    assert stretches(marked) == [(0, 1), (6, 8)]
    assert stretches(np.zeros(3, dtype=bool)) == [] and retraced(np.zeros((2, 3))).sum() == 0
