"""A mesh with a class per vertex as a picture: fills, borders, cracks, numbers.

A class owns the barycentric dual of its vertices, as in the decomposition: a triangle with
different classes at its corners is cut from its center to the middles of its edges.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array
from cellcolor.data.surface import LabelledSurface
from cellcolor.pictures.palette import INK, WARNING
from cellcolor.pictures.picture import Layer, Picture3D, SpaceLines, Text

Labels = NDArray[np.int64]


@dataclass(frozen=True)
class VertexClass:
    """A class of vertices: its name for the legend, its fill, and a number to write on it."""

    name: str
    rgb: str
    number: str | None = None


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
    """

    title: str
    labels: Labels
    classes: Sequence[VertexClass]
    borders: Labels | None = None
    cracks: Collection[tuple[int, int]] = ()
    notes: tuple[str, ...] = ()


def draw_surface(surface: LabelledSurface, view: SurfaceView) -> Picture3D:
    """The surface as the view wants it."""
    vertices, faces = surface.vertices, surface.faces
    normals = surface.vertex_normals
    points, triangles, owner = mesh_picture_parts(vertices, faces, view.labels)
    layers = []
    for number, own_class in enumerate(view.classes):
        own = triangles[owner == number]
        if len(own):
            used, renumbered = np.unique(own, return_inverse=True)
            layers.append(
                Layer(own_class.name, own_class.rgb, points[used], renumbered.reshape(own.shape))
            )
    bordered = view.labels if view.borders is None else view.borders
    segments = _lines(vertices, faces, normals, bordered, set(view.cracks))
    return Picture3D(
        title=view.title,
        layers=tuple(layers),
        lines=segments,
        texts=tuple(_numbers(surface, view, normals)),
        notes=view.notes,
        towards=_towards(normals),
    )


def mesh_picture_parts(
    vertices: Array, faces: Labels, labels: Labels
) -> tuple[Array, Labels, Labels]:
    """Cut a mesh along the borders of its vertex classes.

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
    mixed = faces[~whole]
    middles = (vertices[mixed] + vertices[np.roll(mixed, -1, axis=1)]) / 2
    centers = vertices[mixed].mean(axis=1)
    points = np.concatenate([vertices, middles.reshape(-1, 3), centers])
    # Middle e of a face lies between its corners e and e + 1.
    middle = len(vertices) + np.arange(3 * len(mixed)).reshape(-1, 3)
    center = np.repeat(len(vertices) + 3 * len(mixed) + np.arange(len(mixed)), 3).reshape(-1, 3)
    after = np.stack([mixed, middle, center], axis=2).reshape(-1, 3)
    before = np.stack([mixed, center, np.roll(middle, 1, axis=1)], axis=2).reshape(-1, 3)
    pieces = labels[mixed].ravel()
    return (
        points,
        np.concatenate([faces[whole], after, before]),
        np.concatenate([corner[whole, 0], pieces, pieces]),
    )


def _lines(
    vertices: Array,
    faces: Labels,
    normals: Array,
    classes: Labels,
    cracks: set[tuple[int, int]],
) -> tuple[SpaceLines, ...]:
    """Borders and cracks, lifted off the surface by a little so that they stay visible."""
    ends: dict[str, list[Array]] = {"border": [], "crack": []}
    edge = float(np.linalg.norm(vertices[faces[:, 0]] - vertices[faces[:, 1]], axis=1).mean())
    lifted = vertices + 0.03 * edge * normals
    centers = lifted[faces].mean(axis=1)
    for start in range(3):
        a, b = faces[:, start], faces[:, (start + 1) % 3]
        middles = (lifted[a] + lifted[b]) / 2
        cracked = np.array(
            [(i, j) in cracks or (j, i) in cracks for i, j in zip(a, b, strict=True)], dtype=bool
        )
        border = (classes[a] != classes[b]) & ~cracked
        for name, rows in (("border", border), ("crack", cracked)):
            ends[name].append(np.stack([middles[rows], centers[rows]], axis=1))
    colors = {"border": INK, "crack": WARNING}
    return tuple(
        SpaceLines(name, colors[name], np.concatenate(pieces))
        for name, pieces in ends.items()
        if any(map(len, pieces))
    )


def _numbers(surface: LabelledSurface, view: SurfaceView, normals: Array) -> list[Text]:
    """The number of each class at the vertex deepest inside of it."""
    labels = view.labels
    depth = _depth(surface, labels)
    texts = []
    for label, own_class in enumerate(view.classes):
        own = np.flatnonzero(labels == label)
        if own_class.number is None or not len(own):
            continue
        deepest = own[depth[own] == depth[own].max()]
        middle = surface.vertices[own].mean(axis=0)
        offsets = np.linalg.norm(surface.vertices[deepest] - middle, axis=1)
        vertex = deepest[np.argmin(offsets)]
        texts.append(Text(own_class.number, surface.vertices[vertex], normals[vertex]))
    return texts


def _depth(surface: LabelledSurface, labels: Labels) -> Labels:
    """Mesh edges from each vertex to the nearest border of its class or of the mesh."""
    first, second = surface.mesh.edges.T
    depth = np.full(len(labels), -1, dtype=np.int64)
    depth[surface.mesh.border] = 0
    depth[surface.mesh.edges[labels[first] != labels[second]]] = 0
    if not (depth == 0).any():
        return np.zeros(len(labels), dtype=np.int64)
    level = 0
    while (depth < 0).any():
        for a, b in ((first, second), (second, first)):
            depth[b[(depth[a] == level) & (depth[b] < 0)]] = level + 1
        level += 1
        if not (depth == level).any():  # a part of the surface with one class and without a rim
            depth[depth < 0] = 0
    return depth


def _towards(normals: Array) -> Array:
    """Where to look from: before the outside of the surface, and from above rather than flat."""
    mean = normals.mean(axis=0)
    flat = np.array([mean[0], mean[1], 0.0])
    if np.linalg.norm(flat) < 0.2:
        flat = np.array([0.5, -0.866, 0.0])
    flat /= np.linalg.norm(flat)
    upright = float(np.linalg.norm(mean)) > 0.2
    elevation = np.arcsin(mean[2] / np.linalg.norm(mean)) if upright else np.radians(30)
    elevation = np.clip(elevation, np.radians(-75), np.radians(75))
    if abs(elevation) < np.radians(20):
        elevation = np.radians(20)
    towards: Array = np.cos(elevation) * flat + np.array([0.0, 0.0, np.sin(elevation)])
    return towards
