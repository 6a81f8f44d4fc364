"""A finer surface takes over what is known of its vertices and mesh edges, to the same result."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from shipped import shipped

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import NEVER
from cellcolor.frontend.parts.surface import Surface, bisected
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.frontend.reach.between import remains_valid
from cellcolor.frontend.reach.validity import Judge, Verdicts
from cellcolor.frontend.stage_clock import StageClock
from cellcolor.frontend.stages import Stages, judged, with_finer_borders

pytestmark = pytest.mark.second


def scene(name: str, **continuity: float) -> PreparedScene:
    plain = shipped(name, 90)
    return prepare(plain.varied(setup=plain.setup.varied(continuity=continuity)))


def finer(prepared: PreparedScene, share: float, seed: int) -> PreparedScene:
    """A share of the mesh edges bisected, wherever they are."""
    count = len(prepared.surface.edges())
    marked = np.random.default_rng(seed).random(count) < share
    return replace(prepared, surface=bisected(prepared.surface, marked, "share"))


def in_bytes(stages: Stages) -> dict[str, bytes]:
    """All arrays that come out."""
    arrays: dict[str, NDArray[Any]] = {
        "configurations": stages.candidates.configurations,
        "reasons": stages.candidates.reasons,
        "determinants": stages.candidates.determinants,
        "edges": stages.links.edges,
        "continuous": stages.continuous.linked,
        "linked": stages.links.linked,
        "colors": stages.coloring.node_color,
        "cleaned": stages.cleaned.coloring.node_color,
    }
    return {name: values.tobytes() for name, values in arrays.items()}


@pytest.mark.parametrize("name", ["wok_obstacle", "hemisphere_tilted"])
def test_what_is_taken_over_is_the_same_to_the_byte(name: str) -> None:
    """Round after round, at borders and elsewhere; every round is judged anew for comparison."""
    prepared = scene(name)
    clock = StageClock(NEVER, None)
    before = judged(prepared, clock)
    for seed, share in enumerate((0.02, 0.1)):
        prepared = finer(prepared, share, seed)
        before, anew = judged(prepared, clock, before), judged(prepared, clock)
        assert in_bytes(before.stages) == in_bytes(anew.stages)
        assert before.verdicts.tracked.tobytes() == anew.verdicts.tracked.tobytes()
        assert before.stages.cleaned.cracks == anew.stages.cleaned.cracks
        assert before.stages.cleaned.report == anew.stages.cleaned.report


def test_a_build_with_finer_borders_is_its_last_surface_judged_anew() -> None:
    """The rounds leave no trace but the mesh."""
    prepared, stages = with_finer_borders(
        scene("wok_obstacle", border_length_m=0.012), StageClock(NEVER, None)
    )
    anew = judged(prepared, StageClock(NEVER, None)).stages
    assert in_bytes(stages) == in_bytes(anew)
    assert stages.cleaned.cracks == anew.cleaned.cracks


def test_only_what_is_new_is_asked_about(monkeypatch: pytest.MonkeyPatch) -> None:
    """No configuration of a vertex that was there, and no link between two such vertices."""
    prepared = scene("square", validity_spacing_m=0.004)
    clock = StageClock(NEVER, None)
    before = judged(prepared, clock)
    asked: list[int] = []
    judge = Judge.__call__

    def counted(self: Judge, configurations: Array, *rest: Any) -> Verdicts:
        asked.append(len(configurations))
        return judge(self, configurations, *rest)

    monkeypatch.setattr(Judge, "__call__", counted)
    again = judged(prepared, clock, before)
    assert sum(asked) == 0
    assert in_bytes(again.stages) == in_bytes(before.stages)
    larger = finer(prepared, 0.01, seed=3)
    new = len(larger.surface.vertices) - len(prepared.surface.vertices)
    asked.clear()
    judged(larger, clock, before)
    assert asked[0] == 8 * new


def test_old_edges_that_get_to_a_border_are_asked_more_closely(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """However often a link was asked about, the last time was as closely as if asked just now."""
    asked: dict[tuple[int, int, int], int] = {}

    def noted(surface: Surface, edges: Index, branches: Index, pieces: Index, *rest: Any) -> Mask:
        keys = np.column_stack([edges, branches]).tolist()
        asked.update(zip(map(tuple, keys), pieces.tolist(), strict=True))
        return remains_valid(surface, edges, branches, pieces, *rest)

    monkeypatch.setattr("cellcolor.frontend.links.remains_valid", noted)
    prepared = scene("wok_obstacle")
    before = judged(prepared, StageClock(NEVER, None))
    first = dict(asked)
    larger = finer(prepared, 0.05, seed=1)
    judged(larger, StageClock(NEVER, None), before)
    by_rounds = dict(asked)
    asked.clear()
    judged(larger, StageClock(NEVER, None))
    assert {key: by_rounds[key] for key in asked} == asked
    assert any(key in first and first[key] != pieces for key, pieces in asked.items())
