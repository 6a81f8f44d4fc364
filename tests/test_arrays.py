"""Numbers within groups and cuts of lengths, against loops."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.arrays import cuts, numbered


@given(st.lists(st.integers(0, 5), max_size=6))
def test_items_are_numbered_group_by_group(counts: list[int]) -> None:
    group, number = numbered(np.array(counts, dtype=np.int64))
    expected = [(row, at) for row, count in enumerate(counts) for at in range(count)]
    assert list(zip(group.tolist(), number.tolist(), strict=True)) == expected


@given(st.lists(st.floats(0, 9), max_size=6))
def test_parts_between_cuts_are_equal_and_as_few_as_can_be(sizes: list[float]) -> None:
    which, share = cuts(np.array(sizes))
    for row, size in enumerate(sizes):
        ends = [0.0, *share[which == row].tolist(), 1.0]
        parts = np.diff(ends) * size
        assert np.allclose(parts, size / len(parts))
        assert size / len(parts) <= 1
        assert len(parts) == 1 or size / (len(parts) - 1) > 1
