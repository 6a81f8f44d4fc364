"""The kinematic front end: from a robot scene to a labelled surface.

Needs the extra ``frontend`` (Pinocchio, trimesh, python-fcl). Only this package
imports them.
"""

from cellcolor.frontend.build import BuildResult, build_surface
from cellcolor.frontend.report import BuildReport, ColorReport
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Setup

__all__ = ["BuildReport", "BuildResult", "ColorReport", "Scene", "Setup", "build_surface"]
