"""The most that so many segments cover, by trying everything; it shares nothing with any solver."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from itertools import chain, combinations

from exhaustive_minima import minimum

from cellcolor.data.instance import Instance
from cellcolor.data.restricted import without_cells
from cellcolor.data.surface import LabelledSurface


def front_by_subsets(instance: Instance, weights: Sequence[float]) -> dict[int, float]:
    """For each number of segments the greatest weight of cells that have a division with so many.

    Every set of cells is left out once, and the minimum of the others found by a sweep.
    """
    cells = range(len(instance.cells))
    best: dict[int, float] = defaultdict(float)
    for left_out in chain.from_iterable(combinations(cells, size) for size in cells):
        rest, kept = without_cells(instance, left_out)
        segments = minimum(rest)
        best[segments] = max(best[segments], sum(weights[cell] for cell in kept))
    return {k: max(best[fewer] for fewer in range(1, k + 1)) for k in range(1, max(best) + 1)}


def front_by_vertices(surface: LabelledSurface, weights: Sequence[float]) -> dict[int, float]:
    """For each number of segments the greatest weight of vertices that so many components have.

    Every vertex is given one of its colors or none, in a sweep over the vertices in their order.
    Borders run between vertices, so on a coarse mesh less is covered than on the surface.
    """
    cracks = {(c.i, c.j): c.colors for c in surface.cracks}
    neighbors: dict[int, set[int]] = defaultdict(set)
    for i, j in surface.left_of:
        neighbors[i].add(j)
        neighbors[j].add(i)
    # The painted vertices that later ones touch: color and component of each; None if left out.
    State = tuple[tuple[int, int] | None, ...]
    frontier: list[int] = []
    layer: dict[tuple[State, int], float] = {((), 0): 0.0}
    for vertex, colors in enumerate(surface.vertex_colors):
        painted_now = [*frontier, vertex]
        kept = [p for p, v in enumerate(painted_now) if any(n > vertex for n in neighbors[v])]
        grown: dict[tuple[State, int], float] = {}
        for (state, closed), weight in layer.items():
            for color in (None, *colors):
                painted = list(state)
                gained = weight
                if color is None:
                    painted.append(None)
                else:
                    gained += weights[vertex]
                    met = {
                        own[1]
                        for own, v in zip(state, frontier, strict=True)
                        if own is not None
                        and v in neighbors[vertex]
                        and own[0] == color
                        and color not in cracks.get((min(v, vertex), max(v, vertex)), ())
                    }
                    painted = [
                        (own[0], -1) if own is not None and own[1] in met else own
                        for own in painted
                    ]
                    painted.append((color, -1))
                names: dict[int, int] = {}
                found: list[tuple[int, int] | None] = []
                for place in kept:
                    own = painted[place]
                    found.append(
                        None if own is None else (own[0], names.setdefault(own[1], len(names)))
                    )
                components = {own[1] for own in painted if own is not None}
                key = tuple(found), closed + len(components) - len(names)
                grown[key] = max(grown.get(key, 0.0), gained)
        layer, frontier = grown, [painted_now[p] for p in kept]
    best: dict[int, float] = defaultdict(float)
    for (_, segments), weight in layer.items():
        best[segments] = max(best[segments], weight)
    return {k: max(best[fewer] for fewer in range(k + 1)) for k in range(1, max(best) + 1)}
