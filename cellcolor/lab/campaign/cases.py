"""Which instance a campaign looks at next: a function of its seed and a number."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs, hub, hub_grid, planar_graph

__all__ = ["KINDS", "Case", "draw_case"]

MOST_CELLS = 10
MOST_CELL_DARTS = 9
"""Live darts of a cell: what a depth-first search over the divisions of cells has time for."""

MOST_CELL_DARTS_WITH_LOOPS = 5

_Made = LabelledSurface | Instance
_Maker = Callable[[random.Random], _Made]


@dataclass(frozen=True, slots=True)
class Case:
    """One instance of a campaign.

    Attributes:
        seed: of the campaign.
        number: within the campaign; with the seed it is all that this was made from.
        kind: one of ``KINDS``.
        instance: what to solve.
        surface: the mesh behind it, None for abstract graphs.
    """

    seed: int
    number: int
    kind: str
    instance: Instance
    surface: LabelledSurface | None


def _surface(
    rng: random.Random, sizes: tuple[int, int], colors: tuple[int, int], **recipe: Any
) -> LabelledSurface:
    return blobs(rng.randrange(2**31), rng.randint(*sizes), rng.randint(*colors), **recipe)


def _smooth(rng: random.Random) -> LabelledSurface:
    return _surface(rng, (6, 9), (2, 4), waves=rng.uniform(0.3, 1.0))


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


def _graph(rng: random.Random, self_edges: bool) -> Instance:
    cells = rng.randint(3, 7)
    edges = cells + rng.randint(-1, 5)
    return planar_graph(
        rng.randrange(2**31), cells, edges, rng.randint(2, 4), self_edges=self_edges
    )


def _hub(rng: random.Random) -> Instance:
    return hub(rng.randrange(2**31), rng.randint(3, MOST_CELL_DARTS), rng.randint(3, 4))


def _hub_grid(rng: random.Random) -> Instance:
    rows, columns, side = rng.choice([(1, 1, 2), (1, 2, 1), (1, 3, 1), (2, 2, 1)])
    return hub_grid(rng.randrange(2**31), rows, columns, rng.randint(2, 4), side)


_MAKERS: dict[str, tuple[_Maker, Callable[[Instance], bool]]] = {
    "graphs": (partial(_graph, self_edges=False), lambda _: True),
    "graphs with self-edges": (partial(_graph, self_edges=True), lambda _: True),
    "hubs": (_hub, lambda _: True),
    "grids of hubs": (_hub_grid, lambda _: True),
    "smooth blobs": (_smooth, lambda instance: instance.most_live_loops < 2),
    "thin blobs": (
        lambda rng: _surface(rng, (7, 9), (2, 3), waves=0.5, thin=True),
        lambda instance: instance.most_live_loops < 2,
    ),
    "rim": (_rim, lambda instance: instance.most_live_loops < 2),
    "cracks": (_cracks, lambda instance: instance.most_live_loops < 2),
    "islands, holes": (_loops, lambda instance: instance.most_live_loops > 1),
}
KINDS = tuple(_MAKERS)
"""What a campaign takes its instances from, in turn."""


def draw_case(seed: int, number: int) -> Case:
    """Instance ``number`` of the campaign with a seed, of a size that every solver can bear.

    Instances of hubs and their grids are as large as they are made. Of the other kinds those are
    taken that have 2 to ``MOST_CELLS`` cells, none with more than ``MOST_CELL_DARTS`` live darts,
    and, where the kind asks for it, some cell with several live loops or none. Seams multiply
    darts: there cells may have ``MOST_CELL_DARTS_WITH_LOOPS``.
    """
    kind = KINDS[number % len(KINDS)]
    make, wanted = _MAKERS[kind]
    rng = random.Random(f"campaign {seed} {number}")
    while True:
        made = make(rng)
        if isinstance(made, Instance):
            instance, surface = made, None
        else:
            instance, surface = decompose(made), made
        if kind in ("hubs", "grids of hubs"):
            return Case(seed, number, kind, instance, surface)
        most = MOST_CELL_DARTS_WITH_LOOPS if kind == "islands, holes" else MOST_CELL_DARTS
        if (
            2 <= len(instance.cells) <= MOST_CELLS
            and instance.most_live_darts <= most
            and wanted(instance)
        ):
            return Case(seed, number, kind, instance, surface)
