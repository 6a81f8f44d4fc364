"""Triangle meshes for property tests: any few triangles, and closed ones with random places."""

from __future__ import annotations

import numpy as np
import trimesh
from hypothesis import strategies as st

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
