"""How the meshes of links collide, and how far their hulls are off."""

from __future__ import annotations

import math
from dataclasses import dataclass

import igl
import trimesh

from cellcolor.frontend.arm.body import StandIn

_SAMPLES = 5_000  # of a hull's surface
_FAR = 0.02  # m; a hull that is farther off its mesh is warned of


@dataclass(frozen=True)
class StandInReport:
    """How a link's mesh collides.

    Attributes:
        link: whose mesh it is.
        file: the mesh file's name, without its folder.
        chosen: hull or exact.
        off_m: how far the farthest of many points on the hull is from the mesh; 0 of the mesh
            itself.
        closed: whether the mesh encloses anything; what is inside an open one that collides as
            it is goes unnoticed.
    """

    link: str
    file: str
    chosen: str
    off_m: float
    closed: bool

    @property
    def warning(self) -> str | None:
        """For a hull that is far off its mesh: what to choose instead."""
        if self.off_m <= _FAR:
            return None
        return (
            f"{self.link!r}: the convex hull of {self.file} is {_millimeters(self.off_m)} mm off "
            "the mesh, and fills what is hollow there: "
            '"exact" collides as the mesh is (mesh_collision_of under [robot])'
        )

    def __str__(self) -> str:
        if self.chosen == "exact":
            open_ = "" if self.closed else "; it is open: what is all inside it goes unnoticed"
            return f"{self.link!r}: {self.file}, as it is{open_}"
        off = _millimeters(self.off_m)
        return f"{self.link!r}: convex hull of {self.file}, up to {off} mm off"


def _millimeters(length: float) -> str:
    """Rounded down to a tenth."""
    return f"{math.floor(1e4 * length) / 10:g}"


def measured(stand_in: StandIn) -> StandInReport:
    """Measure one."""
    off, hull = 0.0, stand_in.body.shape
    if stand_in.chosen == "hull":
        surface = trimesh.Trimesh(hull.vertices, hull.faces, process=False)
        points, _ = trimesh.sample.sample_surface(surface, _SAMPLES, seed=0)
        squares = igl.point_mesh_squared_distance(points, stand_in.vertices, stand_in.faces)[0]
        off = math.sqrt(squares.max())
    mesh = trimesh.Trimesh(stand_in.vertices, stand_in.faces, process=False)
    return StandInReport(
        stand_in.link, stand_in.file.name, stand_in.chosen, off, bool(mesh.is_watertight)
    )
