"""What follows from a mesh, held to plain walks over its triangles and to trimesh."""

from __future__ import annotations

import math
from collections import defaultdict

import networkx as nx
import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from triangles import any_meshes, bumpy_ball

from cellcolor.mesh.triangle_mesh import TriangleMesh

SEEDS = st.integers(0, 10**6)


def sides_by_edge(mesh: TriangleMesh) -> dict[tuple[int, int], list[int]]:
    """The sides, as 3 * triangle + corner, that each pair of points is."""
    found: dict[tuple[int, int], list[int]] = defaultdict(list)
    for number, (a, b, c) in enumerate(mesh.corners.tolist()):
        for corner, (i, j) in enumerate(((a, b), (b, c), (c, a))):
            found[min(i, j), max(i, j)].append(3 * number + corner)
    return dict(sorted(found.items()))


def same_groups(first: np.ndarray, second: np.ndarray) -> bool:
    """Whether two numberings put the same things together."""
    pairs = set(zip(first.tolist(), second.tolist(), strict=True))
    return len(pairs) == len(set(first.tolist())) == len(set(second.tolist()))


@given(any_meshes())
def test_edges_and_sides(mesh: TriangleMesh) -> None:
    expected = sides_by_edge(mesh)
    assert [tuple(ends) for ends in mesh.edges.tolist()] == list(expected)
    assert mesh.triangles_at.tolist() == [len(sides) for sides in expected.values()]
    for number, sides in enumerate(expected.values()):
        assert (mesh.edge_of_side.ravel()[sides] == number).all()
    twos = [(number, sides) for number, sides in enumerate(expected.values()) if len(sides) == 2]
    edges, sides_of_two = mesh.pairs
    assert list(zip(edges.tolist(), sides_of_two.tolist(), strict=True)) == twos
    on_border = {end for ends, sides in expected.items() if len(sides) == 1 for end in ends}
    assert set(np.flatnonzero(mesh.border).tolist()) == on_border
    for (a, b), length in zip(expected, mesh.lengths, strict=True):
        assert length == pytest.approx(math.dist(mesh.points[a], mesh.points[b]))


@given(any_meshes(), st.data())
def test_edges_are_found_by_their_ends(mesh: TriangleMesh, data: st.DataObject) -> None:
    edges = list(sides_by_edge(mesh))
    asked = data.draw(st.lists(st.sampled_from(edges)))
    turned = [data.draw(st.sampled_from([edge, edge[::-1]])) for edge in asked]
    numbers = [edges.index(edge) for edge in asked]
    assert mesh.find(np.array(turned, dtype=np.int64).reshape(-1, 2)).tolist() == numbers
    assert np.flatnonzero(mesh.marked(turned)).tolist() == sorted(set(numbers))


