"""The faces of an object to be covered, and which side of a part is its outside.

The arm must only not hit the faces that are not covered. Sharp edges part the sides of a shell and
the regions that can be chosen.
"""

from __future__ import annotations

from typing import Annotated, Self

import igl
import numpy as np
from pydantic import Field, FiniteFloat, field_validator, model_validator

from cellcolor.arrays import Array, Index, Mask, angles_between
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.mending import in_words
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.tables import IN_RADIANS, Position, Table, Vector
from cellcolor.mesh.triangle_mesh import TriangleMesh

SHARP_RAD = 1.0
"""Between the normals of two faces: the sides of a shell end at edges from there on."""

_THIN = 0.03  # of the part's size; a side so near behind another makes a shell
_MOSTLY = 0.6  # of the area, for the part to be one
_POINTS = 100  # of the area that are looked at
_ALIKE = 0.5  # of the larger side's area, at least, has the other one


def thickness(mesh: TriangleMesh) -> float | None:
    """Of a shell, the median distance in m from one side to the other behind it; None of others."""
    size = float(np.linalg.norm(np.ptp(mesh.points, axis=0)))
    inward = -np.nan_to_num(mesh.triangle_normals)
    points, face = spread(mesh, _POINTS)
    tree = igl.AABB()
    tree.init(mesh.points, mesh.corners)
    hits = tree.intersect_ray(mesh.points, mesh.corners, points, inward[face])
    # What lies behind has its own outside on the other side.
    behind = np.array(
        [
            min((way for other, way, *_ in own if inward[other] @ into < -0.5), default=np.inf)
            for own, into in zip(hits, inward[face], strict=True)
        ]
    )
    found = behind <= _THIN * size
    return float(np.median(behind[found])) if found.mean() >= _MOSTLY else None


def spread(mesh: TriangleMesh, count: int) -> tuple[Array, Index]:
    """Points (k, 3) all over the surface, each for as much area, and the face (k,) of each."""
    corners, areas = mesh.points[mesh.corners], mesh.areas
    wanted = (np.arange(count) + 0.5) / count * areas.sum()
    face = np.minimum(np.searchsorted(np.cumsum(areas), wanted), len(areas) - 1)
    u, v = np.random.default_rng(0).random((2, count))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    weights = np.stack([1 - u - v, u, v], axis=1)
    return np.einsum("ij,ijk->ik", weights, corners[face]), face


def between_sharp(mesh: TriangleMesh, sharp_rad: float) -> Index:
    """The number of the piece (m,) that each face is in; sharp edges part them."""
    sharp = np.zeros(len(mesh.edges), dtype=bool)
    sharp[mesh.sharp_edges(sharp_rad)] = True
    return mesh.parts(sharp)


def pieces(mesh: TriangleMesh) -> list[Mask]:
    """The faces (m,) between sharp edges, the piece with the largest area first."""
    part = between_sharp(mesh, SHARP_RAD)
    order = np.argsort(-np.bincount(part, mesh.areas), kind="stable")
    return [np.asarray(part == number) for number in order[:2]]


def shell_sides(mesh: TriangleMesh) -> list[Mask] | None:
    """The two sides (m,) of a shell, the larger one, its outer, first; None if they are not two."""
    found = pieces(mesh)
    if len(found) < 2 or mesh.areas[found[1]].sum() < _ALIKE * mesh.areas[found[0]].sum():
        return None
    return found


def facing(mesh: TriangleMesh, faces: Mask | slice = slice(None)) -> Array:
    """The mean of the normals (3,): of length 1 if all point alike, 0 if every way."""
    area = mesh.areas[faces].sum()
    return np.asarray(mesh.area_vectors[faces].sum(axis=0) / 2 / area)


def note_on_shell(surface: Surface) -> tuple[str, ...]:
    """A sentence if a tool has to cover both sides of something thin."""
    thick = thickness(surface.mesh if surface.divided is None else surface.divided[0])
    if thick is None:
        return ()
    return (
        f"the part is a shell, {1e3 * thick:.2g} mm thick, and both its sides are to be covered: "
        "[cover] chooses one (docs/parts.md, patches)",
    )


Angle = Annotated[FiniteFloat, Field(gt=0, le=float(np.pi)), IN_RADIANS]


class NormalCone(Table):
    """Faces whose outward normal is within an angle of a direction.

    Attributes:
        direction: (3,) of any length but 0.
    """

    direction: Vector
    within_rad: Angle

    @field_validator("direction")
    @classmethod
    def _no_zero(cls, direction: Vector) -> Vector:
        if not np.linalg.norm(direction) > 0:
            raise ValueError("has no direction: its length is 0")
        return direction


