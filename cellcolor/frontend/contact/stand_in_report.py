"""How much the colliding shapes of a link differ from its mesh."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import trimesh
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Mask, unit
from cellcolor.data.wording import count
from cellcolor.frontend.arm.body import Body, StandIn
from cellcolor.frontend.arm.polyhedron import longest_side_first
from cellcolor.frontend.contact.collision import segment_distance
from cellcolor.frontend.contact.solids import sample_mesh

_SAMPLES = 50_000  # about the most samples of each surface
_SLACK = 0.0005  # m; wanted distance of a surface's points to the nearest sample
_FAR = 0.02  # m; a hull that is farther off its mesh is warned of
_HALVINGS = 40  # of a face; a meter comes down to a micrometer
_ROUNDING = 1e-8  # m; a mesh that comes out no farther is contained


@dataclass(frozen=True)
class StandInReport:
    """How a link's mesh collides.

    Attributes:
        link: whose mesh it is.
        file: the mesh file's name, without its folder.
        chosen: hull, exact or capsules.
        shapes: how many bodies collide in its place.
        error_m: no point of their surface is farther from the mesh than this; 0 of the mesh itself.
        known_to_m: and some point is farther than that error less this.
        contains: whether all of the mesh is inside of them.
        closed: whether the mesh encloses anything; what is inside an open one that collides as
            it is goes unnoticed.
    """

    link: str
    file: str
    chosen: str
    shapes: int
    error_m: float
    known_to_m: float
    contains: bool
    closed: bool

    @property
    def warning(self) -> str | None:
        """For a hull that is certainly far off its mesh: what to choose instead."""
        certain = self.error_m - self.known_to_m
        if self.chosen != "hull" or certain <= _FAR:
            return None
        return (
            f"{self.link!r}: the convex hull of {self.file} is more than "
            f"{math.floor(1e4 * certain) / 10:g} mm off the mesh, and fills what is hollow there: "
            f'"exact" collides as the mesh is (mesh_collision_of under [robot])'
        )

    def __str__(self) -> str:
        if self.chosen == "exact":
            open_ = "" if self.closed else "; it is open: what is all inside it goes unnoticed"
            return f"{self.link!r}: {self.file}, as it is{open_}"
        what = "convex hull" if self.chosen == "hull" else count(self.shapes, "capsule")
        inside = "contains it" if self.contains else "does not contain all of it"
        error, known = (math.ceil(1e4 * value) / 10 for value in (self.error_m, self.known_to_m))
        return (
            f"{self.link!r}: {what} of {self.file}, {inside}, "
            f"at most {error:g} mm off (known to {known:g} mm)"
        )


def report_on(stand_in: StandIn) -> StandInReport:
    """Measure one."""
    error = known = 0.0
    contains = True
    if stand_in.chosen != "exact":
        mesh, mesh_slack = sample_mesh(stand_in.vertices, stand_in.faces, _SLACK, _SAMPLES)
        tree = cKDTree(mesh)
        for body in stand_in.bodies:
            surface, slack = _surface(body)
            outside = np.ones(len(surface), dtype=bool)
            for other in stand_in.bodies:
                if other is not body:
                    outside &= ~_inside(other, surface)
            # What lies inside another capsule is no part of the surface of them all.
            apart = tree.query(surface[outside])[0] if outside.any() else np.zeros(1)
            # From a sample of the one to the mesh it is no farther than to a sample of that, and
            # from elsewhere on the surface no farther than from a sample and the way to that.
            error = max(error, float(apart.max() + slack))
            known = max(known, float(slack + mesh_slack))
        contains = _all_inside(stand_in.bodies, stand_in.vertices[stand_in.faces])
    return StandInReport(
        link=stand_in.link,
        file=stand_in.file.name,
        chosen=stand_in.chosen,
        shapes=len(stand_in.bodies),
        error_m=error,
        known_to_m=known,
        contains=contains,
        closed=bool(
            trimesh.Trimesh(stand_in.vertices, stand_in.faces, process=False).is_watertight
        ),
    )


def _all_inside(bodies: tuple[Body, ...], triangles: Array) -> bool:
    """Whether each point of triangles (m, 3, 3) is in a body; not known counts as no.

    A body that contains the corners of a triangle contains all of it, since it is convex. A
    triangle across the border of two bodies is halved until each part is in one of them.
    """
    rest = triangles
    for _ in range(_HALVINGS):
        inside = np.stack([_inside(body, rest.reshape(-1, 3)).reshape(-1, 3) for body in bodies])
        if not inside.any(axis=0).all():
            return False
        rest = rest[~inside.all(axis=2).any(axis=0)]
        if not len(rest) or len(bodies) == 1:
            return not len(rest)
        a, b, c = longest_side_first(rest)
        middle = (a + b) / 2
        rest = np.concatenate([np.stack([a, middle, c], 1), np.stack([middle, b, c], 1)])
    return False


def _inside(body: Body, points: Array) -> Mask:
    """Whether points (k, 3) are in a capsule or a hull, (k,)."""
    if body.solid is None:
        ends = (np.broadcast_to(end, points.shape) for end in (body.start, body.end))
        return np.asarray(segment_distance(points, points, *ends) <= body.radius + _ROUNDING)
    a, b, c = (body.solid.vertices[body.solid.faces[:, k]] for k in range(3))
    normals = unit(np.cross(b - a, c - a))
    inside = np.ones(len(points), dtype=bool)
    for normal, corner in zip(normals, a, strict=True):
        inside &= (points - corner) @ normal <= _ROUNDING
    return inside


def _surface(body: Body) -> tuple[Array, float]:
    """Points (k, 3) on the surface of a capsule or a hull, and how far it is from them at most."""
    if body.solid is not None:
        return sample_mesh(body.solid.vertices, body.solid.faces, _SLACK, _SAMPLES)
    radius, length = body.radius, body.length
    step = max(np.sqrt(2) * _SLACK, np.sqrt(2 * np.pi * radius * (length + 2 * radius) / _SAMPLES))
    # Rings about the axis, along the profile of half a circle, a straight side, half a circle.
    bend = np.linspace(0.0, np.pi / 2, int(np.ceil(np.pi / 2 * radius / step)) + 1)
    side = np.linspace(0.0, length, int(np.ceil(length / step)) + 1)
    along = np.concatenate([-radius * np.cos(bend), side, length + radius * np.sin(bend)])
    off = np.concatenate([radius * np.sin(bend), np.full(len(side), radius), radius * np.cos(bend)])
    around = np.linspace(0.0, 2 * np.pi, int(np.ceil(2 * np.pi * radius / step)), endpoint=False)
    axis = (body.end - body.start) / length if length else np.array([0.0, 0.0, 1.0])
    across = np.linalg.svd(axis[None])[2][1:]
    ring = np.stack([np.cos(around), np.sin(around)], axis=1) @ across
    points = body.start + along[:, None, None] * axis + off[:, None, None] * ring
    return points.reshape(-1, 3), float(step / np.sqrt(2))
