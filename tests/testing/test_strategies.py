"""What the strategies draw is what they say."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

import cellcolor
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.testing.strategies import broken_plans, instances, labelled_surfaces, valid_plans


@settings(max_examples=40, deadline=None)
@given(labelled_surfaces(largest=8), st.data())
def test_valid_plans_are_valid_and_broken_ones_are_not(
    surface: LabelledSurface, data: st.DataObject
) -> None:
    assert check_plan(surface, data.draw(valid_plans(surface))).valid
    assert not check_plan(surface, data.draw(broken_plans(surface))).valid


@settings(max_examples=20, deadline=None)
@given(labelled_surfaces(largest=8), st.data())
def test_no_valid_plan_beats_the_minimum(surface: LabelledSurface, data: st.DataObject) -> None:
    oracle = cellcolor.Oracle(surface, workers=1)
    verdict = oracle.judge(data.draw(valid_plans(surface)))
    assert verdict.segments is not None and verdict.segments >= oracle.bounds.lower


@settings(max_examples=20, deadline=None)
@given(instances(most_cells=6, most_colors=3))
def test_instances_can_be_solved(instance: Instance) -> None:
    assert len(instance.cells) <= 6 and len(instance.colors) <= 3
    assert cellcolor.solve(instance, workers=1).segments is not None
