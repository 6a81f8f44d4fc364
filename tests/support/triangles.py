"""Triangle meshes for property tests: any few triangles, and closed ones with random places.

Which triangle lies on the left of a directed edge, found by walking from face to face.

What the quick way in the package is held to.
"""

from __future__ import annotations

import numpy as np
import trimesh
from hypothesis import strategies as st
from numpy.typing import NDArray

from cellcolor.errors import InputError
from cellcolor.mesh.triangle_mesh import TriangleMesh


@st.composite
def any_meshes(draw: st.DrawFn) -> TriangleMesh:
    """A few triangles between a few points: most are no manifold, and points may have none."""
    count = draw(st.integers(3, 8))
    whole = st.integers(-3, 3)
    points = draw(st.lists(st.tuples(whole, whole, whole), min_size=count, max_size=count))
    triangles = st.permutations(range(count)).map(lambda order: order[:3])
    corners = draw(st.lists(triangles, min_size=1, max_size=12))
    return TriangleMesh(np.array(points, dtype=np.float64), np.array(corners, dtype=np.int64))


def bumpy_ball(seed: int) -> TriangleMesh:
    """A closed mesh whose edges have all lengths."""
    ball = trimesh.creation.icosphere(subdivisions=2)
    points = np.array(ball.vertices)
    points += np.random.default_rng(seed).uniform(-0.08, 0.08, points.shape)
    return TriangleMesh(points, np.array(ball.faces, dtype=np.int64))


def directed_edges(faces: NDArray[np.int64], vertex_count: int) -> dict[tuple[int, int], int]:
    """The third vertex of the triangle on the left of every directed mesh edge.

    Args:
        faces: (m, 3) vertex indices, counter-clockwise seen from outside.
        vertex_count: number of vertices.

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
    third: dict[tuple[int, int], int] = {}
    face_of: dict[tuple[int, int], int] = {}
    triangles = faces.tolist()
    for number, (i, j, k) in enumerate(triangles):
        for a, b, c in ((i, j, k), (j, k, i), (k, i, j)):
            if (a, b) in third:
                _refuse_edge(a, b, face_of, number, triangles)
            third[a, b] = c
            face_of[a, b] = number
    _check_fans(third, vertex_count)
    return third


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


def _refuse_edge(
    a: int,
    b: int,
    face_of: dict[tuple[int, int], int],
    number: int,
    triangles: list[list[int]],
) -> None:
    users = [f for f, t in enumerate(triangles) if a in t and b in t]
    if len(users) > 2:
        raise InputError(
            None, f"faces[{users[2]}]", f"edge {a}-{b} is not manifold: faces {users} share it"
        )
    raise InputError(
        None,
        f"faces[{number}]",
        f"winds the other way than face {face_of[a, b]}: both run from vertex {a} to vertex {b}",
    )


def _check_fans(third: dict[tuple[int, int], int], vertex_count: int) -> None:
    degree = [0] * vertex_count
    start: list[int | None] = [None] * vertex_count
    for a, b in third:
        degree[a] += 1
        # A fan that touches the mesh's border has to be walked from its clockwise end.
        if start[a] is None or (b, a) not in third:
            start[a] = b
    for vertex, first in enumerate(start):
        if first is None:
            raise InputError(None, f"vertices[{vertex}]", "belongs to no face")
        steps, neighbour = 1, third[vertex, first]
        while neighbour != first and (vertex, neighbour) in third:
            neighbour = third[vertex, neighbour]
            steps += 1
        if steps != degree[vertex]:
            raise InputError(
                None,
                f"vertices[{vertex}]",
                f"is pinched: its {degree[vertex]} faces do not form one fan",
            )
