"""A triangle mesh as a value, and whether it is an oriented surface.

What follows from a mesh is computed once, when it is first asked for. A :class:`TriangleMesh` need
not be a manifold: an edge may have any number of triangles. The judge of trajectories measures on a
mesh of trimesh (``cellcolor.trajectory_checker.fine_mesh``).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, Mask
from cellcolor.errors import InputError

T = TypeVar("T", bound=NDArray[Any])


def grouped(count: int, pairs: Index) -> Index:
    """The group (count,) of each thing, given the pairs (p, 2) of things that belong together."""
    from scipy.sparse import coo_array  # late: reading and solving a surface do without
    from scipy.sparse.csgraph import connected_components

    links = coo_array((np.ones(len(pairs), dtype=bool), tuple(pairs.T)), (count, count))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """A triangle mesh. Arrays that it computes cannot be changed.

    Sides are numbered 3 * triangle + corner; side k of a triangle goes from its corner k to the
    next one: ab, bc, ca.

    Attributes:
        points: (n, 3), in any unit.
        corners: (m, 3) the points of each triangle, three different ones.
    """

    points: Array
    corners: Index

    @cached_property
    def _edges_and_sides(self) -> tuple[Index, Index, Index]:
        following = self.corners[:, [1, 2, 0]]
        low, high = np.minimum(self.corners, following), np.maximum(self.corners, following)
        # One number for a pair: rows of two take fifty times as long to sort.
        base = max(len(self.points), 1)
        key = (low * base + high).ravel()
        order = np.argsort(key, kind="stable")
        key = key[order]
        new = np.diff(key, prepend=-1) > 0
        of_side = np.empty(len(key), dtype=np.int64)
        of_side[order] = np.cumsum(new) - 1
        edges = np.stack(np.divmod(key[new], base), axis=1)
        return _fixed(edges), _fixed(of_side.reshape(-1, 3)), _fixed(order)

    @property
    def edges(self) -> Index:
        """(k, 2) the ends of each edge, the smaller first, in lexicographic order."""
        return self._edges_and_sides[0]

    @property
    def edge_of_side(self) -> Index:
        """(m, 3) the number of the edge on each side."""
        return self._edges_and_sides[1]

    @cached_property
    def triangles_at(self) -> Index:
        """(k,) how many triangles have each edge."""
        return _fixed(np.bincount(self.edge_of_side.ravel(), minlength=len(self.edges)))

    @cached_property
    def pairs(self) -> tuple[Index, Index]:
        """The edges (p,) that two triangles have, and the two sides (p, 2) that are each."""
        order, first = self._edges_and_sides[2], np.cumsum(self.triangles_at) - self.triangles_at
        two = np.flatnonzero(self.triangles_at == 2)
        return _fixed(two), _fixed(np.column_stack([order[first[two]], order[first[two] + 1]]))

    @cached_property
    def across(self) -> Index:
        """(m, 3) the side of the other triangle that each side is; -1 unless two have it."""
        one, other = self.pairs[1].T
        found = np.full(3 * len(self.corners), -1, dtype=np.int64)
        found[one], found[other] = other, one
        return _fixed(found.reshape(-1, 3))

    @property
    def beyond(self) -> Index:
        """(m, 3) the triangle beyond each side; -1 unless two have it."""
        return self.across // 3

    @property
    def ascending(self) -> Mask:
        """(m, 3) whether a side goes from the smaller point to the greater one."""
        return np.asarray(self.corners < self.corners[:, [1, 2, 0]])

    def find(self, pairs: Index) -> Index:
        """The numbers (p,) of edges that are given by their ends (p, 2), in any order."""
        key = np.sort(pairs, axis=1) @ [len(self.points), 1]
        return np.searchsorted(self.edges @ [len(self.points), 1], key)

    def marked(self, pairs: Iterable[tuple[int, int]]) -> Mask:
        """Which edges (k,) are among some that are given by their ends, in any order."""
        marked = np.zeros(len(self.edges), dtype=bool)
        marked[self.find(np.array([*pairs], dtype=np.int64).reshape(-1, 2))] = True
        return marked

    @cached_property
    def lengths(self) -> Array:
        """(k,) of the edges."""
        ends = self.points[self.edges]
        return _fixed(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1))

    @cached_property
    def area_vectors(self) -> Array:
        """(m, 3) normals of the triangles, each twice as long as its triangle's area."""
        a, b, c = (self.points[self.corners[:, corner]] for corner in range(3))
        return _fixed(np.cross(b - a, c - a))

    @cached_property
    def areas(self) -> Array:
        """(m,) of the triangles."""
        return _fixed(np.linalg.norm(self.area_vectors, axis=1) / 2)

    @cached_property
    def triangle_normals(self) -> Array:
        """(m, 3) unit normals of the triangles; NaN of one without area."""
        with np.errstate(invalid="ignore"):
            lengths = np.linalg.norm(self.area_vectors, axis=1, keepdims=True)
            return _fixed(self.area_vectors / lengths)

    @cached_property
    def vertex_areas(self) -> Array:
        """(n,) a third of the triangles around each point; they add up to the whole."""
        thirds = np.repeat(self.areas / 3, 3)
        return _fixed(np.bincount(self.corners.ravel(), thirds, len(self.points)).astype(float))

    @cached_property
    def vertex_normals(self) -> Array:
        """(n, 3) unit normals of the points: of the triangles around, weighed by area.

        A point without triangles, or with triangles that cancel out, has (0, 0, 1).
        """
        sums = np.zeros_like(self.points)
        np.add.at(sums, self.corners, self.area_vectors[:, None, :])
        lengths = np.linalg.norm(sums, axis=1, keepdims=True)
        return _fixed(np.where(lengths > 0, sums / np.where(lengths > 0, lengths, 1.0), [0, 0, 1]))

    @cached_property
    def _inverses(self) -> Array:
        """(m, 2, 3) what makes a vector from a triangle's first corner one of its sides."""
        a, b, c = (self.points[self.corners[:, corner]] for corner in range(3))
        return _fixed(np.linalg.pinv(np.stack([b - a, c - a], axis=2)))

    def shares(self, triangles: Index, points: Array) -> Array:
        """The barycentric coordinates (p, 3) of points (p, 3), each on a triangle (p,)."""
        from_corner = points - self.points[self.corners[triangles, 0]]
        shares = np.einsum("kij,kj->ki", self._inverses[triangles], from_corner)
        return np.column_stack([1 - shares.sum(axis=1), shares])

    @cached_property
    def border(self) -> Mask:
        """(n,) whether a point is on an edge of one triangle only."""
        on_border = np.zeros(len(self.points), dtype=bool)
        on_border[self.edges[self.triangles_at == 1]] = True
        return _fixed(on_border)

    def border_loops(self) -> list[list[int]]:
        """The borders of a manifold, by their smallest points.

        Each goes against the winding of its triangles, as one beyond the border would be wound.
        """
        following = self.corners[:, [1, 2, 0]]
        alone = self.triangles_at[self.edge_of_side] == 1
        after = dict(zip(following[alone].tolist(), self.corners[alone].tolist(), strict=True))
        found = []
        while after:
            first, point = after.popitem()
            loop = [first]
            while point != first:
                loop.append(point)
                point = after.pop(point)
            found.append(loop)
        return sorted(found, key=min)

    def parts(self, closed: Mask | None = None) -> Index:
        """The part (m,) of each triangle: triangles belong together that have an edge in common.

        Args:
            closed: (k,) edges that part triangles all the same.
        """
        order = self._edges_and_sides[2]
        edge = self.edge_of_side.ravel()[order]
        same = edge[1:] == edge[:-1]
        if closed is not None:
            same &= ~closed[edge[1:]]
        return grouped(len(self.corners), np.column_stack([order[:-1], order[1:]])[same] // 3)

    def sharp_edges(self, angle: float) -> Index:
        """The edges (s,) of two triangles whose normals are farther from each other, rad.

        Which way the triangles wind does not matter; one without area has no normal.
        """
        edges, sides = self.pairs
        first, second = (self.triangle_normals[side // 3] for side in sides.T)
        cosine = np.einsum("ij,ij->i", first, second)
        ascending = self.ascending.ravel()
        cosine[ascending[sides[:, 0]] == ascending[sides[:, 1]]] *= -1
        return np.asarray(edges[cosine < np.cos(angle)])


def _fixed(array: T) -> T:
    array.setflags(write=False)
    return array


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
    check_corners(faces, vertex_count)
    repeated = np.flatnonzero(repeated_corners(faces))
    if len(repeated):
        face = repeated[0]
        raise InputError(None, f"faces[{face}]", f"repeats a vertex: {faces[face].tolist()}")
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


def check_corners(faces: Index, vertex_count: int) -> None:
    """Refuse a face that has a vertex which is not there.

    Raises:
        InputError: names the corner.
    """
    wrong = np.argwhere((faces < 0) | (faces >= vertex_count))
    if len(wrong):
        face, corner = wrong[0]
        message = f"there is no vertex {faces[face, corner]}"
        raise InputError(None, f"faces[{face}][{corner}]", message)


def repeated_corners(faces: Index) -> Mask:
    """The faces (m,) with a vertex that is two of their corners."""
    a, b, c = faces.T
    return np.asarray((a == b) | (b == c) | (c == a))


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
    # The walk about a vertex begins with any corner, or with the end of an open fan.
    first = np.zeros(vertex_count, dtype=np.int64)
    first[start] = corners
    begun = np.ones(len(start), dtype=bool)
    begun[following[following >= 0]] = False
    first[start[begun]] = corners[begun]
    walked = np.zeros(vertex_count, dtype=np.int64)
    walking = np.flatnonzero(degree)
    at = first[walking]
    while len(walking):
        walked[walking] += 1
        at = following[at]
        on = (at >= 0) & (at != first[walking])
        walking, at = walking[on], at[on]
    bad = np.flatnonzero((walked != degree) | (degree == 0))
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
