"""Rooms that segments cross in pieces of one color, on graphs and meshes, and whether they can.

Hubs with petals: a cell of all colors, and cells of one color or more all round it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import chain, count

import networkx as nx
from hypothesis import strategies as st
from meshes import grid_faces, grid_points, surface
from ortools.sat.python import cp_model

from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.lab.families.meshes import make_mesh
from cellcolor.solvers.bounds.cover import color_regions, set_cover
from cellcolor.solvers.cpsat.segment_plans import Planner

RED, BLUE, GREEN = 0, 1, 2


def graph(
    *cells: Sequence[Sequence[int]], cracks: Mapping[int, tuple[int, ...]] | None = None
) -> Instance:
    """Each cell as its colors and its loops; edges lie between the cells that have their darts.

    ``cracks`` has the joinable colors of edges that are cracked in some.
    """
    cell_of = {dart: n for n, (_, *loops) in enumerate(cells) for loop in loops for dart in loop}
    return Instance(
        "graph",
        tuple(f"color {c}" for c in range(1 + max(max(colors) for colors, *_ in cells))),
        tuple(
            Cell(n, tuple(colors), tuple(map(tuple, loops)))
            for n, (colors, *loops) in enumerate(cells)
        ),
        tuple(
            Edge(e, cell_of.get(e, OUTSIDE), cell_of.get(-e, OUTSIDE), (cracks or {}).get(e))
            for e in sorted(set(map(abs, cell_of)))
        ),
    )


def petal_cells(*colors: int | Sequence[int]) -> list[Sequence[Sequence[int]]]:
    """Cells for ``graph`` in these colors, across the darts 1, 2, … of another cell."""
    return [
        ((own,) if isinstance(own, int) else own, (-dart,))
        for dart, own in enumerate(colors, start=1)
    ]


def room(*loops: Sequence[int | tuple[int, ...]]) -> Instance:
    """A cell of all colors with petals round its loops, numbered from 1 as they come."""
    numbers = count(1)
    own = [[next(numbers) for _ in loop] for loop in loops]
    return graph(((RED, BLUE, GREEN), *own), *petal_cells(*chain(*loops)))


ISLAND_BETWEEN = room((RED, BLUE, RED, GREEN), (BLUE, GREEN))
"""Red, from left to right, passes the island above, where blue comes from, or below, as green."""


ROUND_A_PETAL = room((GREEN, RED, (BLUE, GREEN), RED, GREEN, (RED, BLUE)))
"""Blue passes from petal 3 to petal 6 only if red, from petal 2 to 4, goes round petal 6."""


@st.composite
def rooms(draw: st.DrawFn, width: int, height: int) -> LabelledSurface:
    """A frame in pieces of one color, and an island of two around which segments may pass."""
    several = st.sampled_from([(RED, BLUE, GREEN)] * 8 + [(RED, BLUE), (RED, GREEN)])
    rim = [(0, column) for column in range(width)]
    rim += [(row, width - 1) for row in range(1, height)]
    rim += [(height - 1, column) for column in reversed(range(width - 1))]
    rim += [(row, 0) for row in reversed(range(1, height - 1))]
    pieces: list[tuple[int, ...]] = draw(st.permutations([(RED,), (RED,), (BLUE,), (GREEN,)]))
    further = st.sampled_from([(RED,), (BLUE,), (GREEN,), (RED, BLUE), (BLUE, GREEN)])
    pieces += draw(st.lists(further, max_size=3))
    labels: dict[tuple[int, int], Sequence[int]] = {
        place: pieces[number * len(pieces) // len(rim)] for number, place in enumerate(rim)
    }
    halves = draw(several), draw(several)
    for row in range(1, height - 1):
        for column in range(1, width - 1):
            labels[row, column] = halves[2 * row > height]
    row, column = draw(st.integers(2, height - 4)), draw(st.integers(2, width - 3))
    upper, lower = draw(st.sampled_from([(BLUE, GREEN), (GREEN, BLUE), (RED, BLUE)]))
    labels[row, column], labels[row + 1, column] = (upper,), (lower,)
    return surface(
        grid_points(width, height),
        grid_faces(width, height),
        [labels[row, column] for row in range(height) for column in range(width)],
    )


def can_be_drawn(
    mesh: LabelledSurface, segments: Sequence[tuple[int, list[set[int]], set[int]]]
) -> bool:
    """Whether disjoint sets of mesh vertices exist, each connected in its color from a first set of
    vertices to a second without some others: every path without shortcuts is tried for all but the
    last."""
    mesh_graph: nx.Graph[int] = nx.Graph(mesh.left_of.keys())
    graphs = [
        mesh_graph.subgraph(
            v for v, own in enumerate(mesh.vertex_colors) if color in own and v not in avoided
        )
        for color, _, avoided in segments
    ]

    def fits(number: int, used: set[int]) -> bool:
        if any(
            not any(
                not part.isdisjoint(ends[0]) and not part.isdisjoint(ends[1])
                for part in nx.connected_components(graph.subgraph(graph.nodes - used))
            )
            for graph, (_, ends, _) in list(zip(graphs, segments, strict=True))[number:]
        ):
            return False
        if number == len(segments) - 1:
            return True
        graph, (start, end) = graphs[number], segments[number][1]

        def extend(path: list[int]) -> bool:
            if path[-1] in end:
                return fits(number + 1, used | set(path))
            near = set().union(*(graph[v] for v in path[:-1])) | set(path) | used
            return any(extend([*path, v]) for v in sorted(graph[path[-1]]) if v not in near)

        return any(extend([v]) for v in sorted(start - used))

    return fits(0, set())


@st.composite
def crossed_rings(draw: st.DrawFn) -> LabelledSurface:
    """Two narrow rings over a torus, one along it and one around it, in red, blue and both.

    The rings cross each other, so what red and blue reach covers the handle. A ring falls into
    cells of both colors with and without green, as no cell may lie around the handle.
    """
    size, width = 6, draw(st.integers(1, 2))
    vertices, faces = make_mesh("torus", size)
    kinds = st.sampled_from([(RED,), (BLUE,), None])
    labels: list[Sequence[int]] = []
    for row in range(size):
        for column in range(size):
            both = (RED, BLUE) if (row // 3 + column // 3) % 2 else (RED, BLUE, GREEN)
            inside = row < width or column < width
            labels.append((draw(kinds) or both) if inside else (GREEN,))
    return LabelledSurface("rings", ("red", "blue", "green"), vertices, faces, tuple(labels))


def hub(*colors: int | tuple[int, ...]) -> Instance:
    """A cell of all colors, two at least, with petals in these colors, each in one or more."""
    around = petal_cells(*colors)
    every = range(max(1, *(max(own) for own, _ in around)) + 1)
    return graph((every, range(1, len(colors) + 1)), *around)


def four_colors_in_turn(petals: int) -> Instance:
    """A hub however large, made at once, since no minimum is worked out with it."""
    return hub(*(number % 4 for number in range(petals)))


def planner_of(instance: Instance, deadline: Deadline = NEVER) -> Planner:
    """Plans of an instance's segments, by one worker of CP-SAT each."""

    def run(
        model: cp_model.CpModel, seed: int
    ) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
        solver = cp_model.CpSolver()
        solver.parameters.num_workers = 1
        solver.parameters.random_seed = seed
        solver.parameters.max_time_in_seconds = deadline.left
        return solver, solver.solve(model)

    return Planner(instance, color_regions(instance), set_cover(instance).bound, run)
