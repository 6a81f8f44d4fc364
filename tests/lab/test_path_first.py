"""Raster paths, and the fewest changes of branch along one."""

from __future__ import annotations

import itertools

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families.meshes import grid_faces
from cellcolor.lab.path_first import fewest_lift_offs, raster

ROWS = st.lists(st.lists(st.booleans(), min_size=3, max_size=3).filter(any), min_size=1, max_size=6)


@given(ROWS)
def test_no_choice_of_branches_changes_less_often(valid: list[list[bool]]) -> None:
    """Against every choice of one valid branch for each point."""
    choices = itertools.product(*[[b for b in range(3) if row[b]] for row in valid])
    changes = (sum(a != b for a, b in itertools.pairwise(choice)) for choice in choices)
    assert fewest_lift_offs(np.array(valid)) == min(changes)


def test_a_raster_goes_back_and_forth() -> None:
    """On a square grid along its rows: strips are a row each, every other one backward."""
    places = np.array([[x, y, 0.0] for y in range(4) for x in range(4)])
    surface = LabelledSurface("grid", ("a",), places, grid_faces(4, 4), ((0,),) * 16)
    found = [places[raster(surface, angle)].tolist() for angle in (0.0, np.pi / 2)]
    for order in found:
        assert sorted(order) == sorted(places.tolist())
        steps = np.linalg.norm(np.diff(order, axis=0), axis=1)
        # A neighbor follows each point: 3 steps of 1 m in each of 4 rows, and 3 between rows.
        assert np.allclose(steps, 1.0)
    assert found[0] != found[1]
