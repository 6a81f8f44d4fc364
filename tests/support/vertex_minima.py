"""Minima over all colorings of a mesh's vertices, by sweeps that never see the graph.

Also the fewest color regions that a surface needs, by trying all choices.
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Collection, Sequence

from exhaustive_minima import with_fewer

from cellcolor.data.surface import LabelledSurface


def front_by_vertices(
    surface: LabelledSurface, weights: Sequence[float], required: Collection[int] = ()
) -> dict[int, float]:
    """For each number of segments the greatest weight of vertices that so many components have.

    Every vertex is given one of its colors or, unless it is required, none, in a sweep over the
    vertices in their order. Numbers with which those required cannot be covered are missing.
    Borders run between vertices, so on a coarse mesh less is covered than on the surface.
    """
    cracks = {(c.i, c.j): c.colors for c in surface.cracks}
    neighbors: dict[int, set[int]] = defaultdict(set)
    for i, j in surface.left_of:
        neighbors[i].add(j)
        neighbors[j].add(i)
    # The painted vertices that later ones touch: color and component of each; None if left out.
    Colored = tuple[tuple[int, int] | None, ...]
    frontier: list[int] = []
    layer: dict[tuple[Colored, int], float] = {((), 0): 0.0}
    for vertex, colors in enumerate(surface.vertex_colors):
        painted_now = [*frontier, vertex]
        kept = [p for p, v in enumerate(painted_now) if any(n > vertex for n in neighbors[v])]
        grown: dict[tuple[Colored, int], float] = {}
        for (state, closed), weight in layer.items():
            for color in colors if vertex in required else (None, *colors):
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
    return with_fewer(best)


def vertex_minimum(surface: LabelledSurface) -> int:
    """The fewest connected components of equal color over all colorings of a mesh's vertices.

    Without the topological graph: vertices one by one in their order, which should be one with a
    short frontier.
    """
    cracks = {(c.i, c.j): c.colors for c in surface.cracks}
    neighbors: dict[int, set[int]] = defaultdict(set)
    for i, j in surface.left_of:
        if surface.vertex_colors[i] and surface.vertex_colors[j]:
            neighbors[i].add(j)
            neighbors[j].add(i)
    reached = [v for v, colors in enumerate(surface.vertex_colors) if colors]
    frontier: list[int] = []
    layer: dict[tuple[tuple[int, int], ...], int] = {(): 0}
    for vertex in reached:
        painted_now = [*frontier, vertex]
        kept = [p for p, v in enumerate(painted_now) if any(n > vertex for n in neighbors[v])]
        touched = [
            (place, cracks.get((min(v, vertex), max(v, vertex)), ()))
            for place, v in enumerate(frontier)
            if v in neighbors[vertex]
        ]
        grown: dict[tuple[tuple[int, int], ...], int] = {}
        for state, cost in layer.items():
            for color in surface.vertex_colors[vertex]:
                same = {
                    state[place][1]
                    for place, cracked in touched
                    if state[place][0] == color and color not in cracked
                }
                painted = [(c, -1 if s in same else s) for c, s in state]
                painted.append((color, -1))
                names: dict[int, int] = {}
                found = tuple(
                    (painted[p][0], names.setdefault(painted[p][1], len(names))) for p in kept
                )
                closed = sum(s not in names for _, s in set(painted))
                grown[found] = min(grown.get(found, cost + closed), cost + closed)
        layer, frontier = grown, [painted_now[p] for p in kept]
    return min(layer.values())


def covers(surface: LabelledSurface, count: int) -> list[set[str]]:
    """All choices of so many colors that together reach every reachable vertex."""
    needs = {frozenset(colors) for colors in surface.vertex_colors if colors}
    chosen = itertools.combinations(range(len(surface.colors)), count)
    return [
        {surface.colors[color] for color in colors}
        for colors in chosen
        if all(need & set(colors) for need in needs)
    ]
