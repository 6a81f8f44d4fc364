"""Colors that no planned move leads to, and a surface that does without them."""

from __future__ import annotations

import numpy as np
import pytest

from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.motion.plan import _cut_off
from cellcolor.motion.strokes import Stroke
from cellcolor.motion.ways import Transfer


def strokes(*lengths: int) -> list[Stroke]:
    """One stroke in each segment, of so many samples."""
    return [
        Stroke(segment, 0, np.zeros((k, 3)), np.zeros((k, 3)), np.zeros((k, 6)))
        for segment, k in enumerate(lengths)
    ]


def moves(planned: str) -> list[Transfer]:
    """A move for each letter: ``-`` if it was planned, ``x`` if it was not."""
    return [Transfer(np.zeros((2, 6)), 0 if one == "x" else None) for one in planned]


@pytest.mark.parametrize(
    ("planned", "home", "expected"),
    [
        ("----", True, ()),
        ("-xx-", True, (1,)),  # the first and the last are joined to home
        ("--x-", True, ()),  # both sides of the one gap lead home
        ("x---", True, ()),
        ("x--x", True, (0, 1, 2)),
        ("xx--", True, (0,)),
        ("-xx-", False, (0, 2)),  # without home most samples count, here of the second
        ("-x--", False, (0,)),
    ],
)
def test_what_no_planned_move_joins_to_home(
    planned: str, home: bool, expected: tuple[int, ...]
) -> None:
    assert _cut_off(strokes(5, 9, 7), moves(planned), [0, 1, 2], home) == expected


def test_a_surface_does_without_colors_where_it_has_others() -> None:
    """Two triangles: color 1 goes, but for the vertex that has no other."""
    surface = LabelledSurface(
        name="two triangles",
        colors=("a", "b", "c"),
        vertices=np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]),
        faces=np.array([[0, 1, 2], [0, 2, 3]]),
        vertex_colors=((0, 1), (1, 2), (1,), (0, 1, 2)),
        cracks=(Crack(0, 1, (1,)), Crack(0, 3, (0, 1)), Crack(1, 2, (1,))),
    )
    without = surface.without_colors({1})
    assert without.vertex_colors == ((0,), (2,), (1,), (0, 2))
    assert without.cracks == (Crack(0, 3, (0,)),)
    assert without.colors == surface.colors
    assert surface.without_colors(()) == surface
