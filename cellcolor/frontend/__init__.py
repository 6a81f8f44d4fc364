"""The kinematic front end: from a robot scene to a labelled surface.

Needs the extra ``frontend`` (Pinocchio with coal, trimesh, libigl). Only this package
imports them. Contacts are found by OpenMP's threads between much other work: they wait asleep.
"""

import os

os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # is read once, when Pinocchio is imported

from cellcolor.frontend.build import BuildResult, build_surface
from cellcolor.frontend.report import BuildReport, ColorReport
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Setup

__all__ = ["BuildReport", "BuildResult", "ColorReport", "Scene", "Setup", "build_surface"]
