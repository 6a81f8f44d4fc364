"""Every random family by name; each is a function of a seed."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from functools import partial
from typing import Any

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from cellcolor.lab.families.graphs import hub, hub_grid, hub_with_loops, planar_graph
from cellcolor.lab.families.meshes import SHAPES, Topology
from cellcolor.lab.families.surfaces import blobs, voronoi

MOST_SMALL_CELLS = 10
MOST_CELL_DARTS, MOST_CELL_DARTS_WITH_LOOPS = 9, 5
"""Live darts of a cell, the second where one has several live loops: seams multiply the darts."""

_Made = Instance | LabelledSurface
_Recipe = Callable[[random.Random], _Made]


def _bearable(recipe: _Recipe, seed: int, *, several_loops: bool | None = False) -> _Made:
    """The first instance of a recipe that has 2 to 10 cells, none of them with many live darts.

    Some cell has to have several live loops or none may have; if None, either will do.
    """
    rng = random.Random(f"small {seed}")
    most = MOST_CELL_DARTS_WITH_LOOPS if several_loops else MOST_CELL_DARTS
    while True:
        made = recipe(rng)
        instance = made if isinstance(made, Instance) else decompose(made)
        if (
            2 <= len(instance.cells) <= MOST_SMALL_CELLS
            and instance.most_live_darts <= most
            and several_loops in (None, instance.most_live_loops > 1)
        ):
            return made


def _small_hub(seed: int) -> Instance:
    rng = random.Random(f"small {seed}")
    return hub(seed, rng.randint(3, MOST_CELL_DARTS), rng.randint(3, 4))


def _small_hub_grid(seed: int) -> Instance:
    rng = random.Random(f"small {seed}")
    rows, columns, side = rng.choice([(1, 1, 2), (1, 2, 1), (1, 3, 1), (2, 2, 1)])
    return hub_grid(seed, rows, columns, rng.randint(2, 4), side)


def _graph(rng: random.Random, self_edges: bool) -> Instance:
    cells = rng.randint(3, 7)
    edges, seed = cells + rng.randint(-1, 5), rng.randrange(2**31)
    return planar_graph(seed, cells, edges, rng.randint(2, 4), self_edges=self_edges)


def _surface(
    rng: random.Random, sizes: tuple[int, int], colors: tuple[int, int], **recipe: Any
) -> LabelledSurface:
    return blobs(rng.randrange(2**31), rng.randint(*sizes), rng.randint(*colors), **recipe)


def _smooth(rng: random.Random) -> LabelledSurface:
    return _surface(rng, (6, 9), (2, 4), waves=rng.uniform(0.3, 1.0))


def _thin(rng: random.Random) -> LabelledSurface:
    return _surface(rng, (7, 9), (2, 3), waves=0.5, thin=True)


def _rim(rng: random.Random) -> LabelledSurface:
    """One large cell with many colors and small ones at its border, which ask for cutting paths."""
    rim = rng.randint(4, 8)
    return _surface(rng, (7, 9), (2, 3), coverage=(0.8, 1.0), rim=rim)


def _cracks(rng: random.Random) -> LabelledSurface:
    recipe = {"coverage": (0.6, 1.0), "rim": rng.randint(0, 5)}
    return _surface(rng, (6, 8), (2, 3), waves=0.4, cracks=rng.randint(1, 4), **recipe)


def _loops(rng: random.Random) -> LabelledSurface:
    extras = {"islands": rng.randint(0, 2), "holes": rng.randint(0, 1), "cracks": rng.randint(0, 2)}
    return _surface(rng, (7, 9), (2, 3), coverage=(0.8, 1.0), rim=rng.randint(0, 4), **extras)


def _large_voronoi(topology: Topology, seed: int) -> LabelledSurface:
    rng = random.Random(f"{topology} {seed}")
    size = rng.randint(12, 64)
    low = rng.uniform(0.05, 0.6)
    return voronoi(
        seed,
        topology,
        size,
        round(math.exp(rng.uniform(1.5, math.log(size**2 / 3)))),
        rng.randint(2, 30),
        scattered=rng.random() < 0.4,
        coverage=(low, rng.uniform(low, 0.9)),
        cracks=rng.randint(0, 15),
        islands=rng.randint(0, 10),
        holes=rng.randint(0, 4),
    )


def _large_hub_with_loops(seed: int) -> Instance:
    rng = random.Random(f"loops {seed}")
    return hub_with_loops(seed, rng.randint(2, 12), rng.randint(2, 10), rng.randint(3, 8))


def _large_hub(seed: int) -> Instance:
    rng = random.Random(f"petals {seed}")
    return hub(seed, rng.randint(50, 400), rng.randint(3, 100))


def _large_hub_grid(seed: int) -> Instance:
    rng = random.Random(f"grids {seed}")
    rows, columns = rng.randint(2, 12), rng.randint(2, 12)
    return hub_grid(seed, rows, columns, rng.randint(3, 8), rng.randint(1, 4))


def _large_patches(seed: int) -> LabelledSurface:
    """Blobs with whatever makes them hard: cracks, rims, islands, holes."""
    rng = random.Random(f"patches {seed}")
    return blobs(
        seed,
        rng.randint(24, 110),
        rng.randint(3, 14),
        waves=rng.uniform(0.5, 3.0),
        coverage=(0.2, rng.uniform(0.4, 0.95)),
        thin=rng.random() < 0.3,
        cracks=rng.randint(0, 10),
        rim=rng.randint(0, 30),
        islands=rng.randint(0, 60),
        holes=rng.randint(0, 5),
    )


_GRIDS = ((2, 3), (3, 2), (3, 3), (4, 2), (5, 2), (4, 3), (6, 2), (5, 3), (8, 2), (10, 2))
"""Rows, as many as columns, and petals at each side of a hub: from 40 to 540 cells."""


def _growing_blobs(seed: int) -> LabelledSurface:
    """Blobs of 2 to 10 colors with more and more waves: 3 cells at seed 0, 1120 at seed 39."""
    size = min(24 + 2 * seed, 110)
    return blobs(seed, size, 2 + min(seed // 4, 8), waves=0.4 + 0.1 * seed)


def _growing_hub(seed: int) -> Instance:
    """A hub of 6 petals for seeds 0 to 2, of 9 petals for the next three, …"""
    return hub(seed, 6 + 3 * (seed // 3), 4)


def _growing_hub_grid(seed: int) -> Instance:
    if seed >= len(_GRIDS):
        raise InputError(None, None, f"grids of hubs have seeds 0 to {len(_GRIDS) - 1}")
    rows, side = _GRIDS[seed]
    return hub_grid(0, rows, rows, 4, side)


Family = Callable[[int], Instance | LabelledSurface]
"""The instance that a family makes of a seed, always the same of the same seed."""

SMALL: dict[str, Family] = {
    "graphs": partial(_bearable, partial(_graph, self_edges=False), several_loops=None),
    "graphs with self-edges": partial(
        _bearable, partial(_graph, self_edges=True), several_loops=None
    ),
    "hubs": _small_hub,
    "grids of hubs": _small_hub_grid,
    "smooth blobs": partial(_bearable, _smooth),
    "thin blobs": partial(_bearable, _thin),
    "rim": partial(_bearable, _rim),
    "cracks": partial(_bearable, _cracks),
    "islands, holes": partial(_bearable, _loops, several_loops=True),
}
"""What every solver can bear, a depth-first search among them."""

MEDIUM: dict[str, Family] = {
    "blobs": blobs,
    "more waves": partial(blobs, waves=1.0),
    "cracks": partial(blobs, cracks=4),
    "islands, holes": partial(blobs, holes=3, islands=3),
    "rim": partial(blobs, rim=8, coverage=(0.6, 0.9)),
    "thin": partial(blobs, thin=True, colors=5),
    "48 × 48 points, 8 colors": partial(blobs, size=48, colors=8, waves=1.2),
    "64 × 64 points, 10 colors": partial(blobs, size=64, colors=10, waves=1.6),
}
"""As hard as real scenes."""

LARGE: dict[str, Family] = {
    **{topology: partial(_large_voronoi, topology) for topology in SHAPES},
    "loops": _large_hub_with_loops,
    "petals": _large_hub,
    "grids": _large_hub_grid,
    "patches": _large_patches,
}
"""At the limits of the solvers and beyond."""

GROWING: dict[str, Family] = {
    "blobs": _growing_blobs,
    "hubs": _growing_hub,
    "grids of hubs": _growing_hub_grid,
}
"""Larger and larger with the seed, to see where solvers reach their limits."""
