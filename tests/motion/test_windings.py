"""Windings: a ring about the base, for an arm whose first joint turns by 200 degrees each way."""

from __future__ import annotations

from dataclasses import replace

import networkx as nx
import numpy as np
import pytest
from motions import Planned, planned_scene, ring_scene

from cellcolor.deadline import NEVER
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.motion.following import follow, joint_space
from cellcolor.motion.samples import sampled
from cellcolor.motion.windings import Parts, PartSteps, walls_of
from cellcolor.tool_paths.cover import cover

pytestmark = pytest.mark.second


@pytest.fixture(scope="module")
def ring() -> Planned:
    """A motion over the ring."""
    return planned_scene(ring_scene(np.deg2rad(200)))


def test_a_path_without_walls_overruns_the_first_joint(ring: Planned) -> None:
    motion = ring.prepared.setup.motion
    assert motion is not None
    (color,) = {color for color in ring.painted.plan.vertex_colors if color is not None}
    covered = cover(
        replace(ring.painted.surface, cracks=()),
        ring.painted.segment_of,
        [color],
        ring.normals,
        spacing_m=motion.spacing_m,
        tool_radius_m=motion.tool_radius_m,
    )
    (path,) = covered.paths.paths
    branch = ring.built.color_branch[color]
    followed = follow(ring.prepared, sampled(path), branch)
    assert followed.good
    assert not joint_space(ring.prepared).fits(followed.joints)
    turned = np.ptp(followed.joints, axis=0)
    assert turned[0] > np.deg2rad(400)
    assert (turned[1:] < np.pi).all()


def test_the_chosen_path_stays_in_the_limits_without_a_lift_off(ring: Planned) -> None:
    trajectory, robot = ring.plan.trajectory, ring.prepared.robot
    assert trajectory.lift_offs == ring.lift_offs == 0
    assert trajectory.extra_lift_offs == ()
    assert (trajectory.joints >= robot.lower).all()
    assert (trajectory.joints <= robot.upper).all()
    assert np.ptp(trajectory.joints[trajectory.contact][:, 0]) > 1.8 * np.pi  # nearly all round
    assert ring.plan.in_all.covered_wide > 0.99


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


def test_there_are_no_walls_where_the_limits_allow_the_path_as_it_is() -> None:
    ring = planned_scene(ring_scene(np.deg2rad(20 * 360)))
    assert ring.plan.walls == ()
    assert ring.plan.trajectory.lift_offs == 0
    assert np.ptp(ring.plan.trajectory.joints[:, 0]) > 2.2 * np.pi


@pytest.mark.parametrize(
    ("limit", "walls", "whole"),
    [
        (200, {(2, 3)}, True),  # from 180 degrees the joint would go on to 270
        (100, {(1, 2), (2, 3)}, False),  # 180 degrees is out of reach
    ],
)
def test_four_parts_around_the_base(limit: float, walls: set[tuple[int, int]], whole: bool) -> None:
    """The example of the module: its mesh is a fan of four triangles about the base."""
    around = np.deg2rad([0.0, 90.0, 180.0, 270.0])
    places = np.column_stack([np.cos(around), np.sin(around), np.zeros(4)])
    fan = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    mesh = TriangleMesh(np.vstack([places, np.zeros(3)]), fan)
    ends = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    angles = np.deg2rad([[0.0], [90.0], [180.0], [-90.0]])
    wide = np.deg2rad(10)
    steps = PartSteps(
        ends,
        np.array([[0], [0], [1], [0]]),
        np.array([np.flatnonzero(mesh.marked([tuple(sorted(end))]))[0] for end in ends.tolist()]),
        np.ones(4),
    )
    parts = Parts(places, np.ones(4), angles - wide, angles + wide, steps)
    limits = np.deg2rad([limit])
    space = JointSpace.of(np.zeros(1, dtype=bool), -limits, limits, 1.0)
    found = walls_of(parts, mesh, space, NEVER)
    assert set(found.edges) == walls
    assert (found.whole, found.joint) == (whole, 0)
