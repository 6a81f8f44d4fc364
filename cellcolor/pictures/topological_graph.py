"""The topological graph in the plane: cells as nodes, darts around them in cyclic order.

The places of the nodes mean nothing. What is exact is the order of the darts around each node,
counter-clockwise as seen from outside the object.
"""

from __future__ import annotations

import networkx as nx
import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.cells_and_edges import OUTSIDE, Cell
from cellcolor.data.instance import Instance
from cellcolor.data.wording import count
from cellcolor.pictures.picture import INK, PAINTS, Outline, Picture2D, PlaneLine

_DEAD = "dead edge"
_POINTS_WIDE = 480.0
_SAMPLES = 33

_Text = tuple[str, Array, float]
"""A text, its place (2,), and its size in points."""
_Ring = list[tuple[int | None, Array]]
"""The darts around a cell, None between two loops, each with its direction (2,) from the center."""


def draw_graph(graph: Instance) -> Picture2D:
    """The graph; where its nodes are means nothing."""
    radii = np.array([0.8 + 0.08 * sum(map(len, cell.loops)) for cell in graph.cells])
    centers = _layout(graph, radii)
    low, high = (centers - radii[:, None], centers + radii[:, None]) if len(radii) else ([], [])
    extent = float((np.max(high, axis=0) - np.min(low, axis=0)).max()) if len(radii) else 1.0
    unit = extent / _POINTS_WIDE  # one point of the printed picture
    rings = [_ring(graph, cell, centers) for cell in graph.cells]
    ways = {dart: way for ring in rings for dart, way in ring if dart is not None}

    lines: list[PlaneLine] = []
    texts: list[_Text] = []
    for edge in graph.edges:
        sides = [
            (centers[cell] + radii[cell] * ways[dart], ways[dart])
            for dart, cell in ((edge.id, edge.left), (-edge.id, edge.right))
            if cell != OUTSIDE
        ]
        start, out = sides[0]
        path = np.array([start, start + 0.3 * out])  # the end of an edge to the outside
        if len(sides) == 2:
            path = _path(start, out, *sides[1])
        colors = graph.joinable(edge.id)
        if not colors:
            lines.append(PlaneLine(_DEAD, "#777777", path, 1.0, dashed=True))
        for place, color in enumerate(colors):
            shifted = _beside(path, (place - (len(colors) - 1) / 2) * 2.2 * unit)
            name = f"{color}: {graph.colors[color]}"
            lines.append(PlaneLine(name, PAINTS[color % len(PAINTS)], shifted, 2.0))
        if len(graph.colors) > len(PAINTS) and colors:
            texts.append((",".join(map(str, colors)), path[len(path) // 2], 6.0))

    outlines: list[Outline] = []
    for cell, ring in zip(graph.cells, rings, strict=True):
        shapes, numbers = _node(cell, centers[cell.id], float(radii[cell.id]), ring, unit)
        outlines += shapes
        texts += numbers
    # The legend has the colors in their order, dead edges last.
    order = [f"{color}: {name}" for color, name in enumerate(graph.colors)] + [_DEAD]
    lines.sort(key=lambda line: order.index(line.name))
    notes = [
        "Node: a cell; its rim: the colors available there.",
        "Small numbers: its darts in cyclic order, counter-clockwise",
        "as seen from outside; black bars separate the loops of a cell with holes.",
        "Edge: one line for each joinable color. Positions mean nothing.",
    ]
    if len(graph.colors) > len(PAINTS):
        notes.append("Line colors repeat: the numbers on the edges identify the colors.")
    cells, edges = count(len(graph.cells), "cell"), count(len(graph.edges), "edge")
    title = f"{graph.name}: {cells}, {edges}"
    return Picture2D(title, tuple(lines), tuple(outlines), tuple(texts), tuple(notes))


def _node(
    cell: Cell, center: Array, radius: float, ring: _Ring, unit: float
) -> tuple[list[Outline], list[_Text]]:
    """A cell: a disc with its colors on the rim, its number, and its darts around that.

    Args:
        center: (2,) of the disc.
        radius: of the disc.
        ring: what stands around it.
        unit: one point of the printed picture.
    """
    shapes = []
    bounds = np.linspace(0, 2 * np.pi, len(cell.colors) + 1) + np.pi / 2
    for color, start, end in zip(cell.colors, bounds[:-1], bounds[1:], strict=True):
        wedge = _arc(center, radius, start, end, hub=len(cell.colors) > 1)
        shapes.append(Outline(PAINTS[color % len(PAINTS)], wedge))
    shapes.append(Outline("#FFFFFF", _arc(center, 0.86 * radius, 0.0, 2 * np.pi, hub=False)))
    texts: list[_Text] = [(str(cell.id), center, min(11.0, 0.45 * radius / unit))]
    darts = sum(map(len, cell.loops))
    size = min(7.0, 2.0 * radius / unit / max(darts, 6))
    for dart, way in ring:
        if dart is None:
            shapes.append(Outline(INK, center + radius * np.array([[0.45], [0.86]]) * way))
        else:
            texts.append((f"{dart:+d}", center + 0.7 * radius * way, round(float(size), 2)))
    return shapes, texts


def _layout(instance: Instance, radii: Array) -> Array:
    """Centers of the nodes, apart from each other by more than their radii."""
    if not len(radii):
        return np.zeros((0, 2))
    graph = nx.Graph([(edge.left, edge.right) for edge in instance.edges if edge.right != OUTSIDE])
    graph.remove_nodes_from([OUTSIDE])
    graph.add_nodes_from(range(len(radii)))
    start = nx.planar_layout(graph) if nx.is_planar(graph) else None
    found = nx.kamada_kawai_layout(graph, pos=start)
    places = np.array([found[cell] for cell in range(len(radii))])
    size = float(np.ptp(places, axis=0).max()) or 1.0
    centers = (places - places.mean(axis=0)) / size * 2.2 * float(radii.sum()) ** 0.5
    # Equal places are moved apart in directions of their own.
    centers = centers + 1e-3 * np.array([_direction(2.4 * cell) for cell in range(len(radii))])
    wanted = 1.7 * (radii[:, None] + radii[None, :])
    for _ in range(400):
        offsets = centers[:, None] - centers[None, :]
        distances = np.linalg.norm(offsets, axis=2)
        np.fill_diagonal(distances, np.inf)
        overlap = np.maximum(wanted - distances, 0.0)
        if not overlap.any():
            break
        push = (overlap / distances)[:, :, None] * offsets
        centers = centers + 0.25 * push.sum(axis=1)
    return np.asarray(centers)


def _ring(instance: Instance, cell: Cell, centers: Array) -> _Ring:
    """Loop by loop the directions of a cell's darts, turned towards where they lead."""
    gap = [None] if len(cell.loops) > 1 else []
    places = [dart for loop in cell.loops for dart in (*loop, *gap)]
    angles = 2 * np.pi * np.arange(len(places)) / max(len(places), 1)
    pull = 0j
    for dart, angle in zip(places, angles, strict=True):
        other = OUTSIDE if dart is None else instance.across(dart)
        if other not in (OUTSIDE, cell.id):
            x, y = centers[other] - centers[cell.id]
            pull += complex(x, y) / abs(complex(x, y)) * np.exp(-1j * angle)
    turn = float(np.angle(pull)) if abs(pull) > 1e-9 else 0.0
    return [(dart, _direction(at + turn)) for dart, at in zip(places, angles, strict=True)]


def _direction(angle: float) -> Array:
    return np.array([np.cos(angle), np.sin(angle)])


def _path(start: Array, out: Array, end: Array, into: Array) -> Array:
    """A cubic Bézier curve that leaves and enters its nodes straight."""
    reach = max(0.45 * float(np.linalg.norm(end - start)), 0.4)
    a, b = start + reach * out, end + reach * into
    t = np.linspace(0, 1, _SAMPLES)[:, None]
    return np.asarray(
        (1 - t) ** 3 * start + 3 * t * (1 - t) ** 2 * a + 3 * t**2 * (1 - t) * b + t**3 * end
    )


def _beside(path: Array, offset: float) -> Array:
    tangents = np.gradient(path, axis=0)
    tangents /= np.maximum(np.linalg.norm(tangents, axis=1, keepdims=True), 1e-12)
    return np.asarray(path + offset * np.column_stack([-tangents[:, 1], tangents[:, 0]]))


def _arc(center: Array, radius: float, start: float, end: float, *, hub: bool) -> Array:
    angles = np.linspace(start, end, 49)
    rim = center + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    return np.concatenate([rim, center[None]]) if hub else rim[:-1]
