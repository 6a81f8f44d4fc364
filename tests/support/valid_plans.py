"""Valid plans of many sorts, and what would contradict the verdicts on them.

Segments are counted here by networkx, from triangles and cracks alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import networkx as nx
import numpy as np
from planners import (
    Colors,
    configurations_without_arm,
    largest_set_first,
    nearest_along_raster,
    random_branches,
)

import cellcolor
from cellcolor.arrays import Array
from cellcolor.data.surface import LabelledSurface
from cellcolor.oracle import Verdict

Random = np.random.Generator


def segments_counted(surface: LabelledSurface, colors: Sequence[int | None]) -> int:
    """The connected components of vertices in one color, across mesh edges without a crack."""
    mesh: nx.Graph[int] = nx.Graph()
    mesh.add_nodes_from(vertex for vertex, color in enumerate(colors) if color is not None)
    cracks = {frozenset((crack.i, crack.j)): crack.colors for crack in surface.cracks}
    for a, b, c in surface.faces.tolist():
        for one, other in ((a, b), (b, c), (c, a)):
            same = colors[one] is not None and colors[one] == colors[other]
            if same and colors[one] not in cracks.get(frozenset((one, other)), ()):
                mesh.add_edge(one, other)
    return nx.number_connected_components(mesh)


def any_colors(surface: LabelledSurface, random: Random) -> Colors:
    """A color for each vertex by chance."""
    return [int(random.choice(own)) if own else None for own in surface.vertex_colors]


def in_patches(surface: LabelledSurface, random: Random) -> Colors:
    """A few centers; each vertex takes the first color that it has in the order of the nearest."""
    centers = surface.vertices[random.choice(len(surface.vertices), 4)]
    ranks = [random.permutation(len(surface.colors)) for _ in centers]
    away = np.linalg.norm(surface.vertices[:, None] - centers[None], axis=2).argmin(axis=1)
    return [
        min(own, key=lambda color: ranks[nearest][color]) if own else None
        for nearest, own in zip(away.tolist(), surface.vertex_colors, strict=True)
    ]


def mutated(surface: LabelledSurface, best: Sequence[int | None], random: Random) -> Colors:
    """The best plan found, with up to five of its vertices in other colors of theirs."""
    colors = list(best)
    several = [vertex for vertex, own in enumerate(surface.vertex_colors) if len(own) > 1]
    for vertex in random.permutation(several)[: int(random.integers(6))].tolist():
        colors[vertex] = int(random.choice(surface.vertex_colors[vertex]))
    return colors


def _by_raster(surface: LabelledSurface, random: Random, configurations: Array | None) -> Colors:
    if configurations is None:
        configurations = configurations_without_arm(surface, random)
    return nearest_along_raster(surface, configurations, float(random.uniform(0, np.pi)))


SORTS = ("by chance", "in patches", "best, mutated", "greedy", "random, mended", "raster")


def valid_plans(
    oracle: cellcolor.Oracle, random: Random, configurations: Array | None = None
) -> Iterator[tuple[str, Colors]]:
    """Plans of all sorts in turn, without an end, each with its sort.

    Args:
        oracle: of the surface.
        random: what draws.
        configurations: (n, colors, joints) in rad, if an arm stands behind the surface.
    """
    surface, best = oracle.surface, oracle.best
    plans: dict[str, Callable[[], Colors]] = {
        "by chance": lambda: any_colors(surface, random),
        "in patches": lambda: in_patches(surface, random),
        "greedy": lambda: largest_set_first(surface),
        "random, mended": lambda: random_branches(surface, random),
        "raster": lambda: _by_raster(surface, random, configurations),
    }
    if best is not None:
        plans["best, mutated"] = lambda: mutated(surface, best.on_mesh.vertex_colors, random)
    turn = 0
    while True:
        for sort in SORTS:
            # There is one greedy plan of a surface.
            if sort in plans and (turn == 0 or sort != "greedy"):
                yield sort, plans[sort]()
        turn += 1


def contradictions(
    oracle: cellcolor.Oracle, colors: Colors, verdict: Verdict, fewest: int
) -> list[str]:
    """What in a verdict on a valid plan is not as it has to be.

    Args:
        oracle: what gave it.
        colors: the plan.
        verdict: the verdict.
        fewest: segments of the best plan that is known of this surface.
    """
    if not verdict.valid:
        return [f"refused: {verdict}"]
    own, bounds, better = (
        segments_counted(oracle.surface, colors),
        oracle.bounds,
        verdict.improvement,
    )
    wrong = []
    if verdict.segments != own:
        wrong.append(f"{verdict.segments} segments, {own} by networkx")
    if min(own, fewest) < bounds.lower:
        wrong.append(f"{min(own, fewest)} segments, below the bound {bounds.lower}")
    if verdict.beatable_by == 0 and fewest < own:
        wrong.append(f"cannot be beaten with {own} segments, another has {fewest}")
    if verdict.optimal and (verdict.beatable_by != 0 or own != bounds.lower):
        wrong.append(f"optimal with {own} segments, {verdict.beatable_by} fewer are enough")
    if verdict.beatable_by and better is not None:
        painted, on_mesh = better.better.painted, better.better.on_mesh
        counted = segments_counted(painted.surface, painted.plan.vertex_colors)
        if counted != better.segments or counted > own - verdict.beatable_by:
            wrong.append(f"{counted} segments in what has {verdict.beatable_by} fewer than {own}")
        if segments_counted(oracle.surface, on_mesh.vertex_colors) != better.segments_on_mesh:
            wrong.append("another number of segments on the mesh as it is")
    if verdict.beatable_by and better is None and oracle.best is not None:
        wrong.append(f"{verdict.beatable_by} fewer are enough, and nothing says where")
    return wrong
