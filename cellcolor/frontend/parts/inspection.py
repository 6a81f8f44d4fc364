"""Contents and faults of a mesh, in numbers and places, as a value that prints itself.

Faces that cross each other are found by a grid, then by testing every side against every face.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.cleaning import (
    against_the_others,
    border_groups,
    fans,
    flat_faces,
    inside_out,
    merged,
    repeated_corners,
    repeated_faces,
    turned,
)
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.mesh_file import UNITS, likely_unit
from cellcolor.frontend.parts.repaired import check_known_size, in_words
from cellcolor.frontend.parts.repairing import Mending, Telling, mended
from cellcolor.frontend.parts.surface import SHARP, Faces
from cellcolor.memory import chunks
from cellcolor.mesh.triangle_mesh import TriangleMesh

Place = tuple[float, float, float]


@dataclass(frozen=True)
class Hole:
    """Connected border edges.

    Attributes:
        length_m: of all of them.
        edges: how many.
        place: the middle of their ends, m.
    """

    length_m: float
    edges: int
    place: Place


@dataclass(frozen=True)
class Component:
    """Faces connected by edges.

    Attributes:
        faces: how many.
        area_m2: of them.
        closed: whether each of their edges has two faces.
    """

    faces: int
    area_m2: float
    closed: bool


@dataclass(frozen=True)
class FaultyPlaces:
    """Where faults are, for pictures: points in m.

    Attributes:
        faces: by the fault's name, (k, 3, 3) corners of faces.
        edges: by the fault's name, (k, 2, 3) ends of edges.
        sharp: (k, 2, 3) ends of sharp edges, which are no fault.
    """

    faces: dict[str, Array]
    edges: dict[str, Array]
    sharp: Array


@dataclass(frozen=True)
class MeshFacts:
    """A mesh in numbers; places in m.

    Attributes:
        triangles, vertices: how many; vertices that no face has are not counted.
        unused_vertices: those.
        merged_vertices: how many are in one place with an earlier one.
        low_m, high_m: corners of the bounding box.
        area_m2: of all faces.
        components: from the largest area to the smallest.
        holes: from the longest border to the shortest.
        non_manifold_edges, non_manifold_vertices: places of edges with more than two faces, and of
            vertices on no such edge whose faces form several fans.
        duplicate_faces: how many have the corners of an earlier one.
        flat_faces: how many have no area.
        mixed_winding: how many faces wind against those around them.
        one_sided: whether no winding fits, as on a Moebius strip.
        inside_out: how many closed components have a negative volume.
        crossings: places of pairs of faces that cross; None if the search was too expensive.
        edge_lengths_m: least, lower quartile, median, upper quartile, greatest.
        sharp_edges: how many, with faces that turn by 30 degrees or more.
        sharp_length_m: of them.
        genus: the number of handles of a manifold mesh; None for any other.
        refusal: why a scene could not use the mesh as it is; None if it could.
    """

    triangles: int
    vertices: int
    unused_vertices: int
    merged_vertices: int
    low_m: Place
    high_m: Place
    area_m2: float
    components: tuple[Component, ...]
    holes: tuple[Hole, ...]
    non_manifold_edges: tuple[Place, ...]
    non_manifold_vertices: tuple[Place, ...]
    duplicate_faces: int
    flat_faces: int
    mixed_winding: int
    one_sided: bool
    inside_out: int
    crossings: tuple[Place, ...] | None
    edge_lengths_m: tuple[float, float, float, float, float]
    sharp_edges: int
    sharp_length_m: float
    genus: int | None
    refusal: str | None
    places: FaultyPlaces = field(compare=False, repr=False)


def facts_of(
    vertices: Array,
    faces: Faces,
    deadline: Deadline = NEVER,
    tell: Telling = lambda _: None,
) -> MeshFacts:
    """Inspect a mesh, whatever is wrong with it.

    Before topology is inspected, vertices in one place are merged, and duplicate faces and faces
    without area left out, as a repair would do first.

    Args:
        vertices: (n, 3) in m.
        tell: told what is being looked at.

    Raises:
        InputError: coordinates that are not finite, a face of no vertex, no face with an area.
        OutOfTime: the deadline came first.
    """
    tell("looking for unused faces")
    refusal = _refusal(vertices, faces, deadline)
    there = len(np.unique(faces))
    points, clean = merged(vertices, faces)
    twins = there - len(points)
    clean = clean[~repeated_corners(clean)]
    folded = len(faces) - len(clean)
    twice = repeated_faces(clean)
    double, clean = clean[twice], clean[~twice]
    flat = flat_faces(points, clean)
    thin, clean = clean[flat], clean[~flat]
    if not len(clean):
        raise InputError(None, "faces", "none has an area")
    deadline.check()
    tell("looking at edges and components")
    mesh = TriangleMesh(points, clean)
    part, area = mesh.parts(), mesh.areas
    open_ = (mesh.triangles_at[mesh.edge_of_side] != 2).any(axis=1)
    turn, one_sided = against_the_others(mesh)
    wrong = inside_out(TriangleMesh(points, turned(clean, turn)))
    holes = _holes(mesh)
    many = mesh.edges[mesh.triangles_at > 2]
    split = _several_fans(mesh)
    tell("looking for faces that cross")
    crossing = crossing_pairs(points, clean, deadline)
    deadline.check()
    tell("measuring edges")
    sharp = mesh.sharp_edges(SHARP)
    manifold = not (len(many) or len(split))
    crossed = np.zeros((0, 2), dtype=np.int64) if crossing is None else crossing
    places = FaultyPlaces(
        {
            "faces there twice": points[double],
            "faces without area": points[thin],
            "faces wound against their neighbors": points[clean[turn]],
            "closed components inside out": points[clean[wrong]],
            "faces that cross": points[clean[np.unique(crossed)]],
        },
        {
            "holes and borders": points[mesh.edges[mesh.triangles_at == 1]],
            "edges with more than two faces": points[many],
        },
        points[mesh.edges[sharp]],
    )
    return MeshFacts(
        len(faces),
        there,
        len(vertices) - there,
        twins,
        _place(points.min(axis=0)),
        _place(points.max(axis=0)),
        float(area.sum()),
        _components(part, area, open_),
        holes,
        tuple(map(_place, points[many].mean(axis=1))),
        tuple(map(_place, points[split])),
        len(double),
        len(thin) + folded,
        int(turn.sum()),
        bool(one_sided.any()),
        len(np.unique(part[wrong])),
        None if crossing is None else _crossing_places(mesh, crossing),
        tuple(np.percentile(mesh.lengths, [0, 25, 50, 75, 100]).tolist()),
        len(sharp),
        float(mesh.lengths[sharp].sum()),
        # By Euler's formula: handles of all components together.
        (2 * (int(part.max()) + 1) - len(holes) - mesh.euler) // 2 if manifold else None,
        refusal,
        places,
    )


def _refusal(vertices: Array, faces: Faces, deadline: Deadline) -> str | None:
    try:
        mesh_surface(vertices, faces, deadline=deadline)
    except InputError as error:
        return f"{error.field}: {error.message}" if error.field else error.message
    return None


def _place(point: Array) -> Place:
    x, y, z = point.tolist()
    return x, y, z


def _components(part: Index, area: Array, open_: Mask) -> tuple[Component, ...]:
    sizes, areas = np.bincount(part), np.bincount(part, area)
    opened = np.bincount(part, open_) > 0
    order = np.argsort(-areas, kind="stable").tolist()
    return tuple(Component(int(sizes[k]), float(areas[k]), not opened[k]) for k in order)


def _holes(mesh: TriangleMesh) -> tuple[Hole, ...]:
    border, group = border_groups(mesh)
    if not len(border):
        return ()
    count, total = np.bincount(group), np.bincount(group, mesh.lengths[border])
    middle = np.column_stack(
        [
            np.bincount(group, mesh.points[mesh.edges[border], axis].mean(axis=1)) / count
            for axis in range(3)
        ]
    )
    order = np.argsort(-total, kind="stable").tolist()
    return tuple(Hole(float(total[k]), int(count[k]), _place(middle[k])) for k in order)


def _several_fans(mesh: TriangleMesh) -> Index:
    """Vertices on no edge of three faces and more around which the faces form several fans."""
    fan = fans(mesh.corners, mesh.pairs[1]).ravel()
    _, first = np.unique(fan, return_index=True)
    vertex, count = np.unique(mesh.corners.ravel()[first], return_counts=True)
    several = vertex[count > 1]
    return several[~np.isin(several, mesh.edges[mesh.triangles_at > 2])]


def _crossing_places(mesh: TriangleMesh, pairs: Index) -> tuple[Place, ...]:
    """The middles of the smaller face of each pair."""
    smaller = np.take_along_axis(pairs, np.argmin(mesh.areas[pairs], axis=1)[:, None], axis=1)
    return tuple(map(_place, mesh.points[mesh.corners[smaller[:, 0]]].mean(axis=1)))


MOST_FACES = 200_000  # more are not looked at
_MOST_PLACES = 10_000_000  # cells of the grid that all faces together are entered in
_PAIR = 640  # bytes that two faces take
_INSIDE = 1e-7  # by this share of a side or face a crossing has to be off its ends


def crossing_pairs(vertices: Array, faces: Faces, deadline: Deadline = NEVER) -> Index | None:
    """Pairs of faces (p, 2), the smaller number first, of which one crosses the other.

    A side of one goes through the inside of the other. Faces that share an edge are no such pair,
    and faces that lie in one plane and overlap are not found.

    Returns:
        None if there are too many faces, or they are too uneven in size, for that to be affordable.

    Raises:
        OutOfTime: the deadline came first.
    """
    if len(faces) > MOST_FACES:
        return None
    corners = vertices[faces]
    low, high = corners.min(axis=1), corners.max(axis=1)
    size = float(2 * np.median((high - low).max(axis=1)))
    first = np.floor((low - low.min(axis=0)) / size).astype(np.int64)
    spans = np.floor((high - low.min(axis=0)) / size).astype(np.int64) - first + 1
    entries = spans.prod(axis=1)
    if entries.sum() > _MOST_PLACES:
        return None
    face = np.repeat(np.arange(len(faces)), entries)
    rank = np.arange(len(face)) - np.repeat(np.cumsum(entries) - entries, entries)
    cell = first[face]
    for axis in (2, 1, 0):
        rank, step = np.divmod(rank, spans[face, axis])
        cell[:, axis] += step
    counts = cell.max(axis=0) + 1
    key = np.ravel_multi_index(tuple(cell.T), tuple(counts))
    order = np.argsort(key, kind="stable")
    key, face = key[order], face[order]
    found = []
    offset, rows = 1, np.arange(len(key))
    while True:
        rows = rows[rows + offset < len(key)]
        rows = rows[key[rows] == key[rows + offset]]
        if not len(rows):
            break
        for part in chunks(len(rows), _PAIR):
            deadline.check()
            some = rows[part]
            pairs = np.column_stack([face[some], face[some + offset]])
            found.append(_crossing(vertices, faces, low, high, pairs))
        offset += 1
    both = np.sort(np.concatenate([np.zeros((0, 2), dtype=np.int64), *found]), axis=1)
    return np.unique(both, axis=0)


def _crossing(vertices: Array, faces: Faces, low: Array, high: Array, pairs: Index) -> Index:
    """Those of some pairs of faces that cross."""
    a, b = pairs.T
    near = ((low[a] <= high[b]) & (low[b] <= high[a])).all(axis=1)
    pairs = pairs[near]
    a, b = pairs.T
    shared = (faces[a][:, :, None] == faces[b][:, None, :]).sum(axis=(1, 2))
    pairs = pairs[shared < 2]
    hit = np.zeros(len(pairs), dtype=bool)
    for one, other in ((0, 1), (1, 0)):
        triangle = vertices[faces[pairs[:, other]]]
        for corner in range(3):
            start = vertices[faces[pairs[:, one], corner]]
            end = vertices[faces[pairs[:, one], (corner + 1) % 3]]
            hit |= _through(start, end, triangle)
    return pairs[hit]


def _through(start: Array, end: Array, triangle: Array) -> Mask:
    """Whether segments (k, 3) go through the insides of triangles (k, 3, 3).

    After Moeller and Trumbore, "Fast, minimum storage ray-triangle intersection", 1997.
    """
    way, origin = end - start, triangle[:, 0]
    u_side, v_side = triangle[:, 1] - origin, triangle[:, 2] - origin
    normal = np.cross(way, v_side)
    volume = np.einsum("ij,ij->i", u_side, normal)
    scale = np.linalg.norm(way, axis=1) * np.linalg.norm(np.cross(u_side, v_side), axis=1)
    level = np.abs(volume) <= 1e-9 * scale
    safe = np.where(level, 1.0, volume)
    off = start - origin
    u = np.einsum("ij,ij->i", off, normal) / safe
    other = np.cross(off, u_side)
    v = np.einsum("ij,ij->i", way, other) / safe
    t = np.einsum("ij,ij->i", v_side, other) / safe
    inside = np.minimum(np.minimum(u, v), np.minimum(1 - u - v, np.minimum(t, 1 - t)))
    return np.asarray(~level & (inside > _INSIDE))


_SHOWN = 3  # places of one fault in a printed inspection
_STORED = 100  # places of one fault in a JSON document


@dataclass(frozen=True, eq=False)
class Inspection:
    """An inspected mesh.

    Attributes:
        name: of its file, or what it is.
        unit: of its coordinates: ``m``, ``mm``, ``cm`` or ``in``.
        unit_reason: why; for a given unit, that it was given.
        facts: what it has and what is wrong with it.
        repairs: what a repair would change, without filling holes or remeshing.
        refusal: why the mesh could not be used after that; None if it could.
        vertices: (n, 3) in m.
        faces: (m, 3).
    """

    name: str
    unit: str
    unit_reason: str
    facts: MeshFacts
    repairs: tuple[str, ...]
    refusal: str | None
    vertices: Array = field(repr=False)
    faces: Faces = field(repr=False)

    def to_dict(self) -> dict[str, Any]:
        """Everything except the mesh, JSON-able; the first hundred places of each kind."""
        facts = asdict(
            replace(self.facts, places=FaultyPlaces({}, {}, self.facts.places.sharp[:0]))
        )
        del facts["places"]
        counted = ("components", "holes", "non_manifold_edges", "non_manifold_vertices")
        for key in (*counted, "crossings"):
            found = facts[key]
            if found is not None:
                facts[key] = {"count": len(found), "first": list(found[:_STORED])}
        return {
            "name": self.name,
            "unit": self.unit,
            "unit_reason": self.unit_reason,
            **facts,
            "repairs": list(self.repairs),
            "refusal_after_repair": self.refusal,
        }

    def __str__(self) -> str:
        facts = self.facts
        size = " x ".join(
            f"{high - low:.4g}" for low, high in zip(facts.low_m, facts.high_m, strict=True)
        )
        low = ", ".join(f"{x:.4g}" for x in facts.low_m)
        edges = [f"{1e3 * length:.3g}" for length in facts.edge_lengths_m]
        rows = [
            ("triangles", f"{facts.triangles:,}, {facts.vertices:,} vertices"),
            ("unit", f"{self.unit}: {self.unit_reason}"),
            ("size", f"{size} m from ({low}) m, area {facts.area_m2:.4g} m^2"),
            (
                "edges",
                f"{edges[0]} to {edges[4]} mm, quartiles {edges[1]}, {edges[2]}, {edges[3]} mm",
            ),
            ("sharp edges", self._sharp()),
            ("components", self._components()),
            ("genus", "of a manifold only" if facts.genus is None else f"{facts.genus}"),
        ]
        rows += [(name, text) for name, text in self._faults() if text]
        ready = "yes" if facts.refusal is None else f"no: {facts.refusal}"
        rows.append(("usable as it is", ready))
        lines = [self.name, *(f"  {name:<16} {text}" for name, text in rows)]
        lines += [
            "  repair would",
            *(f"    {change}" for change in self.repairs or ("change nothing",)),
        ]
        end = "usable" if self.refusal is None else f"still not usable: {self.refusal}"
        return "\n".join([*lines, f"  and then it is {end}"])

    def _sharp(self) -> str:
        facts = self.facts
        if not facts.sharp_edges:
            return "none of 30 degrees or more"
        return f"{facts.sharp_edges:,} of 30 degrees or more, {facts.sharp_length_m:.3g} m"

    def _components(self) -> str:
        first = ", ".join(
            f"{own.faces:,} faces {'closed' if own.closed else 'open'}"
            for own in self.facts.components[:_SHOWN]
        )
        more = len(self.facts.components) - _SHOWN
        return (
            f"{len(self.facts.components):,}: {first}{f', and {more:,} more' if more > 0 else ''}"
        )

    def _faults(self) -> list[tuple[str, str]]:
        facts = self.facts
        holes = [f"{1e3 * hole.length_m:.3g} mm long at {_at(hole.place)}" for hole in facts.holes]
        crossings = facts.crossings
        crossing = (
            "not looked for: too many faces, or too uneven"
            if crossings is None
            else (_listed("pair", [_at(place) for place in crossings]))
        )
        return [
            ("holes", _listed("border", holes)),
            (
                "non-manifold",
                _listed("edge", list(map(_at, facts.non_manifold_edges)), " of 3 faces or more"),
            ),
            (
                "non-manifold",
                _listed("vertex", list(map(_at, facts.non_manifold_vertices)), " not manifold"),
            ),
            ("twins", _some(facts.merged_vertices, "vertex", "in the same place as another")),
            ("unused", _some(facts.unused_vertices, "vertex", "without a face")),
            ("duplicates", _some(facts.duplicate_faces, "face", "there twice")),
            ("flat", _some(facts.flat_faces, "face", "without area")),
            ("winding", _some(facts.mixed_winding, "face", "against those around")),
            (
                "one-sided",
                "a component has no outside, as a Moebius strip" if facts.one_sided else "",
            ),
            ("inside out", _some(facts.inside_out, "closed component", "with a negative volume")),
            ("crossings", crossing),
        ]


def inspect_mesh(
    name: str,
    vertices: Array,
    faces: Faces,
    unit: str | None = None,
    deadline: Deadline = NEVER,
    tell: Telling = lambda _: None,
) -> Inspection:
    """Inspect a mesh, and say what a repair would do.

    Args:
        name: of the file, or what it is.
        vertices: (n, 3) in its unit.
        faces: (m, 3).
        unit: ``m``, ``mm``, ``cm`` or ``in``; None takes the likely one, meters where that is open.
        deadline: when to give up.
        tell: told what is being looked at.

    Raises:
        InputError: it cannot be looked through: coordinates that are not finite, a face of no
            vertex, no face with an area, too many faces, no such unit.
        OutOfTime: the deadline came first.
    """
    check_known_size(len(faces))
    if unit is not None and unit not in UNITS:
        raise InputError(None, "unit", f"must be one of {', '.join(UNITS)}, is {unit!r}")
    if not len(faces):
        raise InputError(None, "faces", "there are none")
    reason = "as given"
    if unit is None:
        with np.errstate(invalid="ignore"):
            likely, reason = likely_unit(float(np.ptp(vertices, axis=0).max()))
        unit = likely or "m"
    points = np.asarray(vertices, dtype=np.float64) * UNITS[unit]
    # First the repair: what makes it impossible makes an inspection impossible.
    refusal, repairs = None, []
    try:
        made, new, changes = mended(points, faces, Mending(), deadline, tell)
        repairs = [in_words(change) for change in changes]
        mesh_surface(made, new, deadline=deadline)
    except InputError as error:
        refusal = str(error)
    facts = facts_of(points, faces, deadline, tell)
    return Inspection(name, unit, reason, facts, tuple(repairs), refusal, points, faces)


def _at(place: Sequence[float]) -> str:
    return f"({', '.join(f'{x:.4g}' for x in place)})"


def _listed(one: str, places: list[str], what: str = "") -> str:
    """How many, and the first places."""
    if not places:
        return ""
    many = f"{len(places):,} {'vertices' if one == 'vertex' else one + 's'}"
    number = f"1 {one}" if len(places) == 1 else many
    more = f", and {len(places) - _SHOWN:,} more" if len(places) > _SHOWN else ""
    return f"{number}{what}: {', '.join(places[:_SHOWN])}{more}"


def _some(number: int, one: str, what: str) -> str:
    if not number:
        return ""
    if one == "vertex" and number > 1:
        return f"{number:,} vertices {what}"
    return f"{count(number, one)} {what}"
