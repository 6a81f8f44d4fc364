"""Retreats from the surface."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from shipped import shipped

from cellcolor.deadline import NEVER
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.build import BuildResult, build_surface
from cellcolor.motion.limits import motion_of, speeds_of
from cellcolor.motion.strokes import Stroke
from cellcolor.motion.transfers import Transfers
from examples import examples


@pytest.fixture(scope="module")
def square() -> BuildResult:
    """Built for a UR5, whose joints turn by a full circle each way."""
    return build_surface(shipped("square", 200))


def stroke(built: BuildResult, at: int) -> Stroke:
    """A stroke of 1 mm along x at a vertex, in the branch of the first color."""
    branch = built.color_branch[0]
    points = built.surface.vertices[at] + np.array([[0.0, 0.0, 0.0], [0.001, 0.0, 0.0]])
    normals = np.tile(built.prepared.surface.normals[at], (2, 1))
    joints = built.prepared.arm.follow(points, -normals, np.full(2, branch, dtype=np.intp))
    assert np.isfinite(joints).all()
    return Stroke(0, branch, points, normals, joints)


def in_the_middle(built: BuildResult) -> tuple[Transfers, Stroke]:
    """What plans moves, and a stroke far from the border of the part."""
    vertices, prepared = built.surface.vertices, built.prepared
    middle = int(np.linalg.norm(vertices - vertices.mean(axis=0), axis=1).argmin())
    motion = motion_of(prepared)
    speeds = speeds_of(motion, prepared.robot)
    return Transfers(prepared, motion, speeds.velocities, 0, NEVER), stroke(built, middle)


@examples(20)
@given(st.floats(20.0, 89.0), st.floats(0.0, 360.0))
def test_a_retreat_leaves_the_surface(square: BuildResult, tilt: float, turn: float) -> None:
    """More than 1 mm above the plane of the part from 3 mm on, or the tool would be dragged."""
    planner, own = in_the_middle(square)
    normal = own.normals[0]
    along = Rotation.from_rotvec(np.radians(turn) * normal).apply([normal[2], 0.0, -normal[0]])
    direction = np.cos(np.radians(tilt)) * normal + np.sin(np.radians(tilt)) * along
    way = planner._off(own.joints[0], normal, direction, own.branch)
    tips = forward(square.prepared.robot, way).tip
    gone = np.linalg.norm(tips - tips[0], axis=1)
    assert ((tips - tips[0])[gone > 0.003] @ normal > 0.001).all()
