"""Rounded lines lie on the surface, cut corners as a bell curve does, and keep off edges."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from painted import flat_grid
from scipy.sparse.csgraph import dijkstra

from cellcolor.arrays import unit
from cellcolor.deadline import NEVER
from cellcolor.tool_paths.registry import Laid
from cellcolor.tool_paths.rounding import Line, line_of, rounded
from cellcolor.tool_paths.triangles import Triangles
from examples import examples

SPACING = 0.1
BELL = 0.3 * SPACING


def sheet(size: int, seed: int | None = None) -> Triangles:
    """A unit square; with a seed its inner vertices are moved, and it is bent smoothly."""
    flat = flat_grid(size, size, 1 / (size - 1))
    if seed is None:
        return flat
    points, inside = flat.points.copy(), ~flat.border
    noise = np.random.default_rng(seed).uniform(-0.3, 0.3, (len(points), 2)) / size
    points[inside, :2] += noise[inside]
    points[:, 2] = 0.05 * np.sin(3 * points[:, 0]) * np.sin(4 * points[:, 1])
    bent = replace(flat, points=points)
    normals = np.zeros_like(points)
    np.add.at(normals, bent.corners, bent.area_vectors[:, None])
    return replace(bent, normals=unit(normals))


def assert_on_mesh(line: Line) -> None:
    """Each step's ends are in its triangle, by areas: no barycentric coordinates."""
    mesh = line.mesh
    for k, triangle in enumerate(line.triangles):
        corners = mesh.points[mesh.corners[triangle]]
        whole = np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0]))
        for point in line.points[k : k + 2]:
            parts = [
                np.linalg.norm(np.cross(corners[i] - point, corners[i - 1] - point))
                for i in range(3)
            ]
            assert sum(parts) == pytest.approx(whole, rel=1e-5)


@given(st.integers(0, 10**6))
@examples(10)
def test_a_line_is_on_the_surface_near_the_walk(seed: int) -> None:
    """Between random vertices, along shortest ways of random weights."""
    mesh, rng = sheet(25, seed), np.random.default_rng(seed)
    stops = rng.choice(np.flatnonzero(~mesh.border), 4, replace=False).tolist()
    walk = [stops[0]]
    weights = mesh.lengths * rng.uniform(1, 3, len(mesh.edges))
    for stop in stops[1:]:
        before = dijkstra(mesh.graph(weights), indices=walk[-1], return_predecessors=True)[1]
        way = [stop]
        while way[-1] != walk[-1]:
            way.append(int(before[way[-1]]))
        walk += way[-2::-1]
    line = rounded(Laid(mesh, walk), SPACING, NEVER)
    assert_on_mesh(line)
    assert (line.points[[0, -1]] == mesh.points[[walk[0], walk[-1]]]).all()
    walked = line_of(Laid(mesh, walk)).points
    fine = np.concatenate([np.linspace(a, b, 40) for a, b in pairwise(walked)])
    far = np.linalg.norm(line.points[:, None] - fine[None], axis=2).min(axis=1)
    assert far.max() < BELL
    length, before = (
        np.linalg.norm(np.diff(points, axis=0), axis=1).sum() for points in (line.points, walked)
    )
    assert length < before


def test_a_corner_is_cut_as_a_bell_curve_does() -> None:
    """By the deviation over the square root of pi, and without a sharp turn."""
    size = 41
    mesh = sheet(size)
    row = [20 * size + column for column in range(5, 21)]
    walk = [*row, *(line * size + 20 for line in range(21, 36))]
    line = rounded(Laid(mesh, walk), SPACING, NEVER)
    corner = mesh.points[20 * size + 20]
    fine = np.concatenate([np.linspace(a, b, 40) for a, b in pairwise(line.points)])
    nearest = np.linalg.norm(fine - corner, axis=1).min()
    assert nearest == pytest.approx(BELL / np.sqrt(np.pi), rel=0.1)
    steps = np.diff(line.points, axis=0)
    steps /= np.linalg.norm(steps, axis=1, keepdims=True)
    assert (steps[1:] * steps[:-1]).sum(axis=1).min() > np.cos(np.radians(30))


def test_over_a_sharp_edge_the_walk_stays() -> None:
    """A sheet folded by 90 degrees along its middle; far from the fold corners are rounded."""
    size = 41
    flat = sheet(size)
    points = flat.points.copy()
    folded = points[:, 0] > 0.5
    points[folded, 2] = -(points[folded, 0] - 0.5)
    points[folded, 0] = 0.5
    normals = np.where(folded[:, None], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    mesh = Triangles(points, flat.corners, normals, flat.faces)
    walk = [10 * size + column for column in range(5, 36)]
    walk += [line * size + 35 for line in range(11, 36)]
    line = rounded(Laid(mesh, walk), SPACING, NEVER)
    assert_on_mesh(line)
    kept = set(line.vertices.tolist())
    assert {10 * size + column for column in (20, 21)} <= kept  # at the fold
    assert 10 * size + 35 not in kept
