"""What a labelled surface knows of itself: the areas of its vertices, and its cracks."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from meshes import surfaces

from cellcolor.data.surface import LabelledSurface


@given(surfaces())
def test_vertices_own_thirds_of_their_triangles(surface: LabelledSurface) -> None:
    """Heron's formula for each triangle, a third of it for each of its corners."""
    expected = [0.0] * len(surface.vertices)
    for face in surface.faces.tolist():
        ends = surface.vertices[face]
        a, b, c = (float(np.linalg.norm(ends[k] - ends[k - 1])) for k in range(3))
        half = (a + b + c) / 2
        area = (half * (half - a) * (half - b) * (half - c)) ** 0.5
        for vertex in face:
            expected[vertex] += area / 3
    assert surface.vertex_areas == pytest.approx(expected)
    with pytest.raises(ValueError, match="read-only"):
        surface.vertex_areas[0] = 1.0


@given(surfaces(), st.data())
def test_cracks_are_found_either_way_round(surface: LabelledSurface, data: st.DataObject) -> None:
    a, b = data.draw(st.sampled_from(sorted(surface.left_of)))
    listed = [set(c.colors) for c in surface.cracks if {c.i, c.j} == {a, b}]
    assert [surface.cracked(a, b)] == [surface.cracked(b, a)] == (listed or [set()])
