"""Contents and faults of a mesh, in numbers and places."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.wording import count as counted
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
from cellcolor.frontend.parts.crossings import crossing_pairs
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.repairing import Telling
from cellcolor.frontend.parts.surface import SHARP, Faces
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
        triangles=len(faces),
        vertices=there,
        unused_vertices=len(vertices) - there,
        merged_vertices=twins,
        low_m=_place(points.min(axis=0)),
        high_m=_place(points.max(axis=0)),
        area_m2=float(area.sum()),
        components=_components(part, area, open_),
        holes=holes,
        non_manifold_edges=tuple(map(_place, points[many].mean(axis=1))),
        non_manifold_vertices=tuple(map(_place, points[split])),
        duplicate_faces=len(double),
        flat_faces=len(thin) + folded,
        mixed_winding=int(turn.sum()),
        one_sided=bool(one_sided.any()),
        inside_out=len(np.unique(part[wrong])),
        crossings=None if crossing is None else _crossing_places(mesh, crossing),
        edge_lengths_m=tuple(np.percentile(mesh.lengths, [0, 25, 50, 75, 100]).tolist()),
        sharp_edges=len(sharp),
        sharp_length_m=float(mesh.lengths[sharp].sum()),
        # By Euler's formula: handles of all components together.
        genus=(2 * (int(part.max()) + 1) - len(holes) - mesh.euler) // 2 if manifold else None,
        refusal=refusal,
        places=places,
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


def note_on_crossings(mesh: TriangleMesh, deadline: Deadline = NEVER) -> tuple[str, ...]:
    """A sentence if faces cross: how many, and where; none if the search is too expensive."""
    pairs = crossing_pairs(mesh.points, mesh.corners, deadline)
    if pairs is None or not len(pairs):
        return ()
    place = ", ".join(f"{x:.4g}" for x in _crossing_places(mesh, pairs[:1])[0])
    where = f"{'the first' if len(pairs) > 1 else 'it is'} at ({place}) m in the part's own frame"
    return (
        f"{counted(len(pairs), 'pair')} of the part's faces cross, {where}: near there the tool "
        "may be judged by the face that it is not on; cellcolor inspect lists such places",
    )
