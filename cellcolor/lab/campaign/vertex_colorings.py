"""The fewest segments of a small mesh over all colorings of its vertices, without the graph."""

from __future__ import annotations

from cellcolor.data.surface import LabelledSurface

_Front = tuple[tuple[int, int], ...]
"""Color and number of the segment of each painted vertex that still has unpainted neighbors."""


def fewest_by_vertices(surface: LabelledSurface, most_states: int) -> int | None:
    """The fewest connected components of equal color over all colorings of a mesh's vertices.

    Vertices are painted one by one in their order; of all partial colorings that look alike from
    the unpainted ones only the cheapest is kept. A coloring of the vertices is a division of the
    surface, so no lower bound for the surface may exceed this; fewer may be possible where the
    mesh is too coarse for a corridor.

    Args:
        surface: small, its vertices in an order with a short front, such as row by row.
        most_states: give up beyond so many partial colorings at a time.

    Returns:
        The minimum, None when given up.
    """
    neighbors: dict[int, dict[int, set[int]]] = {
        vertex: {} for vertex, colors in enumerate(surface.vertex_colors) if colors
    }
    for i, j in surface.left_of:
        shared = set(surface.vertex_colors[i]) & set(surface.vertex_colors[j])
        common = shared - surface.cracked(i, j)
        if common:
            neighbors[i][j] = neighbors[j][i] = common
    front: list[int] = []
    best: dict[_Front, int] = {(): 0}
    for vertex, near in neighbors.items():
        painted = [*front, vertex]
        following = [v for v in painted if any(other > vertex for other in neighbors[v])]
        kept = set(following)
        grown: dict[_Front, int] = {}
        for state, closed in best.items():
            for color in surface.vertex_colors[vertex]:
                joined = {
                    segment
                    for v, (own, segment) in zip(front, state, strict=True)
                    if own == color and color in near.get(v, ())
                }
                segments = [-1 if segment in joined else segment for _, segment in state] + [-1]
                colors = [own for own, _ in state] + [color]
                names: dict[int, int] = {}
                found = tuple(
                    (own, names.setdefault(segment, len(names)))
                    for v, own, segment in zip(painted, colors, segments, strict=True)
                    if v in kept
                )
                cost = closed + len(set(segments)) - len(names)
                if cost < grown.get(found, cost + 1):
                    grown[found] = cost
        if len(grown) > most_states:
            return None
        front, best = following, grown
    return best[()]
