"""Borders of colors bisected: only there, as short as asked for, and asked of the robot."""

from __future__ import annotations

import numpy as np
import pytest
from shipped import shipped

from cellcolor.data.candidate_table import VALID
from cellcolor.errors import InputError
from cellcolor.frontend import build_surface
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.links import Links
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.reach.continuity import Coloring
from cellcolor.frontend.scene import Scene

LONGEST = 0.012


def scene(border_length_m: float | None) -> Scene:
    """A small wok before an obstacle, with colors that end in many places."""
    plain = shipped("wok_obstacle", 150)
    keys = {"border_length_m": border_length_m}
    return plain.varied(setup=plain.setup.varied(slivers=None, continuity=keys))


@pytest.fixture(scope="module")
def coarse() -> BuildResult:
    return build_surface(scene(None))


@pytest.fixture(scope="module")
def fine() -> BuildResult:
    return build_surface(scene(LONGEST))


def crossing(built: BuildResult) -> list[tuple[int, int]]:
    """The mesh edges whose ends have different colors, or that have a crack."""
    surface = built.surface
    cracked = {(crack.i, crack.j) for crack in surface.cracks}
    colors = surface.vertex_colors
    edges = {(min(edge), max(edge)) for edge in surface.left_of}
    return [(a, b) for a, b in edges if colors[a] != colors[b] or (a, b) in cracked]


def length(built: BuildResult, edge: tuple[int, int]) -> float:
    a, b = built.surface.vertices[list(edge)]
    return float(np.linalg.norm(a - b))


def test_no_edge_at_a_border_is_longer(coarse: BuildResult, fine: BuildResult) -> None:
    assert max(length(coarse, edge) for edge in crossing(coarse)) > 3 * LONGEST
    assert max(length(fine, edge) for edge in crossing(fine)) <= LONGEST


def test_vertices_are_added_at_borders_only(coarse: BuildResult, fine: BuildResult) -> None:
    """Each new one is no farther from a border than the mesh edges are long that were there."""
    count = len(coarse.surface.vertices)
    places = fine.surface.vertices
    assert np.array_equal(places[:count], coarse.surface.vertices)
    middles = np.array([places[list(edge)].mean(axis=0) for edge in crossing(fine)])
    gaps = np.linalg.norm(places[count:, None] - middles[None], axis=2).min(axis=1)
    faces = coarse.surface.vertices[coarse.surface.faces]
    assert gaps.max() <= 2 * np.linalg.norm(faces - np.roll(faces, 1, axis=1), axis=2).max()


def test_new_vertices_are_asked_like_any_other(fine: BuildResult) -> None:
    """Inverse kinematics and tests once more, from the points and normals alone."""
    prepared = prepare(fine.scene)
    mesh = fine.stages.surface
    assert len(mesh.vertices) > len(prepared.surface.vertices)
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1)
    # The wok is a part of a sphere: what lies on its triangles has nearly its radius's direction.
    solutions = prepared.arm.inverse(mesh.vertices, -mesh.normals)
    verdicts = prepared.judge(solutions.reshape(-1, solutions.shape[2]))
    valid = (verdicts.reasons == VALID).reshape(solutions.shape[:2])
    assert np.array_equal(valid, fine.node_color >= 0)
    assert [len(colors) for colors in fine.surface.vertex_colors] == valid.sum(axis=1).tolist()


def test_without_the_key_nothing_is_said_of_it() -> None:
    """Surfaces that were built before there was such a key stay the same to the byte."""
    assert "border_length_m" not in scene(None).setup.model_dump()["continuity"]
    assert scene(LONGEST).setup.model_dump()["continuity"]["border_length_m"] == LONGEST


def test_a_length_that_is_far_too_small_is_refused() -> None:
    with pytest.raises(InputError, match=r"continuity\.border_length_m"):
        scene(0.0)


def crossing_length(links: Links, coloring: Coloring, mesh: Surface) -> float:
    """The longest mesh edge whose ends have different colors, m."""
    here, there = (coloring.node_color[end] for end in links.edges.T)
    return float(mesh.lengths(links.edges)[(here != there).any(axis=1)].max())


def test_borders_that_the_sliver_policy_takes_are_made_finer_as_well() -> None:
    """Which cells it takes hangs on their areas, and so on borders that are gone afterwards."""
    plain = shipped("wok_obstacle", 150)
    keys, policy = {"border_length_m": 0.006}, {"simplify_below_share": 0.1}
    made = build_surface(
        plain.varied(setup=plain.setup.varied(continuity=keys, slivers=policy))
    ).stages
    left = crossing_length(made.cleaned.links, made.cleaned.coloring, made.surface)
    before = crossing_length(made.links, made.coloring, made.surface)
    assert left <= 0.006 < before <= 4 * 0.006