@given(any_meshes(), st.data())
def test_parts_are_those_of_a_graph_of_triangles(mesh: TriangleMesh, data: st.DataObject) -> None:
    expected = sides_by_edge(mesh)
    flags = st.lists(st.booleans(), min_size=len(expected), max_size=len(expected))
    closed = np.array(data.draw(flags))
    for barred in (None, closed):
        graph = nx.empty_graph(len(mesh.corners))
        for number, sides in enumerate(expected.values()):
            if barred is None or not barred[number]:
                nx.add_path(graph, [side // 3 for side in sides])
        number_of = np.empty(len(mesh.corners), dtype=np.int64)
        for number, members in enumerate(nx.connected_components(graph)):
            number_of[list(members)] = number
        assert same_groups(mesh.parts(barred), number_of)


@given(any_meshes())
def test_areas_and_normals(mesh: TriangleMesh) -> None:
    """By trimesh, and summed up at the corners; coordinates are whole."""
    places, at = mesh.points[mesh.corners], mesh.corners.ravel()
    areas, (normals, there) = trimesh.triangles.area(places), trimesh.triangles.normals(places)
    assert mesh.areas == pytest.approx(areas, abs=1e-9)
    assert np.allclose(mesh.triangle_normals[there], normals)
    assert np.isnan(mesh.triangle_normals[~there]).all() and not areas[~there].any()
    assert np.allclose(mesh.area_vectors[there], 2 * areas[there, None] * normals)
    owned = np.bincount(at, np.repeat(areas / 3, 3), minlength=len(mesh.points))
    assert mesh.vertex_areas == pytest.approx(owned)
    sums = np.zeros_like(mesh.points)
    np.add.at(sums, at, np.repeat(mesh.area_vectors, 3, axis=0))
    for total, normal in zip(sums, mesh.vertex_normals, strict=True):
        length = np.linalg.norm(total)
        assert np.allclose(normal, total / length if length > 0 else [0, 0, 1])


@given(SEEDS, st.floats(0.0, 60.0), st.floats(0.0, 1.0))
def test_closed_meshes_as_trimesh_has_them(seed: int, degrees: float, turned: float) -> None:
    mesh = bumpy_ball(seed)
    other = trimesh.Trimesh(mesh.points, mesh.corners, process=False)
    assert not mesh.border.any()
    assert mesh.edges.tolist() == np.unique(other.edges_sorted, axis=0).tolist()
    assert mesh.areas.sum() == pytest.approx(other.area)
    assert np.allclose(mesh.triangle_normals, other.face_normals)
    # Sharp edges stay what they are if some triangles are wound the other way.
    rng = np.random.default_rng(seed)
    corners = mesh.corners.copy()
    over = rng.random(len(corners)) < turned
    corners[over] = corners[over, ::-1]
    sharp = mesh.edges[TriangleMesh(mesh.points, corners).sharp_edges(np.radians(degrees))]
    apart = np.sort(other.face_adjacency_edges[other.face_adjacency_angles > np.radians(degrees)])
    assert {tuple(ends) for ends in sharp.tolist()} == {tuple(ends) for ends in apart.tolist()}


@given(SEEDS, st.integers(0, 5))
def test_borders_go_round_the_holes_that_were_made(seed: int, most: int) -> None:
    """The triangles around some points are left out; none of these holes touch."""
    ball = bumpy_ball(seed)
    graph = nx.Graph(ball.edges.tolist())
    expected: list[set[int]] = []
    left_out: set[int] = set()
    for point in np.random.default_rng(seed).permutation(len(ball.points)).tolist()[:most]:
        if left_out.isdisjoint(nx.ego_graph(graph, point, 2)):
            left_out |= set(nx.ego_graph(graph, point, 1))
            expected.append(set(graph[point]))
    centers = {p for p in left_out if not any(p in ring for ring in expected)}
    kept = [corners for corners in ball.corners.tolist() if centers.isdisjoint(corners)]
    loops = TriangleMesh(ball.points, np.array(kept)).border_loops()
    assert [set(loop) for loop in loops] == sorted(expected, key=min)
    wound = {(i, j) for a, b, c in kept for i, j in ((a, b), (b, c), (c, a))}
    for loop in loops:
        assert len(loop) == len(set(loop))
        for i, j in zip(loop, loop[1:] + loop[:1], strict=True):
            assert (j, i) in wound and (i, j) not in wound


@given(SEEDS, st.integers(1, 5))
def test_shares_are_those_that_a_point_was_made_with(seed: int, count: int) -> None:
    mesh, rng = bumpy_ball(seed), np.random.default_rng(seed)
    shares = rng.dirichlet([1.0, 1.0, 1.0], count)
    triangles = rng.integers(len(mesh.corners), size=count)
    points = (shares[:, :, None] * mesh.points[mesh.corners[triangles]]).sum(axis=1)
    assert np.allclose(mesh.shares(triangles, points), shares)


def test_a_mesh_without_triangles() -> None:
    mesh = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))
    assert mesh.edges.shape == (0, 2) and mesh.pairs[1].shape == (0, 2)
    assert mesh.parts().shape == (0,) and mesh.vertex_areas.shape == (0,)
