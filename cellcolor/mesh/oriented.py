"""Triangle meshes as oriented surfaces: which triangle lies on the left of a directed edge."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Index
from cellcolor.errors import InputError


def directed_edges(faces: NDArray[np.int64], vertex_count: int) -> dict[tuple[int, int], int]:
    """The third vertex of the triangle on the left of every directed mesh edge.

    Args:
        faces: (m, 3) vertex indices, counter-clockwise seen from outside.

    Returns:
        ``{(i, j): k}`` for every triangle (i, j, k), three entries a triangle.

    Raises:
        InputError: an index out of range, a repeated vertex in a face, an edge with more than two
            faces, neighbouring faces that wind differently, a vertex whose faces do not form
            exactly one fan.
    """
    if len(faces) == 0:
        raise InputError(None, "faces", "the surface is empty")
    _check_indices(faces, vertex_count)
    # Three directed edges a face, and what stands on their left.
    start, end, third = faces.ravel(), faces[:, [1, 2, 0]].ravel(), faces[:, [2, 0, 1]].ravel()
    key = start * vertex_count + end
    order = np.argsort(key, kind="stable")
    twice = np.flatnonzero(key[order[1:]] == key[order[:-1]])
    if len(twice):
        again = twice[np.argmin(order[twice + 1])]
        _refuse_edge(faces, int(order[again]), int(order[again + 1]))
    # The directed edge from the same vertex to what stands on the left; -1 where there is none.
    wanted, ascending = start * vertex_count + third, key[order]
    at = np.minimum(np.searchsorted(ascending, wanted), len(key) - 1)
    following = np.where(ascending[at] == wanted, order[at], -1)
    _check_fans(start, following, vertex_count)
    pairs = zip(start.tolist(), end.tolist(), strict=True)
    return dict(zip(pairs, third.tolist(), strict=True))


def _check_indices(faces: NDArray[np.int64], vertex_count: int) -> None:
    wrong = np.argwhere((faces < 0) | (faces >= vertex_count))
    if len(wrong):
        face, corner = wrong[0]
        raise InputError(
            None, f"faces[{face}][{corner}]", f"there is no vertex {faces[face, corner]}"
        )
    repeated = np.flatnonzero(
        (faces[:, 0] == faces[:, 1]) | (faces[:, 1] == faces[:, 2]) | (faces[:, 2] == faces[:, 0])
    )
    if len(repeated):
        face = repeated[0]
        raise InputError(None, f"faces[{face}]", f"repeats a vertex: {faces[face].tolist()}")


def _refuse_edge(faces: Index, first: int, second: int) -> None:
    """Two directed edges, three a face, are one: say what is wrong with their faces."""
    earlier, number = first // 3, second // 3
    a, b = (int(faces[number, (second + k) % 3]) for k in (0, 1))
    users = np.flatnonzero((faces == a).any(axis=1) & (faces == b).any(axis=1)).tolist()
    if len(users) > 2:
        raise InputError(
            None, f"faces[{users[2]}]", f"edge {a}-{b} is not manifold: faces {users} share it"
        )
    raise InputError(
        None,
        f"faces[{number}]",
        f"winds the other way than face {earlier}: both run from vertex {a} to vertex {b}",
    )


def _check_fans(start: Index, following: Index, vertex_count: int) -> None:
    """Hold the faces about each vertex to form one fan, open or closed.

    Args:
        start: (k,) the vertex of each corner.
        following: (k,) the next corner about the same vertex, -1 at the end of an open fan.
    """
    corners = np.arange(len(start))
    degree = np.bincount(start, minlength=vertex_count)
    ends = np.flatnonzero(following < 0)
    fans = np.bincount(start[ends], minlength=vertex_count)
    # Open fans are closed, so that a fan is a cycle of corners; of several at a vertex some stay
    # open, but then they are too many already.
    first = np.full(vertex_count, -1)
    begun = np.ones(len(start), dtype=bool)
    begun[following[following >= 0]] = False
    first[start[begun]] = corners[begun]
    cycle = following.copy()
    cycle[ends] = first[start[ends]]
    # Each corner learns the smallest one of its cycle, twice as many steps ahead every time.
    smallest, ahead = corners, cycle
    for _ in range(int(degree.max()).bit_length()):
        smallest = np.minimum(smallest, smallest[ahead])
        ahead = ahead[ahead]
    cycles = np.bincount(start[smallest == corners], minlength=vertex_count)
    bad = np.flatnonzero((np.maximum(fans, cycles) != 1) | (degree == 0))
    if not len(bad):
        return
    vertex = int(bad[0])
    if not degree[vertex]:
        raise InputError(None, f"vertices[{vertex}]", "belongs to no face")
    raise InputError(
        None,
        f"vertices[{vertex}]",
        f"is pinched: its {degree[vertex]} faces do not form one fan",
    )
