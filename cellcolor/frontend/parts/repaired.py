"""A repaired part with all changes, or the reason why it cannot be repaired."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.cleaning import borders
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.remeshing import Deviation, length_for, remeshed
from cellcolor.frontend.parts.repairing import (
    LEAST_SHARE,
    Change,
    Mending,
    Telling,
    area_of,
    mended,
)
from cellcolor.frontend.parts.surface import Faces
from cellcolor.frontend.sizes import MOST_VERTICES
from cellcolor.mesh.triangle_mesh import TriangleMesh

MOST_FACES = 3_000_000  # a kilobyte each
_SUGGESTED = 60_000  # vertices of a mesh that is too large, remeshed


@dataclass(frozen=True, eq=False)
class RepairedPart:
    """A mesh that a scene can use, and the changes that made it so.

    Attributes:
        vertices: (n, 3) in the unit of the mesh that was repaired.
        faces: (m, 3).
        meters_per_unit: of the vertices.
        changes: what was changed, in its order.
        holes: how many borders are left.
        area_before_m2, area_m2: of all faces.
        deviation: in m, where the mesh was remeshed; None otherwise.
    """

    vertices: Array = field(repr=False)
    faces: Faces = field(repr=False)
    meters_per_unit: float
    changes: tuple[Change, ...]
    holes: int
    area_before_m2: float
    area_m2: float
    deviation: Deviation | None

    def to_obj(self) -> str:
        """The mesh as Wavefront OBJ."""
        rows = ["# repaired by cellcolor"]
        rows += ["v {:.10g} {:.10g} {:.10g}".format(*point) for point in self.vertices.tolist()]
        rows += ["f {} {} {}".format(*face) for face in (self.faces + 1).tolist()]
        return "\n".join(rows) + "\n"

    def to_dict(self) -> dict[str, Any]:
        """The report, all of it JSON-able; the mesh itself is not in it."""
        deviation = None
        if self.deviation is not None:
            deviation = {f"{name}_m": far for name, far in asdict(self.deviation).items()}
        return {
            "vertices": len(self.vertices),
            "triangles": len(self.faces),
            "meters_per_unit": self.meters_per_unit,
            "holes": self.holes,
            "area_before_m2": self.area_before_m2,
            "area_m2": self.area_m2,
            "changes": [
                {
                    "what": change.what,
                    "area_lost_m2": change.area_lost,
                    "area_gained_m2": change.area_gained,
                }
                for change in self.changes
            ],
            "deviation": deviation,
        }

    def __str__(self) -> str:
        lines = [in_words(change) for change in self.changes] or ["no change was needed"]
        if self.deviation is not None:
            off = self.deviation
            lines.append(
                f"the new mesh is at most {1e3 * off.greatest:.3g} mm from the old one, "
                f"{1e3 * off.mean:.3g} mm in the mean; back {1e3 * off.greatest_back:.3g} and "
                f"{1e3 * off.mean_back:.3g} mm (vertices and middles of faces)"
            )
        left = count(self.holes, "border") if self.holes else "closed"
        lines.append(
            f"{len(self.vertices):,} vertices, {len(self.faces):,} triangles, {left}; "
            f"area {self.area_m2:.4g} m^2, before {self.area_before_m2:.4g} m^2"
        )
        return "\n".join(lines)


def in_words(change: Change) -> str:
    """A change as a line, with the area gained or lost in m^2."""
    areas = [
        f"{sign}{area:.3g} m^2"
        for sign, area in (("-", change.area_lost), ("+", change.area_gained))
        if area
    ]
    return change.what + (f" ({', '.join(areas)})" if areas else "")


def check_known_size(faces: int) -> None:
    """Reject a mesh whose inspection needs more than 4 GiB.

    Raises:
        InputError: names both numbers.
    """
    if faces > MOST_FACES:
        raise InputError(None, "faces", f"there are {faces:,}, at most {MOST_FACES:,} fit")


def repair_mesh(
    vertices: Array,
    faces: Faces,
    meters_per_unit: float = 1.0,
    fill_holes_m: float = 0.0,
    least_share: float = LEAST_SHARE,
    edge_length_m: float | None = None,
    deadline: Deadline = NEVER,
    tell: Telling = lambda _: None,
) -> RepairedPart:
    """Repair a mesh, remesh it on request, and check it like a scene's object.

    Args:
        vertices: (n, 3) in any unit.
        faces: (m, 3).
        meters_per_unit: of the vertices.
        fill_holes_m: holes with a border up to that length are filled.
        least_share: components with less than this share of the largest one's area are dropped.
        edge_length_m: wanted of all edges; None leaves them.

    Raises:
        InputError: the mesh cannot be made good, or is too large; says why.
        ModuleNotFoundError: it is to be remeshed, and gpytoolbox is not installed.
    """
    check_known_size(len(faces))
    points = np.asarray(vertices, dtype=np.float64) * meters_per_unit
    known = ((faces >= 0) & (faces < len(points))).all() and np.isfinite(points).all()
    before = area_of(points, faces) if known else 0.0
    asked = Mending(fill_holes_m, least_share)
    points, faces, changes = mended(points, faces, asked, deadline, tell)
    deviation = None
    if edge_length_m is not None:
        was = len(points)
        old = area_of(points, faces)
        points, faces, again, deviation = remeshed(points, faces, edge_length_m, deadline, tell)
        gained = area_of(points, faces) - old
        text = f"remeshed to edges of about {1e3 * edge_length_m:.3g} mm: {len(points):,} vertices"
        change = Change(f"{text} instead of {was:,}", max(-gained, 0.0), max(gained, 0.0))
        changes += [change, *again]
    tell("checking")
    try:
        mesh_surface(points, faces, deadline=deadline)
    except InputError as error:
        raise _refused(error, points, faces, edge_length_m) from error
    return RepairedPart(
        vertices=points / meters_per_unit,
        faces=faces,
        meters_per_unit=meters_per_unit,
        changes=tuple(changes),
        holes=borders(TriangleMesh(points, faces)),
        area_before_m2=before,
        area_m2=area_of(points, faces),
        deviation=deviation,
    )


def _refused(
    error: InputError, points: Array, faces: Faces, edge_length_m: float | None
) -> InputError:
    """What is still wrong, and what would help where that is known."""
    message = f"cannot be repaired: {error.message}"
    if len(points) > MOST_VERTICES:
        length = length_for(area_of(points, faces), _SUGGESTED)
        message += f"; --edge-length {length:.2g} would give about {_SUGGESTED:,}"
    elif edge_length_m is not None:
        message += "; remeshed to shorter edges it keeps more of its shape"
    return InputError(None, error.field, message)
