"""Fronts of lift-offs against area: against brute force, and how long they take.

    python benchmarks/fronts.py brute [COUNT] [SEED]
    python benchmarks/fronts.py scenes

``brute`` draws COUNT tiny labelled surfaces (2,000 without it) with random weights. What each
number of segments covers is held against two computations that share nothing with the solvers:
every set of cells left out, with the minimum of the others (equal in the search space ``paper``);
and every coloring of the vertices, some of them left bare (never above what a point says is the
most). So is the least sum of lift-offs and area at three prices. Exit code 1 if one disagrees.
``scenes`` prints the front of every shipped scene, and the time it takes once the graph is known
beside that of the minimum alone.
"""

from __future__ import annotations

import statistics
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

import numpy as np
from exhaustive_minima import front_by_subsets, front_by_vertices

import cellcolor
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.decomposition import decomposition_of
from cellcolor.lab.families import blobs
from cellcolor.questions.tradeoff import front_of
from cellcolor.solvers.interface import Options

KINDS = (
    {"size": 4, "colors": 2, "coverage": (0.8, 1.0), "rim": 4},
    {"size": 4, "colors": 3, "waves": 0.5},
    {"size": 4, "colors": 4, "coverage": (0.5, 1.0)},
)
MOST_CELLS = 9  # every set of them is left out once
REPEATED = 5
CM2 = 1e4  # a weight of 1 counts as a square meter


def brute(count: int, seed: int) -> int:
    """Draw, compare and print."""
    compared, by_cells, points, wrong, number = 0, 0, 0, 0, seed
    begun = time.process_time()
    while compared < count:
        number += 1
        surface = blobs(number, **KINDS[number % len(KINDS)])
        found = decomposition_of(surface)
        weights = np.random.default_rng(number).integers(0, 6, len(surface.vertices))
        cell = np.array(found.vertex_cell)
        inside = cell != OUTSIDE
        cells = len(found.instance.cells)
        per_cell = np.bincount(cell[inside], weights[inside], cells)
        if not per_cell.sum() or cells > MOST_CELLS:
            continue
        compared += 1
        front = front_of(found.instance, Options(), weights=per_cell.tolist())
        best = front_by_vertices(surface, weights.tolist())
        for point in front:
            points += 1
            if point.holds_for_surface and best.get(point.segments, 0) > (
                point.at_most_share * per_cell.sum() + 1e-6
            ):
                wrong += 1
                print(f"draw {number}: vertices cover more with {point.segments} segments")
        in_cells: dict[int, float] = {}
        if found.instance.most_live_loops < 2:
            by_cells += 1
            in_cells = front_by_subsets(found.instance, per_cell.tolist())
            for segments, weight in in_cells.items():
                most = max((p.covered_share for p in front if p.segments <= segments), default=0.0)
                if abs(most * per_cell.sum() - weight) > 1e-6:
                    wrong += 1
                    print(f"draw {number}: cells cover {weight} with {segments} segments")
        for price in np.random.default_rng(number).uniform(0, 8, 3):
            choice = front.least_cost(CM2 * price)
            by_hand = [
                min(price * (k - 1) + per_cell.sum() - weight for k, weight in each.items() if k)
                for each in (best, in_cells)
                if each
            ]
            lower, *exact = (CM2 * cost for cost in by_hand)
            cost = choice.cost_cm2
            bad = (choice.proved and lower < cost - 1) or any(abs(cost - e) > 1 for e in exact)
            if bad:
                wrong += 1
                print(f"draw {number}: a price of {price} makes {cost}, by hand {by_hand}")
    seconds = time.process_time() - begun
    print(
        f"{compared} surfaces, {points} points, {by_cells} of the surfaces by cells as well: "
        f"{wrong} disagreements, {seconds:.0f} s"
    )
    return 1 if wrong else 0


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
