"""Random divisions of an instance: legal to draw, whatever they cost.

Paintings judged without the checker and the graph, and random divisions to be painted.

Random paintings: surfaces with cracks, holes and handles, and a random division painted.

Flat painted surfaces, of which areas and distances are known.
"""

from __future__ import annotations

import random
from collections import defaultdict
from itertools import pairwise

import networkx as nx
import numpy as np

from cellcolor.checker.dart_lists import live_lists
from cellcolor.data.cells_and_edges import Strand
from cellcolor.data.instance import Instance
from cellcolor.data.solution import (
    CellDivision,
    Division,
    InstanceReference,
    Seam,
    Solution,
    SubCell,
    count_segments,
)
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.decomposition import decomposition_of
from cellcolor.lab.families.meshes import grid_faces, make_mesh
from cellcolor.lab.families.surfaces import voronoi
from cellcolor.painting.paint import Painted, paint
from cellcolor.tool_paths.region import Segments
from cellcolor.tool_paths.triangles import Triangles


def random_seams(instance: Instance, strands: int, rng: random.Random) -> tuple[Seam, ...]:
    """Seams that connect all live loops of each cell, from random darts to random darts."""
    number = max((edge.id for edge in instance.edges), default=0)
    seams = []
    for cell in instance.cells:
        live = [loop for loop in cell.loops if any(instance.joinable(abs(d)) for d in loop)]
        for near, far in pairwise(live):
            number += 1
            seams.append(
                Seam(number, cell.id, rng.choice(near), rng.choice(far), rng.randint(0, strands))
            )
    return tuple(seams)


def random_division(
    instance: Instance, seams: tuple[Seam, ...], strands: int, rng: random.Random
) -> Division:
    """Each cell's darts in random non-crossing blocks of random colors; equal ones are joined."""
    blocks: list[list[list[Strand]]] = []
    colors: list[list[int]] = []
    favorite = rng.randrange(len(instance.colors))
    for cell, darts in zip(instance.cells, live_lists(instance, seams, strands), strict=True):
        blocks.append(_noncrossing(darts, rng))
        liked = favorite if favorite in cell.colors and rng.random() < 0.5 else None
        colors.append(
            [
                rng.choice(cell.colors) if liked is None or rng.random() < 0.5 else liked
                for _ in blocks[-1]
            ]
        )
    at = {
        strand: (cell, block)
        for cell, own in enumerate(blocks)
        for block, held in enumerate(own)
        for strand in held
    }
    virtual = {seam.id for seam in seams}
    kept: dict[tuple[int, int], list[Strand]] = defaultdict(list)
    graph: nx.Graph[tuple[int, int]] = nx.Graph()
    for (dart, strand), here in at.items():
        there = at.get((-dart, strand))
        if there is None or dart < 0:
            continue
        color = colors[here[0]][here[1]]
        allowed = abs(dart) in virtual or color in instance.joinable(abs(dart))
        if allowed and colors[there[0]][there[1]] == color:
            kept[here].append((dart, strand))
            kept[there].append((-dart, strand))
            graph.add_edge(here, there)
    segment: dict[tuple[int, int], int] = {}
    for number, parts in enumerate(nx.connected_components(graph)):
        segment |= dict.fromkeys(parts, number)
    count = len(set(segment.values()))
    cells = []
    for cell, own in zip(instance.cells, blocks, strict=True):
        held = [block for block in range(len(own)) if kept[cell.id, block]]
        if not held:
            cells.append(CellDivision(cell.id, (SubCell(rng.choice(cell.colors), (), count),)))
            count += 1
            continue
        cells.append(
            CellDivision(
                cell.id,
                tuple(
                    [
                        SubCell(
                            colors[cell.id][block],
                            tuple(
                                [
                                    dart if strands == 1 and not seams else (dart, strand)
                                    for dart, strand in kept[cell.id, block]
                                ]
                            ),
                            segment[cell.id, block],
                        )
                        for block in held
                    ]
                ),
            )
        )
    return tuple(cells)


def _noncrossing(darts: list[Strand], rng: random.Random) -> list[list[Strand]]:
    """A random non-crossing partition of a cyclic list."""
    if not darts:
        return [[]]
    blocks: list[list[Strand]] = []
    open_blocks: list[list[Strand]] = []
    for dart in darts:
        # Going back to an open block closes those that were opened after it.
        if open_blocks and rng.random() < 0.6:
            del open_blocks[rng.randrange(len(open_blocks)) + 1 :]
        else:
            open_blocks.append([])
            blocks.append(open_blocks[-1])
        open_blocks[-1].append(dart)
    return blocks


def random_solution(instance: Instance, strands: int, rng: random.Random) -> Solution:
    """A division drawn at random as a solution: legal to draw, whatever it costs."""
    seams = random_seams(instance, 2, rng)
    division = random_division(instance, seams, strands, rng)
    segments = count_segments(division)
    return Solution(
        InstanceReference(instance.name, instance.sha256), "surface", strands, "by chance",
        "feasible", segments, max(0, segments - 1), 0, 0, False, seams, division, 0.0,
    )  # fmt: skip


def flat_grid(rows: int, columns: int, step: float) -> Triangles:
    """A flat grid of squares, each cut in two, seen from above."""
    y, x = np.mgrid[0:rows, 0:columns] * step
    points = np.stack([x.ravel(), y.ravel(), np.zeros(rows * columns)], axis=1)
    up = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    faces = grid_faces(rows, columns)
    return Triangles(points, faces, up, np.arange(len(faces)))


