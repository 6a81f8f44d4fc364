"""Places that are not manifold cut apart: edges of three faces and more, vertices of several fans.

Afterwards every edge has one or two faces, and the faces around every vertex form one fan. Two
vertices in one place are no better than one, so the copies of a vertex are moved apart a little.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.frontend.parts.surface import Faces
from cellcolor.mesh.triangle_mesh import TriangleMesh, grouped

__all__ = ["fans", "split"]

_APART = 0.01  # of the shortest side beside a copy


def fans(faces: Faces, sides: Index) -> Index:
    """The fan (m, 3) that each corner belongs to; a manifold vertex has one.

    Args:
        sides: (p, 2) the sides of faces that are glued, numbered 3 * face + corner.
    """
    links = []
    first, second = sides.T
    after = (first // 3) * 3 + (first + 1) % 3, (second // 3) * 3 + (second + 1) % 3
    vertex = faces.ravel()
    for a in (first, after[0]):
        for b in (second, after[1]):
            same = vertex[a] == vertex[b]
            links.append(np.column_stack([a, b])[same])
    return grouped(faces.size, np.concatenate(links)).reshape(-1, 3)


def split(vertices: Array, faces: Faces) -> tuple[Array, Faces, float]:
    """A mesh cut apart where it is no manifold.

    At an edge of three faces and more two stay together that wind alike: of these two that are
    connected elsewhere, and of these the two that go on straightest; then two of the others. What
    winds alike before has no one-sided part afterwards.

    Returns:
        vertices, faces, and how far a copy of a vertex was moved at most, in the vertices' unit.
    """
    mesh = TriangleMesh(vertices, faces)
    glued = np.concatenate([mesh.pairs[1], _glued(mesh)])
    fan = fans(faces, glued)
    group, first, number, corners = np.unique(
        fan.ravel(), return_index=True, return_inverse=True, return_counts=True
    )
    own = faces.ravel()[first]
    parted = number.reshape(-1, 3).astype(np.int64)
    # Of the copies of a vertex the one with most corners stays in its place.
    order = np.lexsort((np.arange(len(group)), -corners, own))
    moved = np.zeros(len(group), dtype=bool)
    moved[order[1:]] = own[order[1:]] == own[order[:-1]]
    places = vertices[own]
    return (*_moved_apart(places, parted, moved),)


def _glued(mesh: TriangleMesh) -> Index:
    """Pairs of sides (p, 2) that stay together at edges of three faces and more."""
    many = mesh.triangles_at > 2
    part, ascending = mesh.parts(many), mesh.ascending.ravel()
    normals = np.nan_to_num(mesh.triangle_normals)
    chosen: list[tuple[int, int]] = []
    for edge in np.flatnonzero(many).tolist():
        around = mesh.sides_of(edge).tolist()

        def rank(pair: tuple[int, int]) -> tuple[bool, float]:
            """Connected ones first, then those that bend least."""
            f, g = pair[0] // 3, pair[1] // 3
            return bool(part[f] != part[g]), -float(normals[f] @ normals[g])

        free = set(around)
        for pair in sorted(combinations(around, 2), key=rank):
            alike = ascending[pair[0]] != ascending[pair[1]]
            if alike and pair[0] in free and pair[1] in free:
                free -= set(pair)
                chosen.append(pair)
    return np.array(chosen, dtype=np.int64).reshape(-1, 2)


def _moved_apart(vertices: Array, faces: Faces, moved: Array) -> tuple[Array, Faces, float]:
    """Some vertices go a hundredth of their shortest side towards the middle of their faces."""
    if not moved.any():
        return vertices, faces, 0.0
    rows = np.flatnonzero(moved[faces].any(axis=1))
    corners = vertices[faces[rows]]
    sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    shortest = np.full(len(vertices), np.inf)
    np.minimum.at(shortest, faces[rows], np.minimum(sides, np.roll(sides, 1, axis=1)))
    towards, count = np.zeros_like(vertices), np.zeros(len(vertices))
    np.add.at(towards, faces[rows], np.repeat(corners.mean(axis=1)[:, None], 3, axis=1))
    np.add.at(count, faces[rows], 1.0)
    which = np.flatnonzero(moved)
    way = towards[which] / count[which, None] - vertices[which]
    length = np.linalg.norm(way, axis=1, keepdims=True)
    step = _APART * shortest[which, None] * way / np.maximum(length, 1e-300)
    changed = vertices.copy()
    changed[which] += step
    return changed, faces, float(np.linalg.norm(step, axis=1).max())
