"""Validity between vertices: on a strip by hand, and that it is asked for on a scene."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from shipped import WOK

from cellcolor.frontend import BuildResult, build_surface
from cellcolor.frontend.between import along_edges, at_domain_border, remains_valid
from cellcolor.frontend.generators import disc_mesh
from cellcolor.frontend.prepare import prepare
from cellcolor.frontend.robot import Array
from cellcolor.frontend.surfaces import Surface


def plane() -> Surface:
    flat, faces = disc_mesh(37, 0.0, 0)
    vertices = np.column_stack([flat, np.zeros(len(flat))])
    return Surface(vertices, faces, np.tile([0.0, 0.0, 1.0], (len(flat), 1)))


def test_a_gap_on_the_edge_is_found_and_nothing_else() -> None:
    surface = plane()
    edges = surface.edges()
    branches = np.zeros(len(edges), dtype=np.intp)

    def test(points: Array, directions: Array, branch: Array) -> Array:
        assert (directions == [0, 0, -1]).all() and len(branch) == len(points)
        return np.abs(points[:, 0] - 0.21) > 0.01  # a strip without a vertex

    found = remains_valid(surface, edges, branches, 0.015, test)
    across = (surface.vertices[edges][:, :, 0] < 0.21).sum(axis=1) == 1
    assert (found == ~across).all() and across.any()


def test_many_points_are_asked_in_batches(monkeypatch: pytest.MonkeyPatch) -> None:
    surface = plane()
    edges = surface.edges()
    asked: list[int] = []

    def test(points: Array, _: Array, __: Array) -> Array:
        asked.append(len(points))
        return points[:, 1] > 0

    branches = np.zeros(len(edges), dtype=np.intp)
    whole = remains_valid(surface, edges, branches, 0.01, test)

    monkeypatch.setattr("cellcolor.frontend.between._AT_ONCE", 100)
    total = asked.pop()
    batched = remains_valid(surface, edges, branches, 0.01, test)
    assert (batched == whole).all()
    # A batch ends with a whole edge of at most 40 points.
    assert sum(asked) == total and max(asked) <= 140


def test_points_are_on_the_edge_in_order() -> None:
    surface = plane()
    edges = surface.edges()[:1]
    points, _ = along_edges(surface, np.repeat(edges, 3, axis=0), np.array([0.0, 0.25, 1.0]))
    start, end = surface.vertices[edges[0]]
    assert np.allclose(points, [start, start + (end - start) / 4, end])


def test_border_of_a_domain() -> None:
    edges = np.array([[0, 1], [1, 2], [2, 3], [3, 4]])
    valid = np.array([[False, True], [True, True], [True, True], [True, True], [True, True]])
    # Vertex 1 is beside the vertex that the first branch does not reach.
    assert at_domain_border(edges, valid)[:, 0].tolist() == [True, True, False, False]
    assert not at_domain_border(edges, valid)[:, 1].any()


def test_asked_for_in_the_setup(scene: Callable[..., Path]) -> None:
    """A narrow post cuts links whose two ends it does not touch."""
    file = scene(target_vertices=200)
    post = '\n[[obstacle]]\nkind = "cylinder"\nradius_m = 0.004\nheight_m = 0.3\n'
    file.write_text(file.read_text() + post + "position_m = [0.3, 0.02, 0.15]\n")
    asked = build_surface(file)
    setup = file.parent / "ur5_polishing.toml"
    setup.write_text(setup.read_text().replace("validity_spacing_m = 0.001", ""))
    trusting = build_surface(file)
    assert (asked.reasons == trusting.reasons).all()

    def torn(result: BuildResult) -> set[tuple[int, int, str]]:
        names = result.surface.colors
        return {(c.i, c.j, names[k]) for c in result.surface.cracks for k in c.colors}

    assert len(torn(asked)) > len(torn(trusting)) or len(asked.surface.colors) > len(
        trusting.surface.colors
    )


def test_a_branch_followed_alone_is_the_same() -> None:
    stage = prepare(WOK)
    points, directions = stage.surface.vertices, -stage.surface.normals
    branches = np.random.default_rng(2).integers(8, size=len(points))
    expected = stage.inverse(points, directions)[np.arange(len(points)), branches]
    found = stage.follow(points, directions, branches)
    np.testing.assert_array_equal(found, expected)
    assert np.isfinite(found).all(axis=1).mean() > 0.5
    assert stage.follow(points[:0], directions[:0], branches[:0]).shape == (0, 6)
