"""Bisected edges: the same surface, conforming, and no sharp triangles however often."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.errors import InputError
from cellcolor.frontend import sizes
from cellcolor.frontend.parts.surface import Surface, bisected
from cellcolor.lab.families.meshes import make_mesh
from cellcolor.mesh.oriented import directed_edges
from cellcolor.mesh.triangle_mesh import TriangleMesh
from examples import examples


def on_unit_sphere(seed: int) -> Surface:
    """A sphere whose vertices are moved along it at random, so that angles differ."""
    vertices, faces = make_mesh("sphere", 8)
    rng = np.random.default_rng(seed)
    vertices = vertices + rng.uniform(-0.04, 0.04, vertices.shape)
    vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    return Surface(vertices, faces, vertices.copy())


def smallest_angle(surface: Surface) -> float:
    corners = surface.vertices[surface.faces]
    before, after = np.roll(corners, 1, axis=1) - corners, np.roll(corners, -1, axis=1) - corners
    cosine = (before * after).sum(axis=2)
    cosine /= np.linalg.norm(before, axis=2) * np.linalg.norm(after, axis=2)
    return float(np.arccos(cosine.max()))


@given(st.integers(0, 10**6), st.floats(0.005, 0.5), st.integers(1, 4))
@examples(20)
def test_whatever_is_bisected_and_however_often(seed: int, share: float, rounds: int) -> None:
    given_surface = surface = on_unit_sphere(seed)
    rng = np.random.default_rng(seed)
    for _ in range(rounds):
        edges = surface.edges()
        marked = rng.random(len(edges)) < share
        finer = bisected(surface, marked, "key")
        count = len(surface.vertices)
        assert np.array_equal(finer.vertices[:count], surface.vertices)
        # Each marked edge is gone, and its middle is there with the normal between its ends'.
        left = {tuple(edge) for edge in finer.edges().tolist()}
        normal_at = {tuple(v): n for v, n in zip(finer.vertices, finer.normals, strict=True)}
        for a, b in edges[marked].tolist():
            assert (a, b) not in left
            between = surface.normals[a] + surface.normals[b]
            middle = tuple((surface.vertices[a] + surface.vertices[b]) / 2)
            assert np.allclose(normal_at[middle], between / np.linalg.norm(between))
        directed_edges(finer.faces, len(finer.vertices))  # refuses what is not manifold
        surface = finer
    areas = [
        np.linalg.norm(TriangleMesh(one.vertices, one.faces).area_vectors, axis=1).sum()
        for one in (given_surface, surface)
    ]
    assert areas[0] == pytest.approx(areas[1])
    assert smallest_angle(surface) >= smallest_angle(given_surface) / 2 - 1e-9


def test_nothing_marked_leaves_it_as_it_is() -> None:
    surface = on_unit_sphere(1)
    same = bisected(surface, np.zeros(len(surface.edges()), dtype=bool), "key")
    assert np.array_equal(same.vertices, surface.vertices)
    turned = [np.roll(face, -np.argmin(face)).tolist() for face in same.faces]
    assert sorted(turned) == sorted(np.roll(f, -np.argmin(f)).tolist() for f in surface.faces)


def test_too_many_vertices_name_the_key(monkeypatch: pytest.MonkeyPatch) -> None:
    surface = on_unit_sphere(1)
    monkeypatch.setattr(sizes, "MOST_VERTICES", len(surface.vertices))
    with pytest.raises(InputError, match=r"continuity\.border_length_m: has .* vertices, at most"):
        bisected(surface, np.ones(len(surface.edges()), dtype=bool), "continuity.border_length_m")
