"""The wok scene as shipped: one lift-off, also when it is moved a little; what a build hangs on."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from shipped import WOK, shipped
from vertex_minima import covers

import cellcolor
from cellcolor.frontend import build_surface
from cellcolor.frontend.scene import Scene

PLACE = np.array([0.465, -0.15, -0.04])


def variant(vertices: int, seed: int) -> Scene:
    """The wok at another resolution, moved by up to 5 mm and 2 degrees an axis."""
    random = np.random.default_rng(seed)
    shift = random.uniform(-0.005, 0.005, 3)
    turn = random.uniform(-1, 1, 3) * np.deg2rad(2)
    return shipped("wok", vertices).moved(position_m=PLACE + shift, rpy_rad=turn)


def minima(vertices: int, seeds: range) -> Counter[int]:
    """How often each number of segments is the minimum of variants."""
    found = [cellcolor.solve(build_surface(variant(vertices, seed)).surface) for seed in seeds]
    assert all(each.solution.proved_for_surface for each in found)
    return Counter(each.segments for each in found)


@pytest.mark.parametrize(
    ("vertices", "times"),
    [
        pytest.param(500, 5, marks=pytest.mark.second),
        pytest.param(2000, 20, marks=pytest.mark.slow),
    ],
)
def test_moved_a_little(vertices: int, times: int) -> None:
    assert minima(vertices, range(1, times + 1)) == {2: times}


def test_result_hangs_together() -> None:
    result = build_surface(shipped("wok", 300))
    surface, report = result.surface, result.report
    for vertex, colors in enumerate(surface.vertex_colors):
        row = result.node_color[vertex]
        assert colors == tuple(sorted(row[row >= 0].tolist()))
        assert not ((row >= 0) & (result.reasons[vertex] != 0)).any()
        for branch in np.flatnonzero(row >= 0):
            assert surface.colors[row[branch]].startswith(result.branches[branch])
    assert np.array_equal(np.isnan(result.configurations[:, :, 0]), result.reasons == 1)
    assert report.slivers is not None
    covered = sum(map(bool, surface.vertex_colors))
    assert report.reachable == covered + report.slivers.given_up_vertices
    assert report.reachable == (result.reasons == 0).any(axis=1).sum()
    assert [color.vertices for color in report.colors] == [
        sum(number in colors for colors in surface.vertex_colors)
        for number in range(len(surface.colors))
    ]
    assert sum(report.unreachable.values()) == report.vertices - report.reachable
    assert sum(report.candidates.values()) == 8 * report.vertices
    for word in ("reachable", "object collision", *surface.colors, "cracks", "seconds"):
        assert word in str(report)


def test_shipped_scene() -> None:
    result = build_surface(WOK)
    surface = result.surface
    assert surface.name == "wok"
    assert len(surface.vertices) == 1027
    assert not covers(surface, 1) and covers(surface, 2)
    # The paper: elbow above, both shoulders, a small part nearest to the robot out of reach.
    assert len(surface.colors) == 4
    assert all("elbow-up" in color for color in surface.colors)
    unreached = surface.vertices[[not colors for colors in surface.vertex_colors]]
    assert len(unreached) and (unreached[:, 0] < PLACE[0] - 0.15).all()
