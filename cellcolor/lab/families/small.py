"""Families of which every solver can bear each instance; campaigns draw from these.

Each is a function of a seed: of the instances that its recipe makes of that seed's random numbers
it takes the first that a depth-first search over the divisions of cells has time for.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from functools import partial
from typing import Any

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.lab.families.blobs import blobs
from cellcolor.lab.families.graphs import planar_graph
from cellcolor.lab.families.hubs import hub, hub_grid

MOST_SMALL_CELLS = 10
MOST_CELL_DARTS = 9
"""Live darts of a cell."""

MOST_CELL_DARTS_WITH_LOOPS = 5
"""The same where cells have several live loops: seams between them multiply the darts."""

_Made = Instance | LabelledSurface
_Recipe = Callable[[random.Random], _Made]


def bearable(
    recipe: _Recipe, seed: int, *, several_loops: bool | None = False
) -> Instance | LabelledSurface:
    """The first instance of a recipe that has 2 to 10 cells, none of them with many live darts.

    Args:
        recipe: makes one after the other, of random numbers.
        seed: of these.
        several_loops: whether some cell has to have several live loops; None if either will do.
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


def small_hub(seed: int) -> Instance:
    """One hub, as large as it is made."""
    rng = random.Random(f"small {seed}")
    return hub(seed, rng.randint(3, MOST_CELL_DARTS), rng.randint(3, 4))


def small_hub_grid(seed: int) -> Instance:
    """Up to four hubs, as large as they are made."""
    rng = random.Random(f"small {seed}")
    rows, columns, side = rng.choice([(1, 1, 2), (1, 2, 1), (1, 3, 1), (2, 2, 1)])
    return hub_grid(seed, rows, columns, rng.randint(2, 4), side)


def _graph(rng: random.Random, self_edges: bool) -> Instance:
    cells = rng.randint(3, 7)
    edges = cells + rng.randint(-1, 5)
    return planar_graph(
        rng.randrange(2**31), cells, edges, rng.randint(2, 4), self_edges=self_edges
    )


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


small_graph = partial(bearable, partial(_graph, self_edges=False), several_loops=None)
small_graph_with_self_edges = partial(
    bearable, partial(_graph, self_edges=True), several_loops=None
)
small_blobs = partial(bearable, _smooth)
small_thin_blobs = partial(bearable, _thin)
small_rim = partial(bearable, _rim)
small_cracks = partial(bearable, _cracks)
small_islands_and_holes = partial(bearable, _loops, several_loops=True)
