"""The region at the tool's tip, on scenes and alone; test_obstacle_kinds.py has other code."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from reasons import Reason
from shipped import ROBOTS

from cellcolor.arrays import Array
from cellcolor.frontend import build_surface
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.obstacle import BoxObstacle, SphereObstacle
from cellcolor.frontend.contact.tip import Tip
from cellcolor.frontend.parts.placement import Placement
from cellcolor.frontend.parts.shapes import RectangleObject
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Setup

HEIGHT = 0.1  # m, of the plane
SHAFT = 0.01  # m, from the tip to the body of the shipped tool
RADIUS = 0.005  # m, of the shipped setup
PLANE = Scene(
    name="plane",
    setup=Setup.read(ROBOTS / "ur5_polishing.toml"),
    object=RectangleObject(size_x_m=0.3, size_y_m=0.3, target_vertices=400),
    placement=Placement(position_m=(0.45, 0.1, HEIGHT)),
)


def plate(thickness: float, height: float) -> BoxObstacle:
    """A plate under or over the middle of the plane."""
    return BoxObstacle(size_m=(0.15, 0.15, thickness), position_m=(0.45, 0.1, height))


def from_shaft_to_box(vertices: Array, bottom: float, top: float) -> Array:
    """Distances of the tool's axis, upright over each vertex, from the box (by hand)."""
    across = np.linalg.norm(np.maximum(np.abs(vertices[:, :2] - [0.45, 0.1]) - 0.075, 0.0), axis=1)
    up = np.maximum(np.maximum(bottom - HEIGHT - SHAFT, HEIGHT - top), 0.0)
    return np.asarray(np.hypot(across, up))


@pytest.mark.parametrize(
    ("thickness", "height"),
    [
        (0.008, 0.104),  # a plate; the plane is its lower side
        (0.008, 0.100),  # the plane is in the middle of it
        (0.002, 0.105),  # a sheet 4 mm above the plane, below the tool's body
        (0.002, 0.108),  # the same 7 mm above, farther from the tip than the contact radius
        (0.050, 0.073),  # a table 2 mm below the plane
        (0.050, 0.069),  # the same 6 mm below: there is room
    ],
)
def test_where_an_obstacle_is_no_tip_can_be(thickness: float, height: float) -> None:
    result = build_surface(PLANE.with_obstacle(plate(thickness, height)))
    vertices = np.array(result.surface.vertices)
    distance = from_shaft_to_box(vertices, height - thickness / 2, height + thickness / 2)
    blocked = (result.reasons == Reason.TIP_BLOCKED).any(axis=1)
    assert (blocked == (distance <= RADIUS)).all()
    # On such a vertex nothing is valid, and nothing has got farther than this test.
    early = [Reason.NO_SOLUTION, Reason.JOINT_LIMITS, Reason.TIP_BLOCKED]
    assert np.isin(result.reasons[blocked], early).all()
    assert not any(result.surface.vertex_colors[k] for k in np.flatnonzero(blocked))
    assert result.report.unreachable["tip blocked"] == blocked.sum()
    assert result.report.reachable > 50
    if height == 0.069:
        assert not blocked.any()
    else:
        assert blocked.sum() > 80


@pytest.mark.parametrize(("ground", "all_blocked"), [(0.13, True), (0.096, True), (0.094, False)])
def test_nothing_below_the_ground_or_nearer_to_it_than_the_radius(
    ground: float, all_blocked: bool
) -> None:
    result = build_surface(PLANE.varied(ground={"height_m": ground}))
    blocked = (result.reasons == Reason.TIP_BLOCKED).any(axis=1)
    assert blocked.all() == blocked.any() == all_blocked
    assert result.report.unreachable["tip blocked"] == blocked.sum()
    if all_blocked:
        assert result.report.reachable == 0


def test_the_region_reaches_to_the_body_of_the_tool(robot: Robot) -> None:
    """Without a body on the last link it is a ball."""
    above = SphereObstacle(kind="sphere", radius_m=0.001, position_m=(0.0, 0.0, 0.009))
    point, down = np.zeros((1, 3)), np.array([[0.0, 0.0, -1.0]])
    bare = replace(robot, bodies=tuple(body for body in robot.bodies if body.joint < 6))
    for arm, hit in ((robot, True), (bare, False)):
        assert Tip(arm, 0.002, [above.solid()], None).blocked(point, down) == hit
