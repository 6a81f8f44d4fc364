"""Windings: a ring about the base, for an arm whose first joint turns by 200 degrees each way."""

from __future__ import annotations

import networkx as nx
import numpy as np
import pytest
from motions import ring_scene

import cellcolor
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.motion.windings import Steps, walls_of

pytestmark = pytest.mark.second


@pytest.fixture(scope="module")
def ring() -> cellcolor.PlannedScene:
    """A motion over the ring."""
    return cellcolor.plan(ring_scene(np.deg2rad(200)))


def test_the_chosen_path_stays_in_the_limits_without_a_lift_off(
    ring: cellcolor.PlannedScene,
) -> None:
    trajectory, robot = ring.trajectory, ring.built.robot
    assert trajectory.lift_offs == ring.solution.lift_offs == 0
    assert trajectory.extra_lift_offs == ()
    assert (trajectory.joints >= robot.lower).all()
    assert (trajectory.joints <= robot.upper).all()
    assert np.ptp(trajectory.joints[trajectory.contact][:, 0]) > 1.8 * np.pi  # nearly all round
    assert ring.verdict.covered.covered_share > 0.99


def test_cracks_of_the_color_open_the_ring_and_do_not_part_it(ring: cellcolor.PlannedScene) -> None:
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


def around_the_base() -> Steps:
    """The module's example."""
    ends = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    angles, turns = np.deg2rad([[0.0], [90.0], [180.0], [-90.0]]), np.array([[0], [0], [1], [0]])
    return Steps(np.arange(4), angles, ends, turns)


def turning_by(degrees: float) -> JointSpace:
    """One joint that turns so far each way."""
    limits = np.deg2rad([degrees])
    return JointSpace(np.zeros(1, dtype=bool), -limits, limits, 1.0)


def test_four_vertices_around_the_base() -> None:
    """From 180 degrees the joint would go on to 270."""
    assert walls_of(around_the_base(), turning_by(200)) == ([(2, 3)], None)


def test_a_joint_that_parts_a_segment_is_named() -> None:
    """Two ways from C to D: one of them is in a window, or neither."""
    steps = around_the_base()
    line = steps._replace(ends=np.array([[2, 3], [2, 3]]), turns=np.array([[1], [0]]))
    walls, joint = walls_of(line, turning_by(200))
    assert (walls, joint) == ([(2, 3)], None)
    turned = line._replace(turns=np.array([[2], [3]]))
    assert walls_of(turned, turning_by(200)) == ([(2, 3)], 0)
