"""An inspected mesh: what it has, what is wrong with it and where, and what a repair would do."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, fields
from typing import Any

import igl
import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.mending import (
    against_the_others,
    border_groups,
    cleaned,
    crossing_pairs,
    in_words,
    inside_out,
    turned,
)
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.mesh_file import UNITS, likely_unit
from cellcolor.frontend.parts.repairing import Telling, counted, mended
from cellcolor.frontend.parts.surface import SHARP, Faces
from cellcolor.mesh.triangle_mesh import TriangleMesh

_SHOWN = 3  # places of one fault in a printed inspection
_STORED = 100  # places of one fault in a JSON document
Place = tuple[float, ...]


@dataclass(frozen=True)
class Hole:
    """Connected border edges: their length in m, their number, the middle of their ends in m."""

    length_m: float
    edges: int
    place: Place


@dataclass(frozen=True)
class Component:
    """Faces connected by edges; closed if each of their edges has two faces."""

    faces: int
    area_m2: float
    closed: bool


def _told(row: str, one: str, what: str = "") -> dict[str, str]:
    """What a reader is told of a fault, beside the field with its places or their number.

    Args:
        row: that it is told in.
        one: thing that has the fault, and ``what`` is wrong with it.
    """
    return {"row": row, "one": one, "what": what}


@dataclass(frozen=True, eq=False)
class Inspection:
    """A mesh in numbers; places in m.

    Attributes:
        name: of its file, or what it is.
        unit: of its coordinates: ``m``, ``mm``, ``cm`` or ``in``.
        unit_reason: why; for a given unit, that it was given.
        triangles, vertices: how many; vertices that no face has are not counted.
        low_m, high_m: corners of the bounding box.
        components: from the largest area to the smallest.
        holes: from the longest border to the shortest.
        non_manifold_vertices: places of vertices on no non-manifold edge whose faces form several
            fans.
        mixed_winding: how many faces wind against those around them.
        edge_lengths_m: least, lower quartile, median, upper quartile, greatest.
        refusal: why a scene could not use the mesh as it is; None if it could.
        repairs: what a repair would change, without filling holes or remeshing.
        refusal_after_repair: why the mesh could not be used after that; None if it could.
        mesh: in m, as it was given.
        faulty_faces: by the fault's name, corners (k, 3, 3) of faces, for pictures.
        faulty_edges: by the fault's name, ends (k, 2, 3) of edges; of sharp ones too, no fault.
    """

    name: str
    unit: str
    unit_reason: str
    triangles: int
    vertices: int
    low_m: Place
    high_m: Place
    area_m2: float
    components: tuple[Component, ...]
    holes: tuple[Hole, ...] = field(metadata=_told("holes", "border"))
    non_manifold_edges: tuple[Place, ...] = field(
        metadata=_told("non-manifold", "edge", " of 3 faces or more")
    )
    non_manifold_vertices: tuple[Place, ...] = field(
        metadata=_told("non-manifold", "vertex", " not manifold")
    )
    merged_vertices: int = field(metadata=_told("twins", "vertex", " in the same place as another"))
    unused_vertices: int = field(metadata=_told("unused", "vertex", " without a face"))
    duplicate_faces: int = field(metadata=_told("duplicates", "face", " there twice"))
    flat_faces: int = field(metadata=_told("flat", "face", " without area"))
    mixed_winding: int = field(metadata=_told("winding", "face", " against those around"))
    inside_out: int = field(
        metadata=_told("inside out", "closed component", " with a negative volume")
    )
    crossings: tuple[Place, ...] = field(metadata=_told("crossings", "pair"))
    edge_lengths_m: tuple[float, ...]
    refusal: str | None
    repairs: tuple[str, ...]
    refusal_after_repair: str | None
    mesh: TriangleMesh = field(repr=False)
    faulty_faces: dict[str, Array] = field(repr=False)
    faulty_edges: dict[str, Array] = field(repr=False)

    def to_dict(self) -> dict[str, Any]:
        """Everything except the mesh, JSON-able; the first hundred places of each kind."""
        found: dict[str, Any] = {}
        for name in [one.name for one in fields(self) if one.repr]:
            value = getattr(self, name)
            if name in ("components", "holes"):
                value = tuple(map(asdict, value))
            if isinstance(value, tuple) and name.startswith(("comp", "holes", "non_", "cross")):
                value = {"count": len(value), "first": list(value[:_STORED])}
            found[name] = list(value) if isinstance(value, tuple) else value
        return found

    def __str__(self) -> str:
        size = " x ".join(f"{b - a:.4g}" for a, b in zip(self.low_m, self.high_m, strict=True))
        edges = [f"{1e3 * length:.3g}" for length in self.edge_lengths_m]
        first = [
            f"{own.faces:,} faces {'closed' if own.closed else 'open'}"
            for own in self.components[:_SHOWN]
        ]
        if len(self.components) > _SHOWN:
            first.append(f"and {len(self.components) - _SHOWN:,} more")
        rows = [
            ("triangles", f"{self.triangles:,}, {self.vertices:,} vertices"),
            ("unit", f"{self.unit}: {self.unit_reason}"),
            ("size", f"{size} m from {_at(self.low_m)} m, area {self.area_m2:.4g} m^2"),
            ("edges", f"{edges[0]} to {edges[4]} mm, quartiles {', '.join(edges[1:4])} mm"),
            ("components", f"{len(self.components):,}: {', '.join(first)}"),
            *self._faults(),
            ("usable as it is", "yes" if self.refusal is None else f"no: {self.refusal}"),
        ]
        repairs = self.repairs or ("change nothing",)
        lines = [self.name, *(f"  {name:<16} {text}" for name, text in rows), "  repair would"]
        lines += [f"    {change}" for change in repairs]
        after = self.refusal_after_repair
        return "\n".join(
            [*lines, f"  and then it is {f'still not usable: {after}' if after else 'usable'}"]
        )

    def _faults(self) -> Iterator[tuple[str, str]]:
        """How often each fault that there is is found, and where."""
        for one in fields(self):
            found = getattr(self, one.name)
            if "row" not in one.metadata or not found:
                continue
            number, places = (found, ()) if isinstance(found, int) else (len(found), found)
            where = [
                f"{1e3 * at.length_m:.3g} mm long at {_at(at.place)}"
                if isinstance(at, Hole)
                else _at(at)
                for at in places[:_SHOWN]
            ]
            where += [f"and {number - _SHOWN:,} more"] if len(places) > _SHOWN else []
            said = f"{counted(number, one.metadata['one'])}{one.metadata['what']}"
            yield one.metadata["row"], said + ": " * bool(places) + ", ".join(where)


def inspect_mesh(
    name: str,
    vertices: Array,
    faces: Faces,
    unit: str | None = None,
    deadline: Deadline = NEVER,
    tell: Telling = lambda _: None,
) -> Inspection:
    """Inspect a mesh, whatever is wrong with it, and say what a repair would do.

    Before topology is inspected, vertices in one place are merged, and duplicate faces and faces
    without area left out, as a repair would do first.

    Args:
        vertices: (n, 3) in its unit.
        faces: (m, 3).
        unit: ``m``, ``mm``, ``cm`` or ``in``; None takes the likely one, meters where that is open.

    Raises:
        InputError: it cannot be looked through: coordinates that are not finite, a face of no
            vertex, no face with an area, too many faces, no such unit.
    """
    if unit is not None and unit not in UNITS:
        raise InputError(None, "unit", f"must be one of {', '.join(UNITS)}, is {unit!r}")
    if not len(faces):
        raise InputError(None, "faces", "there are none")
    reason = "as given"
    if unit is None:
        with np.errstate(invalid="ignore"):
            likely, reason = likely_unit(float(np.ptp(vertices, axis=0).max()))
        unit = likely or "m"
    whole = np.asarray(vertices, dtype=np.float64) * UNITS[unit]
    # First the repair: what makes it impossible makes an inspection impossible.
    repairs: list[str] = []
    try:
        made, new, repairs = mended(whole, faces, deadline=deadline, tell=tell)
        after = _refusal(made, new, deadline)
    except InputError as error:
        after = str(error)
    refusal = _refusal(whole, faces, deadline)
    found = cleaned(whole, faces)
    points, clean = found.vertices, found.faces
    deadline.check()
    tell("looking at edges and components")
    mesh = TriangleMesh(points, clean)
    part = mesh.parts()
    turn, _ = against_the_others(clean)
    wrong = inside_out(TriangleMesh(points, turned(clean, turn)))
    many = mesh.edges[mesh.triangles_at > 2]
    split = np.flatnonzero(~igl.is_vertex_manifold(clean))
    split = split[~np.isin(split, many)]
    tell("looking for faces that cross")
    deadline.check()
    crossing = crossing_pairs(points, clean)
    deadline.check()
    return Inspection(
        name=name,
        unit=unit,
        unit_reason=reason,
        triangles=len(faces),
        vertices=len(vertices) - found.unused,
        unused_vertices=found.unused,
        merged_vertices=found.twins,
        low_m=tuple(points.min(axis=0).tolist()),
        high_m=tuple(points.max(axis=0).tolist()),
        area_m2=float(mesh.areas.sum()),
        components=_components(part, mesh),
        holes=_holes(mesh),
        non_manifold_edges=_places(points[many].mean(axis=1)),
        non_manifold_vertices=_places(points[split]),
        duplicate_faces=len(found.double),
        flat_faces=len(found.flat) + found.folded,
        mixed_winding=int(turn.sum()),
        inside_out=len(np.unique(part[wrong])),
        crossings=_crossing_places(mesh, crossing),
        edge_lengths_m=tuple(np.percentile(mesh.lengths, [0, 25, 50, 75, 100]).tolist()),
        refusal=refusal,
        repairs=tuple(repairs),
        refusal_after_repair=after,
        mesh=TriangleMesh(whole, faces),
        faulty_faces={
            "faces there twice": points[found.double],
            "faces without area": points[found.flat],
            "faces wound against their neighbors": points[clean[turn]],
            "closed components inside out": points[clean[wrong]],
            "faces that cross": points[clean[np.unique(crossing)]],
        },
        faulty_edges={
            "holes and borders": points[mesh.edges[mesh.triangles_at == 1]],
            "edges with more than two faces": points[many],
            "sharp edges": points[mesh.edges[mesh.sharp_edges(SHARP)]],
        },
    )


def _refusal(vertices: Array, faces: Faces, deadline: Deadline) -> str | None:
    try:
        mesh_surface(vertices, faces, deadline=deadline)
    except InputError as error:
        return str(error)
    return None


def _places(points: Array) -> tuple[Place, ...]:
    return tuple(map(tuple, points.tolist()))


def _components(part: Index, mesh: TriangleMesh) -> tuple[Component, ...]:
    sizes, areas = np.bincount(part), np.bincount(part, mesh.areas)
    open_: Mask = (mesh.triangles_at[mesh.edge_of_side] != 2).any(axis=1)
    opened = np.bincount(part, open_) > 0
    order = np.argsort(-areas, kind="stable").tolist()
    return tuple(Component(int(sizes[k]), float(areas[k]), not opened[k]) for k in order)


def _holes(mesh: TriangleMesh) -> tuple[Hole, ...]:
    border, group = border_groups(mesh)
    number, total = np.bincount(group), np.bincount(group, mesh.lengths[border])
    middles = mesh.points[mesh.edges[border]].mean(axis=1)
    place = np.column_stack([np.bincount(group, axis) for axis in middles.T]) / number[:, None]
    order = np.argsort(-total, kind="stable").tolist()
    return tuple(Hole(float(total[k]), int(number[k]), tuple(place[k].tolist())) for k in order)


def _crossing_places(mesh: TriangleMesh, pairs: Index) -> tuple[Place, ...]:
    """The middles of the smaller face of each pair."""
    smaller = np.take_along_axis(pairs, np.argmin(mesh.areas[pairs], axis=1)[:, None], axis=1)
    return _places(mesh.points[mesh.corners[smaller[:, 0]]].mean(axis=1))


def note_on_crossings(mesh: TriangleMesh) -> tuple[str, ...]:
    """A sentence if faces cross: how many, and where."""
    pairs = crossing_pairs(mesh.points, mesh.corners)
    if not len(pairs):
        return ()
    place = _at(_crossing_places(mesh, pairs[:1])[0])
    where = f"{'the first' if len(pairs) > 1 else 'it is'} at {place} m in the part's own frame"
    return (
        f"{count(len(pairs), 'pair')} of the part's faces cross, {where}: near there the tool "
        "may be judged by the face that it is not on; cellcolor inspect lists such places",
    )


def _at(place: Sequence[float]) -> str:
    return in_words(np.array(place))
