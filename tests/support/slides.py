"""The small SCARA scene with a motion: a few vertices of the pipe, wide passes."""

from __future__ import annotations

from functools import cache

from shipped import TOP

import cellcolor
from cellcolor.frontend import Scene
from cellcolor.frontend.setup import Motion

SLIDE = 2
"""The prismatic joint of the four."""
MOTION = Motion(
    spacing_m=0.02,
    tool_radius_m=0.03,
    joint_velocities_rad_per_s=(3.0, 3.0, 0.15, 6.0),
    joint_accelerations_rad_per_s2=(8.0, 8.0, 2.0, 16.0),
    retract_m=0.02,
    clearance_m=0.003,
)


def scara_scene(motion: Motion = MOTION) -> Scene:
    """The shipped scene with 250 vertices and longer, so that each end has an elbow of its own."""
    scene = Scene.read(TOP / "instances" / "planar" / "cobra600_pipe.toml")
    scene = scene.varied(object={"target_vertices": 250, "length_m": 0.54})
    return scene.with_setup(scene.setup.model_copy(update={"motion": motion}))


@cache
def driven_scara() -> cellcolor.PlannedScene:
    """Its motion, planned and judged once a session."""
    return cellcolor.plan(scara_scene())
