"""Wider bodies: what a robot touches that keeps a distance from everything."""

from __future__ import annotations

from dataclasses import replace

from cellcolor.frontend.arm.robot import Body, Robot

__all__ = ["wider", "wider_body"]


def wider(robot: Robot, by: float) -> Robot:
    """The robot with all that is nearer than a distance (m) to its bodies.

    A cylinder stays one, longer and wider, so that it has a little more than that at its rims.
    """
    if by == 0.0:
        return robot
    return replace(robot, bodies=tuple([wider_body(body, by) for body in robot.bodies]))


def wider_body(body: Body, by: float) -> Body:
    """One of its bodies; see :func:`wider`."""
    if body.solid is not None:
        return replace(body, radius=body.radius + by, skin=body.skin + by)
    if not body.flat:
        return replace(body, radius=body.radius + by)
    along = by * (body.end - body.start) / body.length
    return replace(body, start=body.start - along, end=body.end + along, radius=body.radius + by)
