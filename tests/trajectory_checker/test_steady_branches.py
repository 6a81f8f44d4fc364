"""The branch of each sample where several have one configuration in common."""

from __future__ import annotations

from itertools import pairwise, product

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.trajectory_checker.contact import _steady

CHOICES = st.lists(st.sets(st.integers(0, 3), min_size=1), min_size=1, max_size=6)


@given(CHOICES, st.data())
def test_a_stroke_changes_its_branch_as_rarely_as_can_be(
    choices: list[set[int]], data: st.DataObject
) -> None:
    """Held against all ways to choose a branch for each sample."""
    begins = data.draw(st.lists(st.booleans(), min_size=len(choices), max_size=len(choices)))
    stroke = np.cumsum(begins)
    found = np.array([data.draw(st.sampled_from(sorted(own))) for own in choices])
    several = {row: own for row, own in enumerate(choices) if len(own) > 1}

    def changes(branches: tuple[int, ...]) -> int:
        steps = zip(pairwise(branches), pairwise(stroke.tolist()), strict=True)
        return sum(one != other and here == there for (one, other), (here, there) in steps)

    chosen = _steady(found, several, stroke)
    assert all(branch in own for branch, own in zip(chosen.tolist(), choices, strict=True))
    assert changes(tuple(chosen.tolist())) == min(map(changes, product(*choices)))
