"""Random labelled surfaces: smooth domains on a grid, and Voronoi regions on any genus."""

from __future__ import annotations

import heapq
from dataclasses import replace

import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER
from cellcolor.decomposition.borders import Borders
from cellcolor.decomposition.cells import handles_of, loops_of, pieces_of
from cellcolor.lab.families.meshes import Topology, crack_paths, grid_faces, make_mesh
from cellcolor.mesh.triangle_mesh import directed_edges

Regions = list[int]
"""The Voronoi region of each vertex."""


def voronoi(
    seed: int,
    shape: Topology = "disc",
    size: int = 24,
    regions: int = 40,
    colors: int = 6,
    *,
    scattered: bool = False,
    coverage: tuple[float, float] = (0.35, 0.65),
    cracks: int = 0,
    islands: int = 0,
    holes: int = 0,
) -> LabelledSurface:
    """Random Voronoi regions on a mesh, each color on some of them.

    A region has the vertices that are nearest to one random seed vertex. Distances are measured
    along mesh edges, each of random length, so that the borders of the regions are ragged. Cells
    with a handle are cut until none is left.

    Args:
        size: about the square root of the number of vertices, six or more.
        regions: how many Voronoi regions, one or more, before islands, holes and cuts.
        scattered: colors reach random regions; otherwise each grows from one region to the next.
        coverage: the least and the largest share of the regions that a color reaches.
        cracks: random paths over the mesh that the colors common to both sides do not cross.
        islands: small discs that only one color reaches; holes are such that none does.
    """
    vertices, faces = make_mesh(shape, size)
    rng = np.random.default_rng([seed, size, regions, colors])
    third = directed_edges(faces, len(vertices))  # the third vertex of the triangle left of (a, b)
    neighbors: list[list[int]] = [[] for _ in vertices]
    for a, b in third:
        neighbors[a].append(b)
        if (b, a) not in third:
            neighbors[b].append(a)
    region = _nearest(rng, neighbors, rng.choice(len(vertices), regions, replace=False).tolist())
    sets = _reached(rng, region, neighbors, colors, coverage, scattered)  # by region
    for number in range(islands + holes):
        center = int(rng.integers(len(vertices)))
        disc = {center, *neighbors[center]}
        if rng.random() < 0.5:
            disc |= {further for vertex in tuple(disc) for further in neighbors[vertex]}
        for vertex in disc:
            region[vertex] = len(sets)
        sets.append({int(rng.integers(colors))} if number < islands else set())
    surface = LabelledSurface(
        f"voronoi_{shape.replace(' ', '_')}_{seed}",
        tuple(f"c{color}" for color in range(colors)),
        vertices,
        faces,
        _sets_of(region, sets),
        meta={"family": "voronoi", "seed": seed},
    )
    # No part of a disc, an annulus or a sphere has a handle.
    while shape in ("torus", "double torus") and (found := _cells_with_handles(surface)):
        for cell in found:
            _cut(rng, cell, region, sets, neighbors, colors)
        surface = replace(surface, vertex_colors=_sets_of(region, sets))
    own = crack_paths(rng, faces, surface.vertex_colors, cracks, 2 * size)
    return replace(surface, cracks=own)


def _sets_of(region: Regions, sets: list[set[int]]) -> tuple[tuple[int, ...], ...]:
    """The colors of each vertex."""
    return tuple(tuple(sorted(sets[number])) for number in region)


def _nearest(rng: np.random.Generator, neighbors: list[list[int]], seeds: list[int]) -> Regions:
    """The number of the seed that is nearest to each vertex; edges have random lengths."""
    nearest = [-1] * len(neighbors)
    queue = [(0.0, vertex, number) for number, vertex in enumerate(seeds)]
    heapq.heapify(queue)
    while queue:
        distance, vertex, number = heapq.heappop(queue)
        if nearest[vertex] != -1:
            continue
        nearest[vertex] = number
        for neighbor in neighbors[vertex]:
            if nearest[neighbor] == -1:
                heapq.heappush(queue, (distance + rng.uniform(0.5, 1.5), neighbor, number))
    return nearest


def _reached(
    rng: np.random.Generator,
    region: Regions,
    neighbors: list[list[int]],
    colors: int,
    coverage: tuple[float, float],
    scattered: bool,
) -> list[set[int]]:
    """The colors of each region: each color is put on a random share of the regions."""
    count = max(region) + 1
    beside: list[set[int]] = [set() for _ in range(count)]
    for vertex, others in enumerate(neighbors):
        beside[region[vertex]].update(region[other] for other in others)
    sets: list[set[int]] = [set() for _ in range(count)]
    for color in range(colors):
        wanted = max(1, round(count * rng.uniform(*coverage)))
        if scattered:
            chosen = rng.choice(count, wanted, replace=False).tolist()
        else:
            chosen = [int(rng.integers(count))]
            while len(chosen) < wanted:
                onward = sorted({b for a in chosen for b in beside[a]} - set(chosen))
                if not onward:
                    break
                chosen.append(onward[int(rng.integers(len(onward)))])
        for number in chosen:
            sets[number].add(color)
    return sets


