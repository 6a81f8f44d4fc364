"""Small labelled surfaces for tests, drawn as text or at random."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import trimesh
from hypothesis import strategies as st
from numpy.typing import NDArray

from cellcolor.data.surface import Crack, LabelledSurface

Faces = list[tuple[int, int, int]]


def grid_faces(width: int, height: int) -> Faces:
    """A grid of points, row by row from the top, each square cut from its upper right corner."""
    faces: Faces = []
    for row in range(height - 1):
        for column in range(width - 1):
            a = row * width + column
            b, c, d = a + 1, a + width, a + width + 1
            faces += [(c, d, b), (c, b, a)]
    return faces


def grid_points(width: int, height: int) -> NDArray[np.float64]:
    """Points 1 m apart in the plane z = 0; the first row is the one with the greatest y."""
    return np.array([(x, height - 1 - y, 0.0) for y in range(height) for x in range(width)])


def drawn(
    art: str, labels: Mapping[str, Sequence[int]], cracks: Sequence[tuple[int, int, int]] = ()
) -> LabelledSurface:
    """A flat surface from rows of letters, each letter standing for a color set.

    Args:
        art: rows of equal length, apart from each other by white space.
        labels: the colors of each letter.
        cracks: (vertex, vertex, color).
    """
    rows = art.split()
    width = len(rows[0])
    return surface(
        grid_points(width, len(rows)),
        grid_faces(width, len(rows)),
        [labels[letter] for row in rows for letter in row],
        cracks,
    )


def surface(
    points: NDArray[np.float64],
    faces: Faces,
    vertex_colors: Sequence[Sequence[int]],
    cracks: Sequence[tuple[int, int, int]] = (),
) -> LabelledSurface:
    """A labelled surface in the colors red, blue, green."""
    by_edge: dict[tuple[int, int], list[int]] = {}
    for i, j, color in cracks:
        by_edge.setdefault((min(i, j), max(i, j)), []).append(color)
    return LabelledSurface(
        "drawn",
        ("red", "blue", "green"),
        points,
        np.array(faces, dtype=np.int64),
        tuple(tuple(sorted(colors)) for colors in vertex_colors),
        tuple(Crack(i, j, tuple(sorted(set(c)))) for (i, j), c in by_edge.items()),
    )


def octahedron() -> tuple[NDArray[np.float64], Faces]:
    """A closed surface of six vertices: ±x, ±y, ±z."""
    points = np.array(
        [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], dtype=np.float64
    )
    upper: Faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4)]
    return points, upper + [(b, a, 5) for a, b, _ in upper]


def finer(points: NDArray[np.float64], faces: Faces) -> tuple[NDArray[np.float64], Faces]:
    """Every triangle cut into four at the middles of its edges."""
    made, cut = trimesh.remesh.subdivide(points, np.array(faces))
    return made, [(a, b, c) for a, b, c in cut.tolist()]


def torus(n: int = 4, m: int = 5) -> tuple[NDArray[np.float64], Faces]:
    """A closed surface of genus 1."""
    u, v = np.meshgrid(np.arange(n) * 2 * np.pi / n, np.arange(m) * 2 * np.pi / m, indexing="ij")
    ring = 2 + np.cos(v)
    points = np.stack((ring * np.cos(u), ring * np.sin(u), np.sin(v)), axis=-1).reshape(-1, 3)
    faces: Faces = []
    for i in range(n):
        for j in range(m):
            a, b = i * m + j, (i + 1) % n * m + j
            c, d = i * m + (j + 1) % m, (i + 1) % n * m + (j + 1) % m
            faces += [(a, b, d), (a, d, c)]
    return points, faces


def beside(parts: Sequence[LabelledSurface]) -> LabelledSurface:
    """Surfaces in the same colors as the parts of one."""
    start = np.cumsum([0, *(len(part.vertices) for part in parts)])
    return LabelledSurface(
        "parts",
        parts[0].colors,
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.faces + n for n, part in zip(start, parts, strict=False)]),
        tuple(own for part in parts for own in part.vertex_colors),
        tuple(
            Crack(crack.i + int(n), crack.j + int(n), crack.colors)
            for n, part in zip(start, parts, strict=False)
            for crack in part.cracks
        ),
    )


@st.composite
def surfaces(draw: st.DrawFn) -> LabelledSurface:
    """Open and closed surfaces with unreachable points, cracks, holes and several cells."""
    if draw(st.booleans()):
        points, faces = finer(*octahedron())
    else:
        width, height = draw(st.integers(2, 5)), draw(st.integers(2, 5))
        points, faces = grid_points(width, height), grid_faces(width, height)
    # Few color sets to draw from, or hardly any cell would have more than one point.
    sets = draw(st.lists(st.sets(st.integers(0, 2)), min_size=1, max_size=3))
    labels = [draw(st.sampled_from(sets)) for _ in range(len(points))]
    crackable = sorted(
        {
            (min(a, b), max(a, b), color)
            for face in faces
            for a, b in zip(face, face[1:] + face[:1], strict=True)
            for color in labels[a] & labels[b]
        }
    )
    cracks = draw(st.lists(st.sampled_from(crackable), max_size=6)) if crackable else []
    return surface(points, faces, [sorted(label) for label in labels], cracks)
