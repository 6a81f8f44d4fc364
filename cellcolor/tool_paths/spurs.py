"""What a pattern has left uncovered, reached by spurs: ways from the path there and back."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array
from cellcolor.deadline import Deadline
from cellcolor.tool_paths.registry import Laid
from cellcolor.tool_paths.triangles import Triangles, off_border, ways_from, with_room_inside

_FAR = 0.75  # spacings: what is farther from the path has to be reached
_STOP = 0.5  # spacings: a spur ends so far before what it reaches
_SMALL = 0.1  # spacings squared: smaller places are left as they are, unless they are far away
_VERY_FAR = 1.25  # spacings
_ROUNDS = 12


def with_spurs(laid: Laid, spacing: float, deadline: Deadline) -> Laid:
    """The same path with spurs to all that is too far from it.

    Where the pattern found no room for a path there is one along the part, and spurs from it.
    """
    mesh = with_room_inside(laid.mesh)
    weights = off_border(mesh, spacing / 2)
    graph = mesh.graph(weights)
    walk = laid.walk if len(laid.walk) > 1 else _along(mesh, weights, spacing)
    for _ in range(_ROUNDS):
        deadline.check()
        targets = _targets(mesh, mesh.distances_from(np.unique(walk)), spacing)
        if not targets:
            break
        nearest = ways_from(graph, np.unique(walk))
        spurs = dict[int, list[int]]()
        for target, far in targets:
            way = nearest.back_from(target)
            if mesh.border[target] and len(way) > 2:
                way = way[1:]
            spur = way[_short_of(mesh, way, min(_STOP * spacing, far / 2)) :]
            spurs.setdefault(spur[-1], []).extend([*spur[-2::-1], *spur[1:]])
        longer: list[int] = []
        for vertex in walk:  # each spur where the walk first comes there
            longer.append(vertex)
            longer += spurs.pop(vertex, [])
        walk = longer
    return Laid(mesh, walk)


def _short_of(mesh: Triangles, way: list[int], length: float) -> int:
    """The place on a way that is so far from its beginning, but not its last one."""
    return min(int(np.searchsorted(_lengths_along(mesh, way)[1:], length)), len(way) - 2)


def _lengths_along(mesh: Triangles, way: list[int]) -> Array:
    """How far each vertex of a way is from its beginning, m."""
    steps = np.linalg.norm(np.diff(mesh.points[way], axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _targets(mesh: Triangles, distances: Array, spacing: float) -> list[tuple[int, float]]:
    """The farthest vertex of every place that has to be reached, and how far it is."""
    found = []
    for members in mesh.places(distances > _FAR * spacing):
        farthest = int(members[distances[members].argmax()])
        area = float(mesh.vertex_areas[members].sum())
        if area > _SMALL * spacing**2 or distances[farthest] > _VERY_FAR * spacing:
            found.append((farthest, float(distances[farthest])))
    return found


def _along(mesh: Triangles, weights: Array, spacing: float) -> list[int]:
    """A way from one end of a part to the other, its ends half a spacing short."""
    graph = mesh.graph(weights)
    one = int(ways_from(graph, np.array([0])).lengths.argmax())
    ways = ways_from(graph, np.array([one]))
    way = ways.back_from(int(ways.lengths.argmax()))
    lengths = _lengths_along(mesh, way)
    off = min(spacing / 2, lengths[-1] / 4)
    inner = [v for v, at in zip(way, lengths, strict=True) if off <= at <= lengths[-1] - off]
    return inner if len(inner) > 1 else way[: max(2, len(way) // 2 + 1)]