def mean_cost(painted: Painted, cost: np.ndarray) -> float:
    """Of the painted area, of costs (m, colors) at the vertices that were painted."""
    own = np.flatnonzero(painted.segment_of >= 0)
    colors = [color for color in painted.plan.vertex_colors if color is not None]
    each = cost[painted.stands_for[own], colors]
    return float(np.average(each, weights=painted.surface.vertex_areas[own]))


def assert_whole(surface: LabelledSurface, painted: Painted, solution: Solution) -> None:
    """Every segment is one connected set of vertices in a color that all of them have.

    Flooded here over the refined mesh, with neither the checker nor the graph.
    """
    fine = painted.surface
    assert fine.vertex_colors[: len(surface.vertices)] == surface.vertex_colors
    assert np.allclose(painted.interpolated(surface.vertices), fine.vertices)
    assert solution.cells is not None and solution.segments is not None
    color = {sub.segment: sub.color for cell in solution.cells for sub in cell.subcells}
    cracks = {(crack.i, crack.j): crack.colors for crack in fine.cracks}
    members: dict[int, nx.Graph[int]] = {}
    for vertex, segment in enumerate(painted.segment_of.tolist()):
        own = fine.vertex_colors[vertex]
        assert (segment == -1) == (not own)
        if own:
            assert color[segment] in own
            assert painted.plan.vertex_colors[vertex] == color[segment]
            members.setdefault(segment, nx.Graph()).add_node(vertex)
    for a, b in fine.left_of:
        segment = int(painted.segment_of[a])
        if segment == -1 or segment != painted.segment_of[b]:
            continue
        if color[segment] not in cracks.get((min(a, b), max(a, b)), ()):
            members[segment].add_edge(a, b)
    assert all(nx.is_connected(graph) for graph in members.values())
    # What hangs on seams only is no part of the surface; all else is painted.
    assert len(members) <= solution.segments
    assert painted.segments == len(members) - sum(len(group) - 1 for group in painted.merged)


SHAPES = ("disc", "annulus", "sphere", "torus", "double torus")


def painted_at_random(seed: int, shape: str) -> Segments:
    """A painting with cells of one vertex, cracks, holes and seams."""
    rng = random.Random(seed)
    surface = voronoi(
        seed, shape, size=rng.randint(8, 12), regions=rng.randint(1, 12), colors=rng.randint(1, 4),
        scattered=rng.random() < 0.5, cracks=rng.choice((0, 4, 8)), islands=rng.choice((0, 3)),
        holes=rng.choice((0, 2)),
    )  # fmt: skip
    decomposition = decomposition_of(surface)
    instance = decomposition.instance
    seams = random_seams(instance, 2, rng)
    division = random_division(instance, seams, rng.randint(1, 2), rng)
    segments = count_segments(division)
    solution = Solution(
        InstanceReference(instance.name, instance.sha256), "surface", 2, "by chance",
        "feasible", segments, max(0, segments - 1), 0, 0, False, seams, division, 0.0,
    )  # fmt: skip
    painted = paint(surface, decomposition, solution)
    color = {sub.segment: sub.color for cell in division for sub in cell.subcells}
    colors = [color.get(number, -1) for number in range(max(color, default=-1) + 1)]
    return Segments(painted.surface, painted.segment_of, colors, painted.surface.vertex_normals)


def square(size: int = 11, cracks: tuple[tuple[int, int], ...] = ()) -> Segments:
    """The unit square in one segment, a grid of ``size`` times ``size`` vertices."""
    y, x = np.mgrid[0:size, 0:size] / (size - 1)
    points = np.stack([x.ravel(), y.ravel(), np.zeros(size * size)], axis=1)
    return one_segment(points, grid_faces(size, size), cracks)


def one_segment(
    points: np.ndarray, faces: np.ndarray, cracks: tuple[tuple[int, int], ...] = ()
) -> Segments:
    """A mesh in one color and one segment."""
    count = len(points)
    made = tuple([Crack(a, b, (0,)) for a, b in cracks])
    surface = LabelledSurface("one", ("a",), points, faces, ((0,),) * count, made)
    return Segments(surface, np.zeros(count, dtype=np.int64), [0], surface.vertex_normals)


def whole(shape: str, size: int = 10) -> Segments:
    """A mesh of some shape in one segment, its triangles about as wide as long."""
    if shape == "annulus":  # the one that random surfaces are drawn on has long triangles
        row, column = np.mgrid[0 : 6 * size, 0 : size + 1]
        radius, angle = 0.2 + 0.3 * column / size, 2 * np.pi * row / (6 * size)
        points = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * radius], axis=-1)
        return one_segment(points.reshape(-1, 3), grid_faces(6 * size, size + 1, wrap_rows=True))
    return one_segment(*make_mesh(shape, size))


def slit(size: int, column: int, rows: range) -> tuple[tuple[int, int], ...]:
    """The mesh edges of a grid between a column and the next one, in some rows."""
    found = []
    for row in rows:
        here = row * size + column
        found.append((here, here + 1))  # along the row
        found.append((here, here + size + 1))  # the diagonal of the square above
    return tuple(found)
