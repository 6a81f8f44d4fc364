"""Is the mesh fine enough for what stands on it? A vertex says nothing of what is far from it."""

from __future__ import annotations

from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.solids import Solid

__all__ = ["too_coarse"]


def too_coarse(robot: Robot, obstacles: list[Solid], longest: float) -> str | None:
    """A warning where mesh edges are longer than the tool or an obstacle is wide.

    Args:
        longest: of the mesh's edges, m.
    """
    widths = [
        (2 * body.radius, f"the body of {body.link!r}")
        for body in robot.bodies
        if body.joint == robot.joints
    ]
    widths += [(solid.width, f"obstacle[{k}]") for k, solid in enumerate(obstacles)]
    width, name = min(widths, default=(longest, ""))
    if longest <= width:
        return None
    return (
        f"the object's edges are up to {longest:.3g} m long and {name} is {width:.3g} m wide: "
        "between vertices something can stand unnoticed (max_edge_m, target_vertices)"
    )
