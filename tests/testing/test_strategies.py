"""What the strategies draw is what they say."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import find, given, settings
from hypothesis import strategies as st

import cellcolor
from cellcolor.checker.vertex_plan import PlanReport, check_plan
from cellcolor.data.instance import Instance
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.testing.strategies import (
    broken_plans,
    instances,
    labelled_surfaces,
    sheet,
    valid_plans,
)
from examples import examples


@examples(20)
@given(labelled_surfaces(largest=8), st.data())
def test_valid_plans_are_valid_and_broken_ones_are_not(
    surface: LabelledSurface, data: st.DataObject
) -> None:
    assert check_plan(surface, data.draw(valid_plans(surface))).valid
    assert not check_plan(surface, data.draw(broken_plans(surface))).valid


@examples(10)
@given(instances(most_cells=6, most_colors=3))
def test_instances_can_be_solved(instance: Instance) -> None:
    assert len(instance.cells) <= 6 and len(instance.colors) <= 3
    assert cellcolor.solve(instance, workers=1).segments is not None


def test_a_sheet_is_what_its_numbers_say() -> None:
    """Three columns, two rows; the first color leaves out a corner, the second reaches beyond."""
    surface = sheet(3, 2, [[(0, 0, 2, 0), (0, 1, 1, 1)], [(9, 9, 1, 0)], []], [(1, 1, 0)])
    # Row by row from the one with the least y: reached by both in columns 1 and 2 of row 0.
    assert surface.vertex_colors == ((0,), (0, 1), (0, 1), (0,), (0, 1), (1,))
    assert surface.vertices[5].tolist() == [2.0, 1.0, 0.0]
    cracks = {(crack.i, crack.j): crack.colors for crack in surface.cracks}
    # Squares are cut from their lower left corner, so that 1 and 5 are neighbors, 2 and 4 are not.
    assert cracks == {(1, 2): (0, 1), (1, 5): (1,), (4, 5): (1,)}
    one_row = sheet(3, 2, [[(0, 0, 2, 1)]], [(0, 0, 0)])
    assert [(crack.i, crack.j) for crack in one_row.cracks] == [(0, 1)]


@pytest.mark.parametrize(
    "wanted",
    [
        lambda surface: bool(surface.cracks),
        lambda surface: not any(surface.vertex_colors),
        lambda surface: any(len(own) > 1 for own in surface.vertex_colors),
    ],
    ids=["a crack", "nothing reached", "two colors at a vertex"],
)
def test_what_fails_is_made_small(wanted: Callable[[LabelledSurface], bool]) -> None:
    """Two by two vertices are the fewest, and enough for all of these."""
    many = settings(max_examples=1000, deadline=None)
    assert len(find(labelled_surfaces(largest=6), wanted, settings=many).vertices) == 4


ROW = sheet(4, 2, [[(0, 0, 2, 1)], [(1, 0, 1, 1)]])


@pytest.mark.parametrize(
    "reason",
    [
        "null, but colors [0] reach this vertex",
        "color 1 does not reach this vertex",
        "color 0 does not reach this vertex",  # where none does
        "there is no color -1",
        "there is no color 2",
        "7 entries for 8 vertices",
        "9 entries for 8 vertices",
    ],
)
def test_every_sort_of_broken_plan_is_drawn(reason: str) -> None:
    """Within few examples, since the sorts are alike in number."""

    def broken(plan: Plan) -> bool:
        report: PlanReport = check_plan(ROW, plan)
        assert len(report.problems) == 1
        return reason in report.problems[0]

    few = settings(max_examples=300, deadline=None)
    assert find(broken_plans(ROW), broken, settings=few)


@examples(15)
@given(st.data())
def test_broken_plans_of_a_surface_that_nothing_reaches(data: st.DataObject) -> None:
    bare = sheet(2, 2, [[(5, 5, 5, 5)]])
    assert not check_plan(bare, data.draw(broken_plans(bare))).valid
