"""A mesh as a picture: a surface with a class for each vertex, or a part with its faults marked."""

from __future__ import annotations

import textwrap
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from cellcolor.arrays import Array, Index
from cellcolor.data.surface import LabelledSurface
from cellcolor.frontend.parts.inspection import Inspection
from cellcolor.mesh.dividing import small_triangles
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.pictures.picture import (
    FAINT,
    ClassedMesh,
    Layer,
    Line,
    Picture3D,
    SpaceLines,
    Text,
    VertexClass,
)

_MOST_NUMBERS = 80  # more would lie on each other


@dataclass(frozen=True)
class SurfaceView:
    """What is to be seen on a surface.

    Attributes:
        title: one line.
        labels: (n,) the class of each vertex, an index of ``classes``.
        classes: those without any vertex are left out of the picture.
        borders: (n,) vertex classes between which black lines run; None takes ``labels``.
        cracks: mesh edges to mark, as pairs of vertices.
        notes: lines under the legend.
        marked: vertices to be pointed at; the borders of their classes are marked as well.
    """

    title: str
    labels: Index
    classes: Sequence[VertexClass]
    borders: Index | None = None
    cracks: Collection[tuple[int, int]] = ()
    notes: tuple[str, ...] = ()
    marked: Sequence[int] = ()


def draw_surface(surface: LabelledSurface, view: SurfaceView) -> Picture3D:
    """The surface as the view wants it: with its classes, and with lines between them."""
    first, second = surface.mesh.edges.T
    borders = view.labels if view.borders is None else view.borders
    out = np.isin(view.labels, view.labels[list(view.marked)])
    lines = np.where(borders[first] != borders[second], Line.BORDER, Line.NONE)
    differs = view.labels[first] != view.labels[second]
    lines[differs & (out[first] | out[second])] = Line.MARKED
    if view.cracks:
        lines[surface.mesh.marked(view.cracks)] = Line.CRACK
    of_sides = lines[surface.mesh.edge_of_side].astype(np.uint8)
    normals = surface.vertex_normals
    marks = [
        Text(f"vertex {vertex}", surface.vertices[vertex], normals[vertex])
        for vertex in view.marked
    ]
    return Picture3D(
        title=view.title,
        mesh=ClassedMesh(surface.vertices, surface.faces, view.labels, view.classes, of_sides),
        layers=(),
        lines=(),
        texts=(*_numbers(surface, view), *marks),
        notes=view.notes,
        towards=eye(surface),
    )


def mesh_picture_parts(vertices: Array, faces: Index, labels: Index) -> tuple[Array, Index, Index]:
    """Cut a mesh along the borders of its vertex classes.

    A triangle with different classes at its corners is cut from its center to the middles of its
    sides, as in the decomposition.

    Args:
        vertices: (n, 3).
        faces: (m, 3).
        labels: (n,).

    Returns:
        points (k, 3), the first n the vertices; triangles (t, 3), wound like the faces; the class
        of each triangle (t,).
    """
    corner = labels[faces]
    whole = (corner == corner[:, :1]).all(axis=1)
    small, _ = small_triangles(TriangleMesh(vertices, faces[~whole]))
    return (
        small.points,
        np.concatenate([faces[whole], small.corners]),
        np.concatenate([corner[whole, 0], np.repeat(corner[~whole].ravel(), 2)]),
    )


def _numbers(surface: LabelledSurface, view: SurfaceView) -> list[Text]:
    """The number of each class, the largest ones first, at the vertex deepest inside of it."""
    labels = view.labels
    depth = _depth(surface, labels)
    sizes = np.bincount(labels, minlength=len(view.classes))
    numbered = [k for k in np.argsort(-sizes) if sizes[k] and view.classes[k].number is not None]
    texts = []
    for label in sorted(numbered[:_MOST_NUMBERS]):
        own = np.flatnonzero(labels == label)
        deepest = own[depth[own] == depth[own].max()]
        middle = surface.vertices[own].mean(axis=0)
        offsets = np.linalg.norm(surface.vertices[deepest] - middle, axis=1)
        vertex = deepest[np.argmin(offsets)]
        normal = surface.vertex_normals[vertex]
        number = str(view.classes[label].number)
        texts.append(Text(number, surface.vertices[vertex], normal, int(label)))
    return texts