class Box(Table):
    """Faces whose three corners are in a box along the axes."""

    low_m: Position
    high_m: Position


class Region(Table):
    """Faces that are reached from a point without crossing a sharp edge.

    Attributes:
        seed_m: the point; the region grows from the face nearest to it.
        sharp_rad: an edge is sharp if the normals of its two faces are farther from each other.
    """

    seed_m: Position
    sharp_rad: Angle


class Cover(Table):
    """The faces of an object that are to be covered, in the object's own frame.

    Every given key has to hold; at least one is given. The arm must not hit the whole object,
    unless the scene has a ``collision_object``.

    Attributes:
        component: the number of a component: faces connected by edges, numbered from the
            largest area, 0, to the smallest.
    """

    normal: NormalCone | None = None
    box: Box | None = None
    component: Annotated[int, Field(ge=0)] | None = None
    region: Region | None = None

    @model_validator(mode="after")
    def _something(self) -> Self:
        if all(getattr(self, key) is None for key in type(self).model_fields):
            raise ValueError(f"needs one of {', '.join(type(self).model_fields)}")
        return self

    def patch(self, whole: Surface, deadline: Deadline = NEVER) -> Surface:
        """The faces that are to be covered, as a surface of its own.

        Vertices keep their order. Normals on the patch's border are those of its own faces: beside
        a sharp edge the tool stands upright on the side that is covered.

        Args:
            whole: the object, in its own frame.

        Raises:
            InputError: no face is chosen, or every face of a closed object; the patch is no
                manifold; there is no such component.
        """
        chosen = self.chosen(whole)
        deadline.check()
        if not chosen.any():
            raise InputError(None, "cover", f"chooses none of {count(len(chosen), 'face')}")
        faces = whole.faces[chosen]
        if not TriangleMesh(whole.vertices, faces).border.any():
            raise InputError(None, "cover", "chooses a closed surface: a patch has a border")
        used, compact = np.unique(faces, return_inverse=True)
        compact = compact.reshape(-1, 3).astype(np.int64)
        try:
            patch = mesh_surface(whole.vertices[used], compact, deadline=deadline)
        except InputError as error:
            place = _in_whole(error.field, whole, used)
            message = f"chooses a patch that cannot be covered: {place}{error.message}"
            raise InputError(None, "cover", message) from error
        inside = np.bincount(faces.ravel(), minlength=len(whole.vertices)) == np.bincount(
            whole.faces.ravel(), minlength=len(whole.vertices)
        )
        normals = np.where(inside[used][:, None], whole.normals[used], patch.normals)
        return Surface(patch.vertices, patch.faces, normals, whole.faceted)

    def chosen(self, whole: Surface) -> Mask:
        """Which faces (m,) of the object are chosen; see :meth:`patch`."""
        chosen = np.ones(len(whole.faces), dtype=bool)
        if self.normal is not None:
            along = np.array(self.normal.direction) / np.linalg.norm(self.normal.direction)
            chosen &= angles_between(whole.mesh.triangle_normals, along) <= self.normal.within_rad
        if self.box is not None:
            corners = whole.vertices[whole.faces]
            inside = (corners >= self.box.low_m) & (corners <= self.box.high_m)
            chosen &= inside.all(axis=(1, 2))
        if self.component is not None:
            part = whole.mesh.parts()
            area = np.bincount(part, whole.mesh.areas)
            if self.component >= len(area):
                message = f"there is no component {self.component}: the object has {len(area)}"
                raise InputError(None, "cover.component", message)
            chosen &= part == np.argsort(-area, kind="stable")[self.component]
        if self.region is not None:
            # On the same side of all sharp edges as the face nearest to the seed.
            part = between_sharp(whole.mesh, self.region.sharp_rad)
            seed = np.array([self.region.seed_m])
            face = igl.point_mesh_squared_distance(seed, whole.vertices, whole.faces)[1][0]
            chosen &= part == part[face]
        return chosen


def _in_whole(field: str | None, whole: Surface, vertices: Index) -> str:
    """``vertices[3]`` of the patch as that of the object, with a colon.

    By its place where edges were halved: no file has those numbers.
    """
    if field is None or not field.startswith("vertices["):
        return ""
    vertex = vertices[int(field.removeprefix("vertices[").removesuffix("]"))]
    if whole.divided is None:
        return f"vertices[{vertex}]: "
    return f"near {in_words(whole.vertices[vertex])} m: "
