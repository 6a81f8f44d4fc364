"""Colors of configurations at vertices, held against Pinocchio and a search through all of them."""

from __future__ import annotations

import math
from dataclasses import replace

import joint_paths
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.arrays import Array
from cellcolor.data.plan import ContactPath
from cellcolor.errors import InputError
from cellcolor.frontend.build import BuildResult
from cellcolor.trajectory_checker.at_vertices import _compared, at_vertices, touches
from examples import examples

MM, DEGREE, RAD = 0.001, math.radians(1.0), 0.1
"""What docs/judging-trajectories.md allows: of the tip, of the tool, of the nearest joints."""


def at(built: BuildResult, vertex: int, joints: Array) -> tuple[int, str]:
    """The color of one configuration at a vertex, and why it has none."""
    (color,), (why,) = at_vertices(built, np.array([vertex]), np.array([joints]))
    return int(color), why


def expected(built: BuildResult, vertex: int, joints: Array) -> tuple[int | None, bool]:
    """The color or None, and whether it is sure: not within rounding of a tolerance."""
    tip, axis = joint_paths.pose(built, joints)
    surface = built.prepared.surface
    off = math.dist(tip, surface.vertices[vertex])
    tilt = math.acos(min(1.0, float(axis @ -surface.normals[vertex])))
    apart = {}
    for branch, own in enumerate(built.configurations[vertex]):
        if not np.isnan(own).any():
            turns = [math.remainder(a - b, 2 * math.pi) for a, b in zip(joints, own, strict=True)]
            apart[branch] = max(map(abs, turns[:5]))
    nearest = min(apart, key=lambda branch: apart[branch])
    measures = [(off, MM), (tilt, DEGREE), (apart[nearest], RAD)]
    sure = all(abs(measure - most) > 1e-6 for measure, most in measures)
    color = int(built.node_color[vertex, nearest])
    near = all(measure <= most for measure, most in measures)
    return (color if near and color >= 0 else None), sure


@examples(40)
@given(st.data())
def test_the_color_is_that_of_the_nearest_configuration(data: st.DataObject) -> None:
    """Moved a little, turned by full circles, the last joint anyhow."""
    built = joint_paths.scene()
    nodes = np.argwhere(~np.isnan(built.configurations[..., 0]))
    vertex, branch = nodes[data.draw(st.integers(0, len(nodes) - 1))].tolist()
    step = data.draw(st.sampled_from([0.0, 0.0005, 0.002, 0.01, 0.05]))
    moves = data.draw(st.lists(st.floats(-1, 1), min_size=5, max_size=5))
    turns = data.draw(st.lists(st.integers(-2, 2), min_size=6, max_size=6))
    joints = built.configurations[vertex, branch] + 2 * np.pi * np.array(turns)
    joints[:5] += step * np.array(moves)
    joints[5] = data.draw(st.floats(-4, 4))
    color, sure = expected(built, vertex, joints)
    if sure:
        found, why = at(built, vertex, joints)
        assert found == (-1 if color is None else color)
        assert (color is None) == bool(why)


def test_why_a_configuration_has_no_color() -> None:
    built = joint_paths.scene()
    vertex = next(v for v, own in enumerate(built.surface.vertex_colors) if own)
    joints = joint_paths.configuration(built, vertex, built.surface.vertex_colors[vertex][0])
    other = joints + np.array([0.01, 0, 0, 0, 0, 0])
    off = math.dist(joint_paths.pose(built, other)[0], built.surface.vertices[vertex])
    assert at(built, vertex, other)[1] == (
        f"the tip is {1000 * off:.4g} mm off the vertex, allowed: 1"
    )
    failed = built.reason_names.index("obstacle collision")
    vertex, branch = np.argwhere(built.reasons == failed)[0].tolist()
    said = at(built, vertex, built.configurations[vertex, branch])[1]
    assert said == f"{built.branches[branch]!r} fails the test 'obstacle collision' there"
    taken = (built.reasons == 0) & (built.node_color < 0)
    vertex, branch = np.argwhere(taken)[0].tolist()
    said = at(built, vertex, built.configurations[vertex, branch])[1]
    assert said == f"{built.branches[branch]!r} was removed there by the sliver policy"


def test_a_tip_that_is_there_in_a_configuration_that_the_scene_does_not_have() -> None:
    """As at the edge of what a branch reaches: without that branch another one is the nearest."""
    built = joint_paths.scene()
    vertex, branch = np.argwhere(built.node_color >= 0)[0].tolist()
    joints = built.configurations[vertex, branch]
    configurations = built.configurations.copy()
    poorer = replace(built, verdicts=replace(built.verdicts, configurations=configurations))
    configurations[vertex, branch] = np.nan
    said = at(poorer, vertex, joints)[1]
    assert said.startswith("the scene's nearest configuration there, ")
    assert said.endswith(" rad off, allowed: 0.1")
    configurations[vertex] = np.nan
    said = at(poorer, vertex, joints)[1]
    assert said == "the scene has no configuration there"


def test_a_path_touches_what_its_samples_are_at() -> None:
    """Independently by distances of all pairs; a sample without contact touches nothing."""
    built = joint_paths.scene()
    surface = built.surface
    some = [v for v, own in enumerate(surface.vertex_colors) if own][:12]
    colors = [surface.vertex_colors[v][0] for v in some]
    joints = np.array(
        [joint_paths.configuration(built, v, c) for v, c in zip(some, colors, strict=True)]
    )
    joints[3, 0] += 0.1  # 50 mm aside
    contact = np.ones(12, dtype=bool)
    contact[6] = False
    points = np.array([joint_paths.pose(built, row)[0] for row in joints])
    points[8] += [0.0, 0.0, 0.0011]
    points[9] += [0.0, 0.0, 0.0009]
    found = touches(built, ContactPath(joints, points, contact))
    kept = [k for k in range(12) if k not in (3, 6)]
    assert found.vertex.tolist() == [some[k] for k in kept]
    assert found.color.tolist() == [colors[k] for k in kept]
    assert found.stroke.tolist() == [0] * 5 + [1] * 5
    assert found.misplaced == pytest.approx({8: 0.0011})
    tips = np.array([joint_paths.pose(built, row)[0] for row in joints[contact]])
    distances = np.linalg.norm(surface.vertices[:, None] - tips, axis=2).min(axis=1)
    assert found.nearest == pytest.approx(distances, abs=1e-9)


def test_another_arm_is_refused() -> None:
    built = joint_paths.scene()
    with pytest.raises(InputError, match=r"^joints: there are 5 joints, the arm has 6$"):
        at_vertices(built, np.array([0]), np.zeros((1, 5)))
    with pytest.raises(InputError, match=r"^joints: there are 7 joints, the arm has 6$"):
        touches(built, ContactPath(np.zeros((3, 7))))


def test_a_last_joint_that_moves_the_tip_is_compared() -> None:
    """With the tip 5 mm beside the last axis the sixth angle is no longer free."""
    built = joint_paths.scene()
    tip = built.robot.tip.copy()
    tip[:3, 3] += 0.005 * np.cross(built.robot.axis[-1], tip[:3, 1])
    for robot, sixth in ((built.robot, False), (replace(built.robot, tip=tip), True)):
        assert _compared(robot).tolist() == [True] * 5 + [sixth]