def _depth(surface: LabelledSurface, labels: Index) -> Array:
    """Mesh edges from each vertex to the nearest border of its class or of the mesh."""
    first, second = surface.mesh.edges.T
    borders = surface.mesh.edges[labels[first] != labels[second]]
    starts = np.union1d(np.flatnonzero(surface.mesh.border), borders.ravel())
    graph = csr_array((np.ones(len(first)), (first, second)), shape=(len(labels), len(labels)))
    if not len(starts):
        return np.zeros(len(labels))
    depth = dijkstra(graph, directed=False, indices=starts, unweighted=True, min_only=True)
    # A part of the surface with one class and without a rim has no depth.
    return np.where(np.isfinite(depth), depth, 0)


def eye(
    surface: LabelledSurface,
    rises: Sequence[float] = (28, 40, 65, -30),
    seen_past: Sequence[tuple[Array, Array, Array]] = (),
) -> Array:
    """A unit vector from the scene to the eye, so that most of the part's outside is seen.

    Of 24 directions around the vertical. Those in which an arm at the origin hides the part, or the
    part the arm, lose points, and so do those from below.

    Args:
        rises: the heights to look from, degrees.
        seen_past: places (3,) that are to be seen, each with its normal (3,) and with points
            (k, 3) of an arm that may hide it.
    """
    normals, middle = surface.vertex_normals, surface.vertices.mean(axis=0)
    away = middle[:2] / max(float(np.linalg.norm(middle[:2])), 1e-9)
    around = np.tile(np.radians(np.arange(0, 360, 15)), len(rises))
    rise = np.repeat(np.radians(rises), 24)
    flat = np.stack([np.cos(around), np.sin(around)], axis=1)
    eyes = np.column_stack([np.cos(rise)[:, None] * flat, np.sin(rise)])
    seen = np.maximum(eyes @ normals.T, 0).mean(axis=1)
    score = seen - 0.15 * np.abs(flat @ away) + 0.05 * (flat @ away) - 0.2 * (rise < 0)
    for place, normal, points in seen_past:
        ways = points - place
        along = ways @ eyes.T
        aside = (ways**2).sum(axis=1, keepdims=True) - along**2
        hidden = ((along > 0.1) & (aside < 0.06**2)).any(axis=0) | (eyes @ normal < 0.1)
        score -= hidden / len(seen_past)
    return np.asarray(eyes[np.argmax(score)])


_MOST = 60_000  # faces drawn; a larger part is thinned evenly to this many
_MOST_MARKS = 20_000  # of one kind of fault
_FILLS = ("#EE6677", "#AA3377", "#4477AA", "#228833", "#CCBB44")  # of faulty faces
_LINES = ("#D55E00", "#CC0000", "#555555")  # holes, edges with more than two faces, sharp ones
_WIDTH = 60  # characters a line of a note, all that fits beside the picture


def faulty_part(inspection: Inspection) -> Picture3D:
    """The part, its sharp edges, and each kind of fault in a color of its own."""
    faces, notes = inspection.mesh.corners, []
    if len(faces) > _MOST:
        notes.append(f"{_MOST:,} of {len(faces):,} faces are drawn.")
        faces = faces[np.linspace(0, len(faces) - 1, _MOST).astype(np.int64)]
    used, number = np.unique(faces, return_inverse=True)
    corners_of = number.reshape(-1, 3).astype(np.int64)
    layers = [Layer("part", FAINT, inspection.mesh.points[used], corners_of)]
    for (name, corners), fill in zip(inspection.faulty_faces.items(), _FILLS, strict=True):
        if len(corners):
            some = corners[:_MOST_MARKS]
            own = np.arange(3 * len(some)).reshape(-1, 3)
            layers.append(Layer(f"{name}: {len(corners):,}", fill, some.reshape(-1, 3), own))
    lines = []
    for (name, ends), fill in zip(inspection.faulty_edges.items(), _LINES, strict=True):
        if len(ends):
            lines.append(SpaceLines(f"{name}: {len(ends):,} edges", fill, ends[:_MOST_MARKS]))
    usable = inspection.refusal is None
    text = "Usable unchanged." if usable else f"Not usable unchanged: {inspection.refusal}"
    notes += textwrap.wrap(text, _WIDTH)
    eye = np.array([1.0, -1.6, 1.1])
    return Picture3D(
        title=inspection.name if usable else f"{inspection.name}: what is wrong with it",
        mesh=None,
        layers=tuple(layers),
        lines=tuple(lines),
        texts=(),
        notes=tuple(notes),
        towards=eye / np.linalg.norm(eye),
    )
