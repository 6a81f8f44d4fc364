"""Scenes from file to trajectory, made once a session."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from shipped import shipped

import cellcolor
from cellcolor.arrays import Array
from cellcolor.decomposition import decomposition_of
from cellcolor.frontend.build import BuildResult, build_surface
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.scene import Scene
from cellcolor.motion.plan import MotionPlan, plan_motion
from cellcolor.painting.paint import Painted, paint


@dataclass(frozen=True)
class Planned:
    """A motion, and all that it was made of."""

    prepared: PreparedScene
    built: BuildResult
    painted: Painted
    normals: Array
    lift_offs: int
    plan: MotionPlan


def painted_scene(scene: Scene) -> tuple[PreparedScene, BuildResult, Painted, Array, int]:
    """A scene painted: with the normals of the painting, and the lift-offs that were proved."""
    built = build_surface(scene)
    prepared = built.prepared
    decomposition = decomposition_of(built.surface)
    solution = cellcolor.solve(decomposition.instance).solution
    assert solution is not None
    assert solution.proved_for_surface
    assert solution.segments is not None
    painted = paint(built.surface, decomposition, solution)
    normals = painted.interpolated(prepared.surface.normals)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return prepared, built, painted, normals, max(0, solution.segments - 1)


def planned_scene(scene: Scene, pattern: str = "contour") -> Planned:
    """A motion over a scene's object."""
    prepared, built, painted, normals, lift_offs = painted_scene(scene)
    plan = plan_motion(built, painted, normals, pattern=pattern)
    return Planned(prepared, built, painted, normals, lift_offs, plan)


@cache
def planned(name: str, vertices: int) -> Planned:
    """A motion over a shipped scene."""
    return planned_scene(shipped(name, vertices))
