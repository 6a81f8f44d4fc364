"""Repairs of a mesh: double vertices and faces, non-manifold places, holes, the winding.

- Vertices in one place are joined. Duplicate faces and faces without area are left out. Faces
  get a consistent winding, outward where that can be known.
- Places that are not manifold are cut apart: edges with more than two faces, vertices of several
  fans. Then every edge has one or two faces, and the faces around a vertex form one fan. The copies
  of a vertex are moved apart a little, since two vertices in one place would be merged again.
- A hole is filled with the triangulation of least area among its own vertices, as Barequet and
  Sharir do ("Filling gaps in the boundary of a polyhedron", 1995).
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.frontend.parts.surface import Faces
from cellcolor.mesh.triangle_mesh import TriangleMesh, grouped

_SAME = 1e-8  # share of the mesh's size; vertices this close count as one place
_FLAT = 1e-6  # of the longest side's square; a doubled area that counts as none
_PASSES = 30


def merged(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """For vertices in one place, within 1e-8 of the mesh's size, the first of them."""
    size = float(np.ptp(vertices, axis=0).max(initial=0.0)) if len(vertices) else 0.0
    if not size:
        return vertices, faces
    place = np.rint((vertices - vertices.min(axis=0)) / (_SAME * size)).astype(np.int64)
    order = np.lexsort(place.T[::-1])
    new = np.ones(len(order), dtype=bool)
    new[1:] = (place[order[1:]] != place[order[:-1]]).any(axis=1)
    group = np.empty(len(order), dtype=np.int64)
    group[order] = np.cumsum(new) - 1
    first = np.full(int(new.sum()), len(order), dtype=np.int64)
    np.minimum.at(first, group, np.arange(len(order)))
    return used(vertices, first[group][faces])


def used(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """Only the vertices that faces have, in their order."""
    there = np.zeros(len(vertices), dtype=bool)
    there[faces] = True
    number = np.cumsum(there) - 1
    return vertices[there], number[faces].astype(np.int64)


def repeated_corners(faces: Faces) -> Mask:
    """The faces (m,) with a vertex that is two of their corners."""
    a, b, c = faces.T
    return np.asarray((a == b) | (b == c) | (c == a))


def repeated_faces(faces: Faces) -> Mask:
    """The faces (m,) whose three corners, in any order, an earlier face has."""
    corners = np.sort(faces, axis=1)
    order = np.lexsort((np.arange(len(faces)), *corners.T[::-1]))
    again = np.zeros(len(faces), dtype=bool)
    again[order[1:]] = (corners[order[1:]] == corners[order[:-1]]).all(axis=1)
    return again


def flat_faces(vertices: Array, faces: Faces) -> Mask:
    """The faces (m,) without area: less high than a millionth of their longest side.

    That is ten times what the four-byte numbers of STL and PLY files make of a face without height.
    """
    doubled = 2 * TriangleMesh(vertices, faces).areas
    corners = vertices[faces]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1, initial=0.0)
    return np.asarray(doubled <= _FLAT * longest**2)


def without_flat(vertices: Array, faces: Faces) -> Faces:
    """The same surface without flat faces, and without gaps where these were.

    A flat face has a corner on its longest side. The face on the other side of that is parted
    there, and the flat one left out. Flat faces whose longest side has not one other face are
    left out as well.
    """
    for _ in range(_PASSES):
        flat = flat_faces(vertices, faces)
        if not flat.any():
            break
        faces = _parted_beside(vertices, faces, flat)
        faces = faces[~repeated_corners(faces)]
        faces = faces[~repeated_faces(faces)]
    return faces[~flat_faces(vertices, faces)]


def _parted_beside(vertices: Array, faces: Faces, flat: Mask) -> Faces:
    """One pass over flat faces; a face takes part in one change at most."""
    across = TriangleMesh(vertices, faces).across
    touched = np.zeros(len(faces), dtype=bool)
    keep = np.ones(len(faces), dtype=bool)
    added = []
    for face in np.flatnonzero(flat).tolist():
        corners = vertices[faces[face]]
        lengths = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
        corner = int(np.argmax(lengths))
        side = int(across[face, corner])
        other, at = divmod(side, 3)
        if touched[face] or (side >= 0 and touched[other]):
            continue
        keep[face] = False
        touched[face] = True
        if side < 0:
            continue
        middle = int(faces[face, (corner + 2) % 3])
        a, b, c = (int(faces[other, (at + k) % 3]) for k in range(3))
        keep[other] = False
        touched[other] = True
        if middle != c:  # else two flat faces lie back to back
            added += [(a, middle, c), (middle, b, c)]
    return np.concatenate([faces[keep], np.array(added, dtype=np.int64).reshape(-1, 3)])


