"""What a path's contacts make of a surface: section 9 of docs/semantics.md, held as properties."""

from __future__ import annotations

from itertools import pairwise

import networkx
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from meshes import drawn, surfaces

import cellcolor
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.door.joint_plans import coloring_of
from cellcolor.oracle import ProvenRange
from examples import examples

RED, BLUE = 0, 1
Rows = list[tuple[int, int, int]]
"""Stroke, vertex and color of each contact."""


def colored(surface: LabelledSurface, rows: Rows) -> tuple[Plan, int, int]:
    return coloring_of(surface, *np.array(rows, dtype=np.int64).reshape(-1, 3).T)


def continuous(surface: LabelledSurface, color: int) -> networkx.Graph:
    """The vertices that have a color, and the mesh edges along which it is continuous."""
    own = [v for v, colors in enumerate(surface.vertex_colors) if color in colors]
    graph: networkx.Graph = networkx.Graph()
    graph.add_nodes_from(own)
    torn = {frozenset((crack.i, crack.j)) for crack in surface.cracks if color in crack.colors}
    for face in surface.faces.tolist():
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            if a in own and b in own and frozenset((a, b)) not in torn:
                graph.add_edge(a, b)
    return graph


@examples(40)
@given(surfaces(), st.data())
def test_no_fewer_runs_than_segments(surface: LabelledSurface, data: st.DataObject) -> None:
    """For any contacts in any order, as long as each vertex has one in a color of its own."""
    nodes = [(v, color) for v, own in enumerate(surface.vertex_colors) for color in own]
    order = data.draw(st.permutations(nodes)) + data.draw(
        st.lists(st.sampled_from(nodes), max_size=10) if nodes else st.just([])
    )
    lifted = data.draw(st.lists(st.booleans(), min_size=len(order), max_size=len(order)))
    strokes = np.cumsum(lifted).tolist()
    rows = [(s, v, color) for s, (v, color) in zip(strokes, order, strict=True)]
    plan, found_changes, runs = colored(surface, rows)
    firsts: dict[int, int] = {}
    for _, vertex, color in rows:
        firsts.setdefault(vertex, color)
    colors = plan.vertex_colors
    assert {v: color for v, color in enumerate(colors) if color is not None} == firsts
    report = check_plan(surface, plan)
    assert report.segments is not None and report.segments <= runs
    changes = [one[0] == other[0] and one[2] != other[2] for one, other in pairwise(rows)]
    assert found_changes == sum(changes)


@examples(40)
@given(surfaces(), st.data())
def test_a_path_that_follows_the_mesh(surface: LabelledSurface, data: st.DataObject) -> None:
    """Strokes that walk along uncracked edges, no vertex in two colors: as many runs as strokes.

    So there are at least as many strokes as segments, and as the proved minimum.
    """
    left = {v for v, own in enumerate(surface.vertex_colors) if own}
    rows: Rows = []
    stroke = 0
    while left:
        start = data.draw(st.sampled_from(sorted(left)))
        color = data.draw(st.sampled_from(surface.vertex_colors[start]))
        graph = continuous(surface, color).subgraph(left)
        tree = networkx.dfs_tree(graph, start)
        most = data.draw(st.integers(1, len(tree)))
        walk = list(networkx.dfs_preorder_nodes(tree, start))[:most]
        rows.append((stroke, start, color))
        for one, other in pairwise(walk):
            way = networkx.shortest_path(tree.to_undirected(as_view=True), one, other)
            rows += [(stroke, v, color) for v in way[1:]]
        left -= set(walk)
        stroke += 1
    plan, changes, runs = colored(surface, rows)
    assert (runs, changes) == (stroke, 0)
    verdict = cellcolor.judge(surface, plan)
    assert verdict.segments is not None and verdict.bounds is not None
    assert verdict.bounds.lower <= verdict.segments <= stroke


def test_strokes_that_cross_can_be_fewer_than_segments() -> None:
    """A red stroke from left to right and a blue one from top to bottom over one vertex of both."""
    cross = drawn(".B. RMR .B.", {"R": [RED], "B": [BLUE], "M": [RED, BLUE], ".": []})
    over = [(0, 3, RED), (0, 4, RED), (0, 5, RED), (1, 1, BLUE), (1, 4, BLUE), (1, 7, BLUE)]
    plan, _, runs = colored(cross, over)
    assert (plan.vertex_colors[4], runs) == (RED, 3)
    assert check_plan(cross, plan).segments == 3
    assert cellcolor.proven_range(cross) == ProvenRange(3, 3)


def test_where_a_run_ends() -> None:
    """At a leap, at a crack, with the stroke, and where the color changes."""
    row = drawn("AAAA AAAA", {"A": [RED, BLUE]}, cracks=[(1, 2, RED), (1, 2, BLUE)])
    cases: list[tuple[Rows, int, int]] = [
        ([(0, 0, RED), (0, 1, RED), (0, 1, RED)], 1, 0),
        ([(0, 0, RED), (0, 2, RED)], 2, 0),
        ([(0, 1, RED), (0, 2, RED)], 2, 0),
        ([(0, 0, RED), (1, 1, RED)], 2, 0),
        ([(0, 0, RED), (0, 1, BLUE)], 2, 1),
        # The second contact of vertex 1 is in another color than its first, and counts for nothing.
        ([(0, 1, RED), (1, 0, BLUE), (1, 1, BLUE), (1, 4, BLUE)], 2, 0),
    ]
    for rows, runs, changes in cases:
        assert colored(row, rows)[1:] == (changes, runs), rows
    assert colored(row, [])[0].vertex_colors == (None,) * 8
