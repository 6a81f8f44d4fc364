"""A plate before an arm of any family, a scene without collision shapes."""

from __future__ import annotations

import dh_arms
import numpy as np
from shipped import ROBOTS

from cellcolor.frontend import Scene, Setup
from cellcolor.frontend.parts.shapes import RectangleObject

SHIPPED = Setup.read(ROBOTS / "ur5_polishing.toml")


def plate(arm: str, kinematics: str, vertices: int = 150, **keys: object) -> Scene:
    """A plate before an arm without collision shapes; ``keys`` of the placement."""
    setup = SHIPPED.varied(
        robot={
            "kinematics": kinematics,
            "arm_urdf": arm,
            "flange_link": "flange",
            "tool_urdf": dh_arms.tool_of(),
            "tip_link": "tool_tip",
            "may_touch_ground": (),
        },
        thresholds={
            "min_manipulability_m3": None,
            "min_manipulability": 0.005,
            "min_task_determinant_m3": None,
            "min_task_determinant": 0.0005,
        },
        continuity={"near_singular_determinant_m3": None, "near_singular_determinant": 0.0025},
        slivers=None,
    )
    part = RectangleObject(size_x_m=0.3, size_y_m=0.5, target_vertices=vertices)
    placement = {"position_m": (0.45, 0.0, 0.15)} | keys
    return Scene(name="plate", setup=setup, object=part, placement=placement)


def cuspidal_scene() -> Scene:
    """A wall that a cuspidal arm reaches in one color with two configurations on some vertices."""
    scene = plate(
        dh_arms.urdf("cuspidal"),
        "eaik",
        vertices=150,
        position_m=(0.9, -0.2, 0.0),
        rpy_rad=(np.pi / 2, 0.0, 0.0),
    )
    scene = scene.varied(object={"size_x_m": 1.0, "size_y_m": 1.6})
    low = {"min_manipulability": 1e-4, "min_task_determinant": 1e-4}
    near = {"near_singular_determinant": 5e-4}
    return scene.with_setup(scene.setup.varied(thresholds=low, continuity=near))