def against_the_others(mesh: TriangleMesh) -> tuple[Mask, Mask]:
    """The faces (m,) to turn for a consistent winding, and the faces of one-sided parts.

    Neighbors are two faces with an edge that no other has. Of each part the fewer are turned. A
    part is one-sided, as a Moebius strip is, if no turning makes its neighbors wind alike.
    """
    count, ascending = len(mesh.corners), mesh.ascending.ravel()
    _, sides = mesh.pairs
    first, second = sides[:, 0] // 3, sides[:, 1] // 3
    alike = ascending[sides[:, 0]] != ascending[sides[:, 1]]
    # Every face is there twice, as it is (f) and turned (count + f); linked is what goes together.
    other = np.where(alike, second, second + count)
    mirrored = np.where(alike, second + count, second)
    links = np.concatenate(
        [np.column_stack([first, other]), np.column_stack([first + count, mirrored])]
    )
    group = grouped(2 * count, links)
    as_it_is, turned_over = group[:count], group[count:]
    chosen = np.minimum(as_it_is, turned_over)
    kept = as_it_is == chosen
    votes = np.bincount(chosen, np.where(kept, 1.0, -1.0), minlength=len(group))
    turn = kept ^ (votes[chosen] >= 0)
    one_sided = as_it_is == turned_over
    return turn & ~one_sided, one_sided


def inside_out(mesh: TriangleMesh) -> Mask:
    """The faces (m,) of closed parts with a negative volume; neighbors wind alike."""
    if not len(mesh.corners):
        return np.zeros(0, dtype=bool)
    part = mesh.parts()
    open_ = np.zeros(int(part.max(initial=-1)) + 1, dtype=bool)
    open_[part[(mesh.triangles_at[mesh.edge_of_side] != 2).any(axis=1)]] = True
    points = mesh.points - mesh.points.mean(axis=0)
    a, b, c = (points[mesh.corners[:, k]] for k in range(3))
    volume = np.bincount(part, np.einsum("ij,ij->i", a, np.cross(b, c)), minlength=len(open_))
    return np.asarray(((volume < 0) & ~open_)[part])


def turned(faces: Faces, which: Mask | Index) -> Faces:
    """Faces, some of them with reversed winding."""
    changed = faces.copy()
    changed[which] = changed[which][:, ::-1]
    return changed


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
    """A mesh cut apart where it is not manifold.

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
    places, far = _moved_apart(vertices[own], parted, moved)
    return places, parted, far


def _glued(mesh: TriangleMesh) -> Index:
    """Pairs of sides (p, 2) that stay together at edges with more than two faces."""
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


def _moved_apart(vertices: Array, faces: Faces, moved: Mask) -> tuple[Array, float]:
    """Some vertices go a hundredth of their shortest side towards the middle of their faces."""
    if not moved.any():
        return vertices, 0.0
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
    return changed, float(np.linalg.norm(step, axis=1).max())


MOST_EDGES = 250  # of a hole that is filled; the work grows with the third power


def border_groups(mesh: TriangleMesh) -> tuple[Index, Index]:
    """The edges (b,) with only one face, and the connected group (b,) of each."""
    border = np.flatnonzero(mesh.triangles_at == 1)
    ends = mesh.edges[border]
    group = grouped(len(mesh.points), ends)[ends[:, 0]]
    return border, np.unique(group, return_inverse=True)[1]


def borders(mesh: TriangleMesh) -> int:
    """The number of borders: connected groups of edges with one face."""
    return int(border_groups(mesh)[1].max(initial=-1)) + 1


def filling(vertices: Array, loop: list[int], edges: set[tuple[int, int]]) -> Faces | None:
    """Faces (n - 2, 3) between the vertices of a loop, of least area; None if there are none.

    Args:
        loop: n vertices, in the order in which a face there winds.
        edges: (smaller, greater) of the mesh; none of them may get a third face.
    """
    count = len(loop)
    points, number = vertices[loop], np.array(loop)
    closed = np.zeros((count, count), dtype=bool)
    for i in range(count):
        for j in range(i + 2, count):
            if (i, j) != (0, count - 1):
                pair = (loop[i], loop[j])
                closed[i, j] = (min(pair), max(pair)) in edges
    cost = np.zeros((count, count))
    best = np.zeros((count, count), dtype=np.int64)
    for width in range(2, count):
        for i in range(count - width):
            j = i + width
            k = np.arange(i + 1, j)
            across = np.cross(points[k] - points[i], points[j] - points[i])
            area = np.linalg.norm(across, axis=1) / 2
            sides = np.linalg.norm(points[k] - points[i], axis=1) ** 2
            flat = area <= 1e-6 * np.maximum(sides, np.linalg.norm(points[j] - points[i]) ** 2)
            total = cost[i, k] + cost[k, j] + np.where(flat, np.inf, area)
            at = int(np.argmin(total))
            cost[i, j] = np.inf if closed[i, j] else total[at]
            best[i, j] = k[at]
    if not np.isfinite(cost[0, -1]):
        return None
    found, open_ = [], [(0, count - 1)]
    while open_:
        low, high = open_.pop()
        if high - low >= 2:
            middle = int(best[low, high])
            found.append((number[low], number[middle], number[high]))
            open_ += [(low, middle), (middle, high)]
    return np.array(found, dtype=np.int64)
