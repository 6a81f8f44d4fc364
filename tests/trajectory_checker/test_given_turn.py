"""Trajectories and configurations where the setup gives the turn of the tool."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import rasters
from turned_scenes import setup

from cellcolor.data.candidate_table import VALID
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.frontend.build import build_surface
from cellcolor.trajectory_checker.at_vertices import at_vertices
from cellcolor.trajectory_checker.check import check_trajectory


def judged(trajectory: Trajectory) -> TrajectoryVerdict:
    _, built, _ = rasters.turned()
    return check_trajectory(built, trajectory, timed=False)


def with_turn(first: int, after: int, degrees: float) -> Trajectory:
    """The raster with the tool, which is on the axis of joint 6, turned more at some samples."""
    trajectory = rasters.turned()[2]
    joints = trajectory.joints.copy()
    joints[first:after, 5] += math.radians(degrees)
    return replace(trajectory, joints=joints)


def test_a_raster_with_the_turn_is_valid_and_its_colors_are_named_after_it() -> None:
    _, built, trajectory = rasters.turned()
    verdict = judged(trajectory)
    assert verdict.valid, verdict.faults
    assert all(name.startswith(("turn 0° ", "turn 90° ")) for name in built.surface.colors)


def test_turned_by_more_than_a_degree() -> None:
    first, after = rasters.turned()[2].strokes[0]
    middle = (first + after) // 2
    assert judged(with_turn(middle, middle + 1, 0.9)).valid
    verdict = judged(with_turn(middle, middle + 1, -1.1))
    assert set(verdict.fault_counts) == {"turned"}
    (fault,) = verdict.faults
    assert (fault.sample, fault.last_sample) == (middle, middle)
    assert "1.1 degrees off the turn" in fault.text and "allowed: 1" in fault.text


def test_another_turn_of_the_set_is_another_branch() -> None:
    """It is given as well, but from one to the other the tool has to lift off."""
    first, after = rasters.turned()[2].strokes[0]
    middle = (first + after) // 2
    # Joint 6 of this arm turns about the tool's z axis itself.
    to_the_other = judged(with_turn(middle, after, 90.0))
    assert not to_the_other.of_kind("turned") and to_the_other.of_kind("jump")
    (change,) = to_the_other.of_kind("branch")
    assert "'turn 0° " in change.text and "'turn 90° " in change.text
    assert change.sample == middle - 1
    to_none = judged(with_turn(middle, after, -90.0))
    assert to_none.of_kind("turned") and to_none.of_kind("jump")


def test_where_the_rule_says_nothing_there_is_no_contact() -> None:
    """A vector along the normal of the square."""
    prepared, _, trajectory = rasters.turned()
    normal = trajectory.normals[trajectory.contact]
    assert np.allclose(normal, normal[0], atol=1e-12)
    scene = prepared.scene.with_setup(setup({"along": tuple(normal[0].tolist())}))
    verdict = check_trajectory(build_surface(scene), trajectory, timed=False)
    found = [(fault.sample, fault.last_sample) for fault in verdict.of_kind("turned")]
    assert found == [(first, after - 1) for first, after in trajectory.strokes]
    assert all("undefined" in fault.text for fault in verdict.of_kind("turned"))


def test_a_configuration_has_its_color_with_its_turn_only() -> None:
    _, built, _ = rasters.turned()
    nodes = np.argwhere(built.node_color >= 0)[::101]
    assert len(nodes) > 20 and (built.reasons[tuple(nodes.T)] == VALID).all()
    own = built.configurations[tuple(nodes.T)]
    colors = built.node_color[tuple(nodes.T)]
    assert (at_vertices(built, nodes[:, 0], own)[0] == colors).all()
    for degrees, kept in ((0.9, True), (-0.9, True), (1.1, False), (-1.1, False), (45.0, False)):
        other = own + np.radians(degrees) * np.eye(6)[5]
        held, why = at_vertices(built, nodes[:, 0], other)
        assert (held == (colors if kept else -1)).all()
        if not kept and abs(degrees) < 5:
            assert "1.1 degrees off its turn" in why[0]
