"""Sliver policies: on a strip by hand, and what they promise on a scene with many small cells."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shipped import shipped

from cellcolor.arrays import Array
from cellcolor.decomposition import decompose
from cellcolor.frontend import BuildResult, build_surface
from cellcolor.frontend.parts.shapes import RectangleObject
from cellcolor.frontend.reach.colors import Coloring, color_nodes
from cellcolor.frontend.reach.slivers import SliverReport, _cells, clean
from cellcolor.frontend.setup import Slivers
from examples import examples


def row(*sets: str) -> tuple[Array, Array, Coloring]:
    """Vertices in a row, with the branches a, b, c that reach each; all of it continuous."""
    nodes = np.array([[letter in text for letter in "abc"] for text in sets])
    edges = np.array([[k, k + 1] for k in range(len(sets) - 1)])
    linked = nodes[:-1] & nodes[1:]
    node_color = np.where(nodes, np.arange(3), -1)
    return edges, linked, Coloring(("a", "b", "c"), (0, 1, 2), node_color, linked, ())


def cleaned(
    simplify: float, uncover: float, *sets: str, crack: tuple[int, int] | None = None
) -> tuple[list[str], SliverReport]:
    """Thresholds in vertices; ``crack`` is an edge and a branch."""
    edges, linked, coloring = row(*sets)
    if crack is not None:
        linked[crack] = False
    share = 1 / len(sets)
    policy = Slivers(
        simplify_below_share=simplify * share * 0.99, uncover_below_share=uncover * share * 0.99
    )
    kept, report = clean(edges, coloring, np.ones(len(sets)), policy)
    return ["".join(np.array(list("abc"))[r]) for r in kept], report


def test_off_changes_nothing() -> None:
    sets = ["a", "ab", "abc", "", "b"]
    assert cleaned(0, 0, *sets) == (sets, SliverReport(0, 0.0, 0, 0, 0.0))


def test_neighbor_with_most_colors_is_preferred() -> None:
    assert cleaned(2, 0, "a", "a", "abc", "bc", "bc")[0] == ["a", "a", "bc", "bc", "bc"]


def test_not_across_a_crack_of_the_colors_taken_over() -> None:
    sets = ["a", "a", "ab", "abc", "abc"]
    assert cleaned(2, 0, *sets)[0] == ["a", "a", "a", "abc", "abc"]
    assert cleaned(2, 0, *sets, crack=(1, 0))[0] == sets


def rescanned(
    edges: Array, linked: Array, coloring: Coloring, areas: Array, policy: Slivers
) -> tuple[Array, list[float], int]:
    """The policies written down plainly: all cells are looked at again after every change.

    The nodes to keep, the areas of the cells that were simplified, how many were given up.
    """
    cell_of = _cells(edges, linked, coloring.node_color)
    first = np.unique(cell_of, return_index=True)[1]
    own = [frozenset(np.flatnonzero(coloring.node_color[v] >= 0).tolist()) for v in first]
    total, simplified = areas.sum(), []

    def sizes() -> list[tuple[float, int]]:
        found = np.bincount(cell_of, areas)
        return sorted((float(found[cell]), cell) for cell in np.unique(cell_of).tolist())

    def border(cell: int, other: int, branches: frozenset[int]) -> int:
        """Mesh edges between two cells along which all the branches are continuous."""
        ends = cell_of[edges]
        between = (ends == [cell, other]).all(axis=1) | (ends == [other, cell]).all(axis=1)
        return int(linked[between][:, sorted(branches)].all(axis=1).sum())

    def simplify() -> bool:
        for area, cell in sizes():
            others = [c for c in np.unique(cell_of).tolist() if c != cell]
            choices = [
                (len(own[other]), border(cell, other, own[other]), -other)
                for other in others
                if own[other] and own[other] < own[cell]
            ]
            best = max((c for c in choices if c[1]), default=None)
            if best is not None and 0 < area < policy.simplify_below_share * total:
                simplified.append(area)
                own[cell] = own[-best[2]]
                same = [c for c in others if own[c] == own[cell] and border(cell, c, own[c])]
                cell_of[np.isin(cell_of, same)] = cell
                return True
        return False

    while simplify():
        pass
    small = [c for area, c in sizes() if own[c] and area < policy.uncover_below_share * total]
    for cell in small:
        own[cell] = frozenset()
    kept = [[branch in own[cell] for branch in range(linked.shape[1])] for cell in cell_of]
    return np.array(kept), simplified, len(small)


@examples(20)
@given(
    st.integers(0, 2**32 - 1), st.sampled_from([30, 120]), st.sampled_from([0.0, 0.02, 0.2]),
    st.sampled_from([0.02, 0.1, 0.5]), st.booleans(),
)  # fmt: skip
def test_like_looking_at_all_cells_again(
    seed: int, vertices: int, cracked: float, below: float, noisy: bool
) -> None:
    """Many small cells, equal areas and cracks between them: the same cells in the same order."""
    rng = np.random.default_rng(seed)
    surface = RectangleObject(
        size_x_m=1.0, size_y_m=1.0, target_vertices=vertices, jitter=0.2
    ).surface()
    x, y = surface.vertices[:, :2].T
    waves = [np.sin(rng.uniform(2, 9) * x + rng.uniform(0, 9) * y + phase) for phase in range(4)]
    nodes = np.stack(waves, axis=1) + noisy * rng.standard_normal((len(x), 4)) > -0.3
    edges = surface.mesh.edges
    linked = nodes[edges[:, 0]] & nodes[edges[:, 1]] & (rng.random((len(edges), 4)) >= cracked)
    names = ("a", "b", "c", "d")
    coloring = color_nodes(nodes, edges, linked, names)
    # Whole numbers: their sums are exact, so that equal areas are equal in whatever order.
    areas = rng.integers(1, 4, len(x)).astype(float)
    policy = Slivers(simplify_below_share=below, uncover_below_share=below / 2)
    kept, report = clean(edges, coloring, areas, policy)
    expected, simplified, given_up = rescanned(edges, linked, coloring, areas, policy)
    assert (kept == expected).all()
    assert (report.simplified_cells, report.simplified_area_m2) == (
        len(simplified),
        sum(simplified),
    )
    assert report.given_up_cells == given_up


@pytest.fixture(scope="module")
def results() -> dict[str, BuildResult]:
    """The tilted hemisphere without a policy and with the shipped one."""
    policy = shipped("hemisphere_tilted", 600)
    raw = policy.with_setup(policy.setup.varied(slivers=None))
    return {"raw": build_surface(raw), "policy": build_surface(policy)}


def test_fewer_cells_and_none_below_the_minimum_area(results: dict[str, BuildResult]) -> None:
    cells = {name: decompose(result.surface).cells for name, result in results.items()}
    least = 0.005 * results["policy"].report.area_m2
    assert len(cells["policy"]) < len(cells["raw"])
    assert min(cell.area or 0 for cell in cells["raw"]) < least
    assert min(cell.area or 0 for cell in cells["policy"]) >= least


def test_area_given_up_is_recorded(results: dict[str, BuildResult]) -> None:
    raw, policy = results["raw"], results["policy"]
    assert "slivers" not in raw.surface.meta and raw.report.slivers is None
    record = policy.surface.meta["slivers"]
    lost = [
        vertex
        for vertex, colors in enumerate(policy.surface.vertex_colors)
        if raw.surface.vertex_colors[vertex] and not colors
    ]
    corners = policy.surface.vertices[policy.surface.faces]
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    third = np.linalg.norm(sides, axis=1) / 6
    area = sum(third[(policy.surface.faces == vertex).any(axis=1)].sum() for vertex in lost)
    assert record["given_up_vertices"] == len(lost) > 0
    assert record["given_up_area_m2"] == pytest.approx(area)
    assert "uncovered" in str(policy.report)
