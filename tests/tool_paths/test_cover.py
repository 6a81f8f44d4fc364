"""Tool paths on random paintings: held to an independent checker, whatever the pattern."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from painted_at_random import SHAPES, Painting, painted_at_random
from path_checker import PathChecker

from cellcolor.tool_paths.cover import Covered, cover
from cellcolor.tool_paths.region import small_triangle_areas
from cellcolor.tool_paths.registry import PATTERNS


def covered(painting: Painting, pattern: str, spacing: float, **options: object) -> Covered:
    return cover(*painting, pattern=pattern, spacing_m=spacing, tool_radius_m=spacing, **options)


@pytest.mark.parametrize("pattern", PATTERNS)
@given(st.integers(0, 10**6), st.sampled_from(SHAPES), st.sampled_from([0.1, 0.25]))
@settings(max_examples=5, deadline=None)
def test_paths_stay_on_their_segments(pattern: str, seed: int, shape: str, spacing: float) -> None:
    painting = painted_at_random(seed, shape)
    found = covered(painting, pattern, spacing)
    checker = PathChecker(painting.surface, painting.segment_of)
    for path in found.paths.paths:
        assert not checker.problems(path)
        assert path.color == painting.colors[path.segment]
    # Every segment has one path, in one piece, unless it is smaller than the tool can see.
    areas = np.zeros(len(painting.colors))
    corners = painting.segment_of[painting.surface.faces].ravel()
    thirds = np.repeat(small_triangle_areas(painting.surface)[::6] * 2, 3)
    np.add.at(areas, corners[corners >= 0], thirds[corners >= 0])
    segments = [path.segment for path in found.paths.paths]
    assert len(segments) == len(set(segments))
    assert set(segments) == set(np.flatnonzero(areas >= spacing**2 / 4).tolist())
