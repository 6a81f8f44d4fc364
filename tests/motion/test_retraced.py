"""Places where strokes run beside another pass of theirs, on walks along the lines of a grid."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from cellcolor.motion.assembly import retraced
from examples import examples

WAYS = st.sampled_from([(1, 0), (-1, 0), (0, 1), (0, -1)])
SPACING = 0.01  # m, the grid's lines are ten spacings apart


@given(st.lists(WAYS, min_size=1, max_size=9), st.floats(0.0, 0.0004), st.sets(st.integers(1, 8)))
@example([(1, 0), (0, 1), (0, -1), (1, 0)], 0.0, set())  # a way in and back
@example([(1, 0), (0, 1), (0, -1), (1, 0)], 0.0, {2})  # in on one stroke, back on the next
@examples(30)
def test_what_is_walked_twice_is_marked(
    ways: list[tuple[int, int]], aside: float, cuts: set[int]
) -> None:
    """Against counting how often each line of the grid is walked; its ends are left out.

    The walk is cut into strokes at some nodes.

    There another line may begin that is walked once, or the walk may turn round. Each pass runs a
    little aside of the one before, up to 3.2 mm in all, which is more than a quarter of a spacing
    for passes far apart in time; those are left out as well.
    """
    nodes = np.concatenate([[[0, 0]], np.cumsum(ways, axis=0)])
    lines = [frozenset([tuple(a), tuple(b)]) for a, b in pairwise(nodes.tolist())]
    passes = [[k for k, line in enumerate(lines) if line == own] for own in lines]
    walked = Counter(lines)
    points, expected = [np.zeros(3)], [None]
    for number, (a, b) in enumerate(pairwise(nodes * 10 * SPACING)):
        near = [k for k in passes[number] if abs(k - number) * aside < 0.0024 and k != number]
        clear = [k for k in passes[number] if abs(k - number) * aside < 0.0026 and k != number]
        for part in np.linspace(0.0, 1.0, 101)[1:].tolist():
            points.append(np.append(a + part * (b - a), number * aside))
            inner = 0.3 < part < 0.7 and len(near) == len(clear)
            expected.append(bool(near) if inner else None)
    assert all(walked[line] == len(own) for line, own in zip(lines, passes, strict=True))
    strokes = np.split(np.array(points), [100 * cut for cut in sorted(cuts) if cut < len(ways)])
    marked = np.concatenate(retraced(strokes, SPACING))
    for known, found in zip(expected, marked.tolist(), strict=True):
        assert known is None or known == found


def test_a_wide_spacing_marks_the_same_ways() -> None:
    """In and back, 2 m, points 1 mm apart and a spacing of 0.3 m: thinned, then marked."""
    out = np.arange(0.0, 2.0, 0.001)
    way = np.concatenate([out, out[::-1]])
    points = np.column_stack([way, np.zeros((len(way), 2))])
    (marked,) = retraced([points], 0.3)
    # Near the turn the two passes are one pass.
    assert marked[:1800].all() and marked[2200:].all() and not marked[1950:2050].any()
