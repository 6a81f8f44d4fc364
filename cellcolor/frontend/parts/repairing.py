"""A mesh repaired step by step, with a list of the changes, or the reason why it cannot be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.mending import (
    against_the_others,
    border_groups,
    cleaned,
    cut_apart,
    filled,
    in_words,
    inside_out,
    refuse_gaps,
    turned,
    used,
)
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.remeshing import Deviation, length_for, remeshed
from cellcolor.frontend.parts.surface import MOST_VERTICES, Faces
from cellcolor.mesh.triangle_mesh import TriangleMesh, check_corners

MOST_FACES = 3_000_000  # a kilobyte each
LEAST_SHARE = 0.01
"""Components with less than this share of the largest one's area are dropped, if not asked."""

_SUGGESTED = 60_000  # vertices of a mesh that is too large, remeshed
Telling = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class RepairedPart:
    """A mesh that a scene can use, and the changes that made it so.

    Attributes:
        vertices: (n, 3) in the unit of the mesh that was repaired.
        faces: (m, 3).
        changes: what was changed, in its order, with the area that it took or gave.
        holes: how many borders are left.
        area_before_m2, area_m2: of all faces.
        deviation: in m, where the mesh was remeshed; None otherwise.
    """

    vertices: Array = field(repr=False)
    faces: Faces = field(repr=False)
    meters_per_unit: float
    changes: tuple[str, ...]
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
        off = self.deviation
        return {
            "vertices": len(self.vertices),
            "triangles": len(self.faces),
            "meters_per_unit": self.meters_per_unit,
            "holes": self.holes,
            "area_before_m2": self.area_before_m2,
            "area_m2": self.area_m2,
            "changes": list(self.changes),
            "deviation": None
            if off is None
            else {f"{name}_m": far for name, far in asdict(off).items()},
        }

    def __str__(self) -> str:
        lines = [*self.changes] or ["no change was needed"]
        if self.deviation is not None:
            lines.append(str(self.deviation))
        left = count(self.holes, "border") if self.holes else "closed"
        lines.append(
            f"{len(self.vertices):,} vertices, {len(self.faces):,} triangles, {left}; "
            f"area {self.area_m2:.4g} m^2, before {self.area_before_m2:.4g} m^2"
        )
        return "\n".join(lines)


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
        fill_holes_m: holes with a border up to that length are filled.
        least_share: components with less than this share of the largest one's area are dropped.
        edge_length_m: wanted of all edges; None leaves them.

    Raises:
        InputError: the mesh cannot be made good, or is too large; says why.
        ModuleNotFoundError: it is to be remeshed, and gpytoolbox is not installed.
    """
    given = np.asarray(vertices, dtype=np.float64) * meters_per_unit
    points, new, changes = mended(given, faces, fill_holes_m, least_share, deadline, tell)
    deviation = None
    if edge_length_m is not None:
        was = len(points)
        points, new, deviation = remeshed(points, new, edge_length_m, deadline, tell)
        text = f"remeshed to edges of about {1e3 * edge_length_m:.3g} mm: {len(points):,} vertices"
        changes.append(f"{text} instead of {was:,}")
    tell("checking")
    try:
        mesh_surface(points, new, deadline=deadline)
    except InputError as error:
        message = f"cannot be repaired: {error.message}"
        if len(points) > MOST_VERTICES:
            length = length_for(_area_of(points, new), _SUGGESTED)
            message += f"; --edge-length {length:.2g} would give about {_SUGGESTED:,}"
        elif edge_length_m is not None:
            message += "; remeshed to shorter edges it keeps more of its shape"
        raise InputError(None, error.field, message) from error
    return RepairedPart(
        vertices=points / meters_per_unit,
        faces=new,
        meters_per_unit=meters_per_unit,
        changes=tuple(changes),
        holes=int(border_groups(TriangleMesh(points, new))[1].max(initial=-1)) + 1,
        area_before_m2=_area_of(given, faces),
        area_m2=_area_of(points, new),
        deviation=deviation,
    )


def mended(
    vertices: Array,
    faces: Faces,
    longest_hole: float = 0.0,
    least_share: float = LEAST_SHARE,
    deadline: Deadline = NEVER,
    tell: Telling = lambda _: None,
) -> tuple[Array, Faces, list[str]]:
    """A mesh without the faults that can be repaired, and what was changed; others may remain.

    In this order: vertices in one place are merged; duplicate faces and faces without area are
    dropped; the winding is made consistent; the mesh is cut apart where it is not manifold; small
    components are dropped; the winding is made consistent between new neighbors; holes are filled;
    closed components are turned outward. Lengths are in m.

    Raises:
        InputError: coordinates that are not finite, a face of no vertex, too many faces, nothing
            left; flat faces between others, a component without an outside; names the place.
    """
    bad = np.argwhere(~np.isfinite(vertices))
    if len(bad):
        row, axis = bad[0]
        raise InputError(None, f"vertices[{row}][{axis}]", "is not a finite number")
    check_corners(faces, len(vertices))
    if not 0 < len(faces) <= MOST_FACES:
        there = f"there are {len(faces):,}, at most {MOST_FACES:,} fit"
        raise InputError(None, "faces", there if len(faces) else "there are none")
    changes: list[str] = []

    def step(name: str) -> None:
        deadline.check()
        tell(name)

    def note(number: int, one: str, what: str, area: float = 0.0) -> None:
        if number:
            changes.append(f"{counted(number, one)} {what}" + (f" ({area:+.3g} m^2)" * bool(area)))

    step("merging vertices and dropping useless faces")
    clean = cleaned(vertices, faces)
    area = _area_of(clean.vertices, clean.double)
    note(clean.unused, "vertex", "dropped that no face uses")
    note(clean.twins, "vertex", "merged with another in the same place")
    note(clean.folded, "face", "dropped: two corners in one place")
    note(len(clean.double), "face", "dropped: there twice", -area)
    note(len(clean.flat), "face", "dropped: without area")
    refuse_gaps(clean.vertices, clean.faces, clean.flat)
    vertices, faces = used(clean.vertices, clean.faces)
    step("making the winding consistent")
    turn, one_sided = against_the_others(faces)
    if one_sided.any():
        place = in_words(vertices[faces[np.argmax(one_sided)]].mean(axis=0))
        message = "lies in a one-sided component, like a Moebius strip: it has no outside"
        raise InputError(None, f"faces near {place}", message)
    note(int(turn.sum()), "face", "turned to wind like those around")
    step("cutting apart what is not manifold")
    before = len(vertices)
    vertices, faces, moved = cut_apart(vertices, turned(faces, turn))
    what = "added: the mesh cut apart where it was no manifold, and copies of a vertex moved by up"
    note(len(vertices) - before, "vertex", f"{what} to {moved:.3g} m")
    step("dropping small components")
    mesh = TriangleMesh(vertices, faces)
    part = mesh.parts()
    areas = np.bincount(part, mesh.areas)
    small = areas < least_share * areas.max()
    what = f"dropped: each with less than {least_share:.3g} of the largest one's area"
    note(int(small.sum()), "component", what, -float(areas[small].sum()))
    vertices, faces = used(vertices, faces[~small[part]])
    turn, _ = against_the_others(faces)
    note(int(turn.sum()), "face", "turned to wind like those around")
    faces = turned(faces, turn)
    if longest_hole:
        step("filling holes")
        new, left = filled(vertices, faces, longest_hole)
        added = np.concatenate([faces[:0], *new])
        what = f"filled with {count(len(added), 'face')}"
        note(len(new), "hole", what, _area_of(vertices, added))
        note(left, "hole", "left: nothing fits in")
        faces = np.concatenate([faces, added])
    # A component that was open till now has an inside and an outside now.
    step("turning closed components outward")
    mesh = TriangleMesh(vertices, faces)
    wrong = inside_out(mesh)
    parts = len(np.unique(mesh.parts()[wrong]))
    note(parts, "closed component", f"turned outside out: {count(int(wrong.sum()), 'face')}")
    return vertices, turned(faces, wrong), changes


def counted(number: int, one: str) -> str:
    """``1 vertex``, ``1,200 vertices``."""
    several = "vertices" if one == "vertex" else f"{one}s"
    return f"{number:,} {one if number == 1 else several}"


def _area_of(vertices: Array, faces: Faces) -> float:
    return float(TriangleMesh(vertices, faces).areas.sum())
