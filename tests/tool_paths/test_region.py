"""The mesh of a segment: its area, its borders, and what it is cut along."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from painted import SHAPES, one_segment, painted_at_random

from cellcolor.mesh.dividing import small_areas
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.tool_paths.region import regions_of
from examples import examples


def euler(mesh: TriangleMesh) -> int:
    """Vertices minus edges plus triangles."""
    return len(np.unique(mesh.corners)) - len(mesh.edges) + len(mesh.corners)


def test_normals_lie_between_those_of_the_corners() -> None:
    painting = one_segment(*[np.array(rows) for rows in (
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0, 1, 2]],
    )])  # fmt: skip
    normals = np.array([[0.6, 0.0, 0.8], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]])
    (region,) = regions_of(painting._replace(normals=normals))
    at = int(np.argmin(np.linalg.norm(region.mesh.points - [0.5, 0.0, 0.0], axis=1)))
    between = normals[0] + normals[1]
    assert region.mesh.normals[at] == pytest.approx(between / np.linalg.norm(between))


@given(st.integers(0, 10**6), st.sampled_from(SHAPES))
@examples(7)
def test_parts_have_the_area_of_their_vertices(seed: int, shape: str) -> None:
    painting = painted_at_random(seed, shape)
    regions = regions_of(painting)
    for segment in range(len(painting.colors)):
        own = [region for region in regions if region.segment == segment]
        area = sum(region.mesh.areas.sum() for region in own)
        mine = painting.surface.vertex_areas[painting.segment_of == segment].sum()
        assert area == pytest.approx(mine)
    areas = small_areas(painting.surface.mesh)
    for region in regions:
        assert region.mesh.areas == pytest.approx(areas[region.small])
        assert (region.mesh.faces == region.small // 6).all()
        # A border is left by the way it is entered: the mesh is a manifold.
        border = np.concatenate([*region.mesh.border_loops(), np.zeros(0)])
        assert len(border) == len(np.unique(border)) == region.mesh.border.sum()


@given(st.integers(0, 10**6), st.sampled_from(SHAPES), st.floats(0.02, 0.2))
@examples(7)
def test_refining_keeps_area_shape_and_place(seed: int, shape: str, longest: float) -> None:
    for region in regions_of(painted_at_random(seed, shape))[:3]:
        fine = region.mesh.refined(longest)
        assert fine.lengths.max() <= longest
        assert (fine.areas > 0).all()
        for face in np.unique(region.mesh.faces)[:20]:
            before = region.mesh.areas[region.mesh.faces == face].sum()
            assert fine.areas[fine.faces == face].sum() == pytest.approx(before)
        assert euler(fine) == euler(region.mesh)
        assert len(fine.border_loops()) == len(region.mesh.border_loops())
