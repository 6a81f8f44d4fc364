"""Regular triangle meshes of the shapes that random surfaces are drawn on, and cracks over them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, get_args

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.data.surface import Crack

Mesh = tuple[Array, Index]
"""Vertices, (n, 3) in metres, and faces, (m, 3), counter-clockwise seen from outside."""

Topology = Literal["disc", "annulus", "sphere", "torus", "double torus"]
"""What a mesh is as a surface: how many borders and handles it has."""
SHAPES: tuple[Topology, ...] = get_args(Topology)
"""All of them."""


def make_mesh(shape: Topology, size: int) -> Mesh:
    """A mesh of a shape with ``size`` squared vertices or nearly, 1 to 3 m wide.

    Below a size of 6 some shapes are not manifold.
    """
    if shape == "disc":
        y, x = np.mgrid[0:size, 0:size] / (size - 1)
        return _points(x, y, np.zeros_like(x)), grid_faces(size, size)
    if shape == "annulus":
        y, x = np.mgrid[0:size, 0:size]
        radius, angle = 0.2 + 0.3 * x / (size - 1), 2 * np.pi * y / size
        points = _points(radius * np.cos(angle), radius * np.sin(angle), np.zeros_like(radius))
        return points, grid_faces(size, size, wrap_rows=True)
    if shape == "sphere":
        return sphere(max(2, round(size / 2)))
    if shape == "torus":
        return _torus(size)
    return _connected(_torus(round(size / np.sqrt(2))))


def grid_faces(
    rows: int, columns: int, *, wrap_rows: bool = False, wrap_columns: bool = False
) -> Index:
    """Two counter-clockwise triangles for each square of a grid, columns along x, rows along y."""
    row, column = np.mgrid[0 : rows - (not wrap_rows), 0 : columns - (not wrap_columns)]
    here, above = row.ravel() * columns, (row.ravel() + 1) % rows * columns
    left, right = column.ravel(), (column.ravel() + 1) % columns
    lower = np.stack([here + left, here + right, above + right], axis=1)
    upper = np.stack([here + left, above + right, above + left], axis=1)
    return np.stack([lower, upper], axis=1).reshape(-1, 3).astype(np.int64)


def sphere(frequency: int) -> Mesh:
    """A sphere of 1 m across: an octahedron, each face cut in ``frequency`` squared triangles.

    It has 4 frequency² + 2 vertices.
    """
    numbers: dict[tuple[int, int, int], int] = {}
    faces: list[list[int]] = []

    def number(signs: tuple[int, int, int], i: int, j: int) -> int:
        point = (signs[0] * i, signs[1] * j, signs[2] * (frequency - i - j))
        return numbers.setdefault(point, len(numbers))

    for signs in ((x, y, z) for x in (1, -1) for y in (1, -1) for z in (1, -1)):
        turned = signs[0] * signs[1] * signs[2]
        for i in range(frequency):
            for j in range(frequency - i):
                a, b, c = (number(signs, *at) for at in ((i, j), (i + 1, j), (i, j + 1)))
                faces.append([a, b, c][::turned])
                if i + j < frequency - 1:
                    faces.append([b, number(signs, i + 1, j + 1), c][::turned])
    vertices = np.array(list(numbers), dtype=np.float64)
    vertices *= 0.5 / np.linalg.norm(vertices, axis=1, keepdims=True)
    return vertices, np.array(faces, dtype=np.int64)


def _torus(size: int) -> Mesh:
    """A torus, 0.6 and 0.25 m its two radii; vertex 0 lies outermost on the x axis."""
    row, column = np.mgrid[0:size, 0:size]
    around, tube = 2 * np.pi * column / size, 2 * np.pi * row / size
    radius = 0.6 + 0.25 * np.cos(tube)
    points = _points(radius * np.cos(around), radius * np.sin(around), 0.25 * np.sin(tube))
    return points, grid_faces(size, size, wrap_rows=True, wrap_columns=True)


def _connected(mesh: Mesh) -> Mesh:
    """Two copies of a closed mesh, a tube between them where each had its vertex 0."""
    vertices, faces = mesh
    count = len(vertices)
    following = {}
    for face in faces[(faces == 0).any(axis=1)].tolist():
        turn = face.index(0)
        following[face[(turn + 1) % 3]] = face[(turn + 2) % 3]
    rim = [min(following)]
    while following[rim[-1]] != rim[0]:
        rim.append(following[rim[-1]])
    # The copy is turned half about z, so that its vertex 0 faces that of the original.
    other = vertices * (-1.0, -1.0, 1.0) + (2 * vertices[:, 0].max() + 0.2, 0.0, 0.0)
    n = len(rim)
    # The rims run against each other; they are paired where they lie nearest.
    pairs = min(
        ([rim[(start - i) % n] for i in range(n)] for start in range(n)),
        key=lambda mates: float(np.linalg.norm(vertices[rim] - other[mates], axis=1).sum()),
    )
    mates = [mate + count for mate in pairs]
    tube = []
    for i in range(n):
        after = (i + 1) % n
        tube.append([rim[i], rim[after], mates[after]])
        tube.append([rim[i], mates[after], mates[i]])
    kept = faces[(faces != 0).all(axis=1)]
    joined = np.vstack([kept, kept + count, np.array(tube, dtype=np.int64)])
    used, renumbered = np.unique(joined, return_inverse=True)
    return np.vstack([vertices, other])[used], renumbered.reshape(-1, 3).astype(np.int64)


def _points(x: Array, y: Array, z: Array) -> Array:
    return np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1).astype(np.float64)


def crack_paths(
    rng: np.random.Generator,
    faces: Index,
    vertex_colors: Sequence[tuple[int, ...]],
    count: int,
    length: int,
) -> tuple[Crack, ...]:
    """Walks from triangle to triangle; what they cross is cracked for a few common colors."""
    faces_of: dict[tuple[int, int], list[int]] = {}
    for number, face in enumerate(faces.tolist()):
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            faces_of.setdefault((min(a, b), max(a, b)), []).append(number)
    edges_of: list[list[tuple[int, int]]] = [[] for _ in faces]
    for edge, sides in faces_of.items():
        for side in sides:
            edges_of[side].append(edge)
    cracked: dict[tuple[int, int], tuple[int, ...]] = {}
    for _ in range(count):
        face = int(rng.integers(len(faces)))
        available = sorted({color for vertex in faces[face] for color in vertex_colors[vertex]})
        chosen = {color for color in available if rng.random() < 0.7}
        visited = {face}
        for _ in range(int(rng.integers(2, length + 1))):
            onward = [
                (edge, side)
                for edge in edges_of[face]
                for side in faces_of[edge]
                if side not in visited and edge not in cracked
            ]
            if not onward:
                break
            edge, face = onward[int(rng.integers(len(onward)))]
            visited.add(face)
            common = chosen & set(vertex_colors[edge[0]]) & set(vertex_colors[edge[1]])
            if common:
                cracked[edge] = tuple(sorted(common))
    return tuple(Crack(i, j, common) for (i, j), common in sorted(cracked.items()))
