"""Fronts of lift-offs against area: against brute force, and how long they take.

    python benchmarks/fronts.py brute [COUNT] [SEED]
    python benchmarks/fronts.py scenes

``brute`` draws COUNT tiny labelled surfaces (2,000 without it) with random weights. Of every three,
one has places that must be covered and one has places left alone. What each number of segments
covers is held against two computations that share nothing with the solvers: every set of cells left
out, with the minimum of the others (equal in the search space ``paper``); and every coloring of the
vertices, some of them left bare (never above what a point says is the most). So are the least sum
of lift-offs and area at three prices, and the fewest lift-offs for three shares. Exit code 1 if one
disagrees.
``scenes`` prints the front of every shipped scene, and the time it takes once the graph is known
beside that of the minimum alone.
"""

from __future__ import annotations

import itertools
import math
import statistics
import sys
import time
from collections.abc import Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

import numpy as np
from exhaustive_minima import front_by_subsets
from vertex_minima import front_by_vertices

import cellcolor
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.decomposition import decomposition_of
from cellcolor.lab.families import blobs
from cellcolor.questions.front import Front

KINDS = (
    {"size": 4, "colors": 2, "coverage": (0.8, 1.0), "rim": 4},
    {"size": 4, "colors": 2, "coverage": (0.8, 1.0), "rim": 6},
    {"size": 4, "colors": 3, "waves": 0.5},
    {"size": 4, "colors": 4, "coverage": (0.5, 1.0)},
)
PLACES = (None, "required", "left_alone")
SHARE_OF_PLACES = 0.15  # of the vertices that are required, or left alone
MOST_CELLS = 9  # every set of them is left out once
REPEATED = 25
CM2 = 1e4  # a weight of 1 counts as a square meter
TINY = 1e-6  # of weights that are whole numbers


def brute(count: int, seed: int) -> int:
    """Draw, compare and print."""
    compared, by_cells, points, wrong, number = 0, 0, 0, 0, seed
    begun = time.process_time()
    while compared < count:
        number += 1
        rng = np.random.default_rng(number)
        drawn = blobs(number, **KINDS[number % len(KINDS)])
        place = rng.random(len(drawn.vertices)) < SHARE_OF_PLACES
        places = PLACES[number % len(PLACES)]
        surface = drawn.without_vertices(place) if places == "left_alone" else drawn
        found = decomposition_of(surface)
        weights = rng.integers(0, 6, len(drawn.vertices))
        cell = np.array(found.vertex_cell)
        inside = cell != OUTSIDE
        cells = len(found.instance.cells)
        whole = weights[inside].sum()
        if not whole or cells > MOST_CELLS:
            continue
        compared += 1
        given = {places: place} if places else {}
        front = cellcolor.tradeoff(drawn, weights=weights / drawn.vertex_areas, **given)
        required = np.flatnonzero(place & inside) if places == "required" else []
        exhaustive = [front_by_vertices(surface, weights.tolist(), set(required))]
        if found.instance.most_live_loops < 2:
            by_cells += 1
            per_cell = np.bincount(cell[inside], weights[inside], cells).tolist()
            exhaustive.append(front_by_subsets(found.instance, per_cell, set(cell[required])))
        points += len(front.points)
        for text in disagreements(front, float(whole), exhaustive, rng):
            wrong += 1
            print(f"draw {number}: {text}", flush=True)
    seconds = time.process_time() - begun
    print(
        f"{compared} surfaces, {points} points, {by_cells} of the surfaces by cells as well: "
        f"{wrong} disagreements, {seconds:.0f} s"
    )
    return 1 if wrong else 0


def disagreements(
    front: Front, whole: float, exhaustive: list[dict[int, float]], rng: np.random.Generator
) -> Iterator[str]:
    """Where a front is not what trying everything finds.

    Args:
        front: the front.
        whole: what everything weighs.
        exhaustive: for each number of segments the greatest weight, by vertices; and by cells too
            if the cells allow it.
        rng: for the prices and the shares that are asked for.
    """
    by_vertices, *by_cells = exhaustive
    for segments, (share, sure) in enumerate(front.at_most, 1):
        if sure and by_vertices.get(segments, -math.inf) > share * whole + TINY:
            yield f"vertices cover more with {segments} segments"
    for segments, weight in itertools.chain.from_iterable(one.items() for one in by_cells):
        most = max((p.covered_share for p in front if p.segments <= segments), default=-1)
        if abs(most * whole - weight) > TINY:
            yield f"cells cover {weight} with {segments} segments, and not {most * whole}"
    for price in rng.uniform(0, 8, 3) * [1, 1, whole]:
        choice = front.least_cost(CM2 * price)
        lower, *exact = (
            CM2 * min(price * (k - 1) + whole - weight for k, weight in each.items())
            for each in exhaustive
        )
        if choice.proved_for_surface and lower < choice.cost_cm2 - CM2 * TINY:
            yield f"vertices cost {lower} at a price of {price}, and not {choice.cost_cm2}"
        if any(abs(choice.cost_cm2 - cost) > CM2 * TINY or not choice.proved for cost in exact):
            yield f"cells cost {exact} at a price of {price}, and not {choice}"
    for share in rng.uniform(0, 1, 3):
        choice = front.fewest_for(share)
        lower, *exact = (
            min((k for k, weight in each.items() if weight >= share * whole), default=math.inf)
            for each in exhaustive
        )
        if choice.proved_for_surface and lower < choice.point.segments:
            yield f"{lower} segments of vertices cover {share}, and not {choice}"
        if any(choice.point.segments != fewest or not choice.proved for fewest in exact):
            yield f"{exact} segments of cells cover {share}, and not {choice}"


def scenes() -> int:
    """Print the front of each shipped scene, and the time beside that of the minimum."""
    print("| scene | share, % | points proved for the surface | front, s | minimum, s | ratio |")
    print("|---|---|--:|--:|--:|--:|")
    ratios = []
    for path in sorted((Path(__file__).parents[1] / "instances").rglob("*.toml")):
        try:
            graph = cellcolor.decompose(path)
        except cellcolor.InputError as error:
            print(f"| {path.stem} | {error.message} | | | | |")
            continue
        spent: dict[str, list[float]] = {"front": [], "minimum": []}
        for _ in range(REPEATED):
            for name, run in (("front", cellcolor.tradeoff), ("minimum", cellcolor.solve)):
                begun = time.process_time()
                run(graph)
                spent[name].append(time.process_time() - begun)
        front = cellcolor.tradeoff(graph)
        shares = ", ".join(f"{100 * point.covered_share:.1f}" for point in front)
        proved = sum(point.proved_for_surface for point in front)
        own, alone = (statistics.median(spent[name]) for name in ("front", "minimum"))
        ratios.append(own / alone)
        print(
            f"| {path.stem} | {shares} | {proved} of {len(front.points)} | {own:.3f} | "
            f"{alone:.3f} | {own / alone:.1f} |",
            flush=True,
        )
    print(f"\nmedian ratio {statistics.median(ratios):.1f}, greatest {max(ratios):.1f}")
    return 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["scenes"]:
        sys.exit(scenes())
    if sys.argv[1:2] != ["brute"]:
        sys.exit(__doc__)
    sys.exit(brute(int(sys.argv[2]) if sys.argv[2:] else 2000, int((sys.argv[3:] or [0])[0])))