def _cells_with_handles(surface: LabelledSurface) -> list[list[int]]:
    """The vertices of each cell that has a handle."""
    cell_of, _ = pieces_of(surface, surface.vertex_colors, (), NEVER)
    borders = Borders(surface, cell_of)
    loops = loops_of(borders, borders.curves(NEVER), NEVER)
    genus = handles_of(surface, borders, loops, NEVER)
    members: dict[int, list[int]] = {cell: [] for cell, handles in genus.items() if handles}
    for vertex, cell in enumerate(cell_of):
        if cell in members:
            members[cell].append(vertex)
    return list(members.values())


def _cut(
    rng: np.random.Generator,
    cell: list[int],
    region: Regions,
    sets: list[set[int]],
    neighbors: list[list[int]],
    colors: int,
) -> None:
    """Change one random color on about half of a cell's regions, so that the cell falls apart.

    A cell that is a single region is divided into eight regions at most before that.
    """
    inside = sorted({region[vertex] for vertex in cell})
    if len(inside) == 1:
        place = {vertex: index for index, vertex in enumerate(cell)}
        within = [
            [place[other] for other in neighbors[vertex] if other in place] for vertex in cell
        ]
        seeds = rng.choice(len(cell), min(8, len(cell)), replace=False).tolist()
        finer = _nearest(rng, within, seeds)
        common = sets[inside[0]]
        inside = [len(sets) + number for number in range(max(finer) + 1)]
        sets.extend(set(common) for _ in inside)
        for vertex, number in zip(cell, finer, strict=True):
            region[vertex] = inside[number]
    color = int(rng.integers(colors))
    for number in inside:
        if rng.random() < 0.5:
            sets[number] ^= {color}


def blobs(
    seed: int,
    size: int = 24,
    colors: int = 6,
    *,
    waves: float = 0.7,
    coverage: tuple[float, float] = (0.35, 0.65),
    thin: bool = False,
    cracks: int = 0,
    rim: int = 0,
    islands: int = 0,
    holes: int = 0,
) -> LabelledSurface:
    """Smooth random color domains on a square grid mesh.

    Each color reaches where a random field of a few waves is high (or, ``thin``, near its median:
    bands instead of blobs). Where domains overlap a point has several colors, where none reaches
    it has none.

    Args:
        size: points along each side of the grid, two or more.
        waves: how many waves of a field fit across the grid, or nearly; more waves, more cells.
        coverage: the least and the largest share of the grid that a color reaches.
        thin: narrow bands instead of round blobs.
        cracks: random paths over the mesh that the colors common to both sides do not cross.
        rim: discs on the border of the grid that only one color reaches. With a large coverage
            they make the cell in their middle one that has to be cut.
        islands: such discs anywhere; holes are discs that no color reaches.
    """
    rng = np.random.default_rng([seed, size, colors])
    y, x = np.mgrid[0:size, 0:size]
    reached = np.zeros((colors, size, size), dtype=bool)
    for color in range(colors):
        field = _waves(rng, x / size, y / size, waves)
        if thin:
            field = -np.abs(field - np.median(field))
        reached[color] = field >= np.quantile(field, 1.0 - rng.uniform(*coverage))
    for number in range(rim + islands + holes):
        center = rng.uniform(0.2, 0.8, 2) * (size - 1)
        if number < rim:
            center[rng.integers(2)] = rng.integers(2) * (size - 1)
        radius = rng.uniform(0.09, 0.2) * size
        disc = np.hypot(x - center[0], y - center[1]) <= radius
        reached[:, disc] = False
        if number < rim + islands:
            reached[rng.integers(colors), disc] = True
    vertex_colors = tuple(
        tuple(np.flatnonzero(available).tolist()) for available in reached.reshape(colors, -1).T
    )
    faces = grid_faces(size, size)
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(size * size)], axis=1).astype(np.float64)
    return LabelledSurface(
        f"blobs_{seed}",
        tuple(f"c{color}" for color in range(colors)),
        vertices,
        faces,
        vertex_colors,
        crack_paths(rng, faces, vertex_colors, cracks, size),
        {"family": "blobs", "seed": seed},
    )


def _waves(rng: np.random.Generator, x: Array, y: Array, frequency: float) -> Array:
    """A smooth random field: a dozen plane waves of about the given frequency."""
    field = np.zeros_like(x)
    for _ in range(12):
        kx, ky = rng.normal(0.0, frequency / 2, 2)
        field += np.cos(2 * np.pi * (kx * x + ky * y) + rng.uniform(0, 2 * np.pi))
    return field
