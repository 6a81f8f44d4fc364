"""Three planners that do not look for the fewest segments."""

from __future__ import annotations

from library import INSTANCES
from meshes import drawn
from planners import (
    largest_set_first,
)

import cellcolor
from cellcolor.data.surface import LabelledSurface

RED, BLUE = 0, 1
LABELS = {"R": [RED], "B": [BLUE], "P": [RED, BLUE], ".": []}


def test_the_largest_set_goes_first_even_where_that_is_a_mistake() -> None:
    """Blue takes all eight of its vertices, and parts the red ones, which could have been one."""
    surface = drawn("R....... PBBBBBBB R.......", LABELS)
    colors = largest_set_first(surface)
    assert colors[8:16] == [BLUE] * 8 and colors[0] == colors[16] == RED
    verdict = cellcolor.Oracle(surface).judge(colors)
    assert (verdict.segments, verdict.beatable_by) == (3, 1)


def test_figure_1_greedy_pays_a_lift_off() -> None:
    """Blue is the larger set. Painted in full (b) it parts green; green in full (c) leaves one."""
    surface = LabelledSurface.read(INSTANCES / "paper" / "fig1.surface.json")
    blue, green = range(2)
    judge = cellcolor.Oracle(surface)
    greedy = largest_set_first(surface)
    assert greedy == [blue if blue in own else green for own in surface.vertex_colors]
    assert judge.judge(greedy).lift_offs == 2
    painted = [green if green in own else blue for own in surface.vertex_colors]
    assert judge.judge(painted).lift_offs == 1 == judge.bounds.lower - 1
