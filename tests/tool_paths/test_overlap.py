"""Paths that go beyond the border of their segment: how far, and where not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import Delaunay, cKDTree

from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.tool_paths.region import Overlap, Segments, clipped, owned, regions_of
from examples import examples

NAMES = ("one", "other")


def plate(seed: int, cracked: float | None = None) -> LabelledSurface:
    """A square of 100 mm with random vertices; along x = ``cracked`` nothing goes across."""
    rng = np.random.default_rng(seed)
    side = np.linspace(0, 0.1, 8)
    rim = np.array([(x, y) for x in side for y in side if {x, y} & {0.0, 0.1}])
    flat = np.concatenate([rim, rng.uniform(0.004, 0.096, (90, 2))])
    faces = Delaunay(flat).simplices
    a, b, c = flat[faces].swapaxes(0, 1)
    turn = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    faces = np.where(turn[:, None] > 0, faces, faces[:, ::-1])[np.abs(turn) > 1e-9]
    cracks = []
    if cracked is not None:
        pairs = {tuple(sorted(pair)) for face in faces for pair in (face[:2], face[1:], face[::2])}
        cracks = [
            Crack(int(i), int(j), (0,))
            for i, j in pairs
            if (flat[i, 0] < cracked) != (flat[j, 0] < cracked)
        ]
    vertices = np.column_stack([flat, np.zeros(len(flat))])
    every = tuple((0, 1) for _ in vertices)
    return LabelledSurface("plate", NAMES, vertices, faces, every, tuple(cracks))


def sampled(surface: LabelledSurface) -> tuple[np.ndarray, np.ndarray]:
    """Points (k, 3) of the surface some 1 mm apart, and the vertex that owns each."""
    shares = np.array([(i, j, 22 - i - j) for i in range(23) for j in range(23 - i)]) / 22
    points = np.einsum("kc,mcd->mkd", shares, surface.vertices[surface.faces])
    vertex = np.broadcast_to(surface.faces[:, shares.argmax(axis=1)], points.shape[:2])
    return points.reshape(-1, 3), vertex.ravel()


@examples(15)
@given(seed=st.integers(0, 10**6), border=st.floats(0.03, 0.07), width=st.floats(0.002, 0.02))
def test_a_region_reaches_a_width_beyond_its_segment(
    seed: int, border: float, width: float
) -> None:
    """On a flat plate straight distances tell: all that is nearer is there, nothing farther."""
    surface = plate(seed)
    own = surface.vertices[:, 0] < border
    segment_of = np.where(Overlap(np.full(len(own), width), ~own).widened(surface, own), 0, -1)
    up = np.tile([0.0, 0.0, 1.0], (len(own), 1))
    (region,) = regions_of(Segments(surface, segment_of, (0,), up))
    (part,) = clipped(region.mesh, surface, own, np.full(len(own), width), 0.0025)
    assert owned(part, surface, own).any()
    points, vertex = sampled(surface)
    inside = cKDTree(points[own[vertex]])
    middles = part.points[part.corners].mean(axis=1)
    # Samples are some 1 mm apart, and distances along the mesh are not exact.
    assert inside.query(middles)[0].max() < 1.15 * width + 0.001
    beyond = points[~own[vertex]]
    near = beyond[inside.query(beyond)[0] < 0.85 * width - 0.001]
    assert not len(near) or cKDTree(part.points).query(near)[0].max() < 0.0025


def test_nothing_goes_over_a_crack() -> None:
    surface = plate(3, cracked=0.05)
    own = surface.vertices[:, 0] < 0.05
    segment_of = np.where(Overlap(np.full(len(own), 0.01), ~own).widened(surface, own), 0, -1)
    up = np.tile([0.0, 0.0, 1.0], (len(own), 1))
    parts = [
        part
        for region in regions_of(Segments(surface, segment_of, (0,), up))
        for part in clipped(region.mesh, surface, own, np.full(len(own), 0.01), 0.0025)
    ]
    assert sum(part.areas.sum() for part in parts) == pytest.approx(
        sum(part.areas[owned(part, surface, own)].sum() for part in parts)
    )


def test_the_one_that_can_goes_all_the_way() -> None:
    """Half of the overlap each where both colors are, all of it where only one is."""
    surface = plate(7)
    x, y, _ = surface.vertices.T
    own = x < 0.05
    labels = [(0, 1) if right or up else (0,) for right, up in zip(~own, y < 0.05, strict=True)]
    surface = replace(surface, vertex_colors=tuple(labels))
    segments = Segments(surface, np.where(own, 0, 1), (0, 1), surface.vertex_normals)
    one, other = (Overlap.of(segments, segment, 0.02) for segment in (0, 1))
    ends = surface.mesh.edges[np.diff(own[surface.mesh.edges], axis=1).ravel()]
    here = np.where(own[ends], ends, -1).max(axis=1)
    both = np.unique(here[y[here] < 0.05])
    assert len(both)
    assert np.all(one.beyond[both] == 0.01)
    assert np.all(one.beyond[np.setdiff1d(here, both)] == 0.02)
    assert np.array_equal(one.onto, ~own)
    # The other one's color is on one half only, and the first one's everywhere.
    assert np.array_equal(other.onto, own & (y < 0.05))
    there = np.where(own[ends], -1, ends).max(axis=1)
    assert np.all(other.beyond[there] == 0.01)
