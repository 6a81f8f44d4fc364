"""Windings: a ring about the base, for an arm whose first joint turns by 200 degrees each way."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import networkx as nx
import numpy as np
import pytest
from motions import Planned, planned_scene, ring_scene

from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.motion.segment import _refuse_what_is_beyond
from cellcolor.motion.strokes import Stroke
from cellcolor.tool_paths.measures import in_all

pytestmark = pytest.mark.second


@pytest.fixture(scope="module")
def ring() -> Planned:
    """A motion over the ring."""
    return planned_scene(ring_scene(np.deg2rad(200)))


def test_the_chosen_path_stays_in_the_limits_without_a_lift_off(ring: Planned) -> None:
    trajectory, robot = ring.plan.trajectory, ring.prepared.robot
    assert trajectory.lift_offs == ring.lift_offs == 0
    assert trajectory.extra_lift_offs == ()
    assert (trajectory.joints >= robot.lower).all()
    assert (trajectory.joints <= robot.upper).all()
    assert np.ptp(trajectory.joints[trajectory.contact][:, 0]) > 1.8 * np.pi  # nearly all round
    assert in_all(list(ring.plan.measures)).covered_wide > 0.99


def test_cracks_of_the_color_open_the_ring_and_do_not_part_it(ring: Planned) -> None:
    surface = ring.painted.surface
    graph = nx.Graph(edge for edge in surface.left_of)
    (color,) = {color for color in ring.painted.plan.vertex_colors if color is not None}
    assert ring.built.limits.winding and color in ring.built.limits.positions
    graph.remove_edges_from([(c.i, c.j) for c in surface.cracks if color in c.colors])
    assert nx.is_connected(graph)
    # The first joint follows the polar angle: no closed walk may go round the base any more.
    polar = np.arctan2(surface.vertices[:, 1], surface.vertices[:, 0])
    for cycle in nx.cycle_basis(graph):
        steps = np.diff(polar[[*cycle, cycle[0]]])
        assert np.abs((np.remainder(steps + np.pi, 2 * np.pi) - np.pi).sum()) < 1e-6


def turning_by(degrees: float) -> JointSpace:
    """One joint that turns so far each way."""
    limits = np.deg2rad([degrees])
    return JointSpace.of(np.zeros(1, dtype=bool), -limits, limits, 1.0)


def test_the_few_samples_beyond_the_limits_are_kept_off() -> None:
    """A joint that turns to 201 degrees where 200 are allowed, in the last of 300 samples."""
    points = np.column_stack([np.arange(300.0), np.zeros(300), np.zeros(300)])
    turned = np.deg2rad(np.append(np.linspace(-199.0, 199.0, 299), 201.0))[:, None]
    stroke = Stroke(0, 0, points, points, turned)
    samples = SimpleNamespace(points=points, faces=np.arange(300))
    courses = [SimpleNamespace(samples=samples)]
    refused: list[tuple[int, list[float], str]] = []
    refusals = SimpleNamespace(add=lambda face, at, why: refused.append((face, at.tolist(), why)))
    arguments: Any = (courses, [stroke], turning_by(200), refusals)
    assert _refuse_what_is_beyond(*arguments)
    assert refused == [(299, [299.0, 0.0, 0.0], "joint limits")]
    # Where a tenth is beyond, that is no exception, and the stroke is cut.
    arguments = (courses, [stroke], turning_by(180), refusals)
    assert not _refuse_what_is_beyond(*arguments)
