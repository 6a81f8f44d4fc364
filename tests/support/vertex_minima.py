"""Minima over all colorings of a mesh's vertices, by a sweep that never sees the graph."""

from __future__ import annotations

from collections import defaultdict

from cellcolor.data.surface import LabelledSurface


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
                closed = len({s for _, s in painted}) - len(names)
                grown[found] = min(grown.get(found, cost + closed), cost + closed)
        layer, frontier = grown, [painted_now[p] for p in kept]
    return min(layer.values())
