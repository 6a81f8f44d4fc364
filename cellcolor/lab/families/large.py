"""Families of instances at the limits of the solvers and beyond, as benchmarks/limits.py draws.

Each is a function of a seed. Sizes are random, most of them spread evenly over orders of magnitude.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families.blobs import blobs
from cellcolor.lab.families.hubs import cover_tree, hub, hub_grid, hub_with_loops, wide_hub
from cellcolor.lab.families.meshes import Topology
from cellcolor.lab.families.parts import part
from cellcolor.lab.families.voronoi import voronoi


def large_voronoi(topology: Topology) -> Callable[[int], LabelledSurface]:
    """Voronoi regions on a surface of that topology."""

    def make(seed: int) -> LabelledSurface:
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

    return make


def large_part(seed: int) -> LabelledSurface:
    """A machined part of about a hundred to 1500 cells."""
    rng = random.Random(f"part {seed}")
    cells = round(math.exp(rng.uniform(math.log(100), math.log(1500))))
    return part(seed, cells, min(500, round(cells * rng.uniform(0.2, 0.5))))


def large_hub_with_loops(seed: int) -> Instance:
    """A hub with a ring of petals round each of up to a dozen loops."""
    rng = random.Random(f"loops {seed}")
    return hub_with_loops(seed, rng.randint(2, 12), rng.randint(2, 10), rng.randint(3, 8))


def large_hub(seed: int) -> Instance:
    """A hub of up to 400 petals, of one color each or of several."""
    rng = random.Random(f"petals {seed}")
    petals = rng.randint(50, 400)
    if seed % 2:
        return hub(seed, petals, rng.randint(3, 100))
    colors = rng.randint(4, 100)
    return wide_hub(seed, petals, colors, rng.randint(1, max(1, colors // 4)))


def large_tree(seed: int) -> Instance:
    """A tree of hubs and leaves, whose set cover is hard to find."""
    rng = random.Random(f"trees {seed}")
    hubs = rng.randint(5, 70)
    return cover_tree(seed, hubs, rng.randint(2, 8), rng.randint(10, 80), rng.randint(2, 5))


def large_hub_grid(seed: int) -> Instance:
    """Up to 144 hubs that share their petals."""
    rng = random.Random(f"grids {seed}")
    rows, columns = rng.randint(2, 12), rng.randint(2, 12)
    return hub_grid(seed, rows, columns, rng.randint(3, 8), rng.randint(1, 4))


def large_patches(seed: int) -> LabelledSurface:
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
