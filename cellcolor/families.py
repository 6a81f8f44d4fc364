"""Random instance families, made on demand: blobs on a grid, hubs, abstract planar graphs.

All of them are functions of a seed and a few numbers; the same arguments give the same instance.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from functools import cache

import numpy as np
from numpy.typing import NDArray

from cellcolor.data.instance import OUTSIDE, Cell, Edge, Instance, Known, KnownResult
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.errors import InputError

__all__ = ["blobs", "hub", "hub_grid", "hub_minimum", "planar_graph"]


def blobs(
    seed: int,
    size: int = 24,
    colors: int = 6,
    *,
    waves: float = 0.7,
    coverage: tuple[float, float] = (0.35, 0.65),
    thin: bool = False,
    cracks: int = 0,
    rim: int = 0,
    islands: int = 0,
    holes: int = 0,
) -> LabelledSurface:
    """Smooth random color domains on a square grid mesh.

    Each color reaches where a random field of a few waves is high (or, ``thin``, near its median:
    bands instead of blobs). Where domains overlap a point has several colors, where none reaches
    it has none.

    Args:
        seed: of everything random.
        size: points along each side of the grid, two or more.
        colors: how many, one or more.
        waves: how many waves of a field fit across the grid, or nearly; more waves, more cells.
        coverage: the least and the largest share of the grid that a color reaches.
        thin: narrow bands instead of round blobs.
        cracks: random paths over the mesh that the colors common to both sides do not cross.
        rim: discs on the border of the grid that only one color reaches. With a large coverage
            they make the cell in their middle one that has to be cut.
        islands: such discs anywhere.
        holes: discs that no color reaches.

    Raises:
        InputError: a size below 2 or no colors.
    """
    if size < 2 or colors < 1:
        raise InputError(None, None, f"blobs need a size of 2 or more (is {size}) and a color")
    rng = np.random.default_rng([seed, size, colors])
    y, x = np.mgrid[0:size, 0:size]
    reached = np.zeros((colors, size, size), dtype=bool)
    for color in range(colors):
        field = _waves(rng, x / size, y / size, waves)
        if thin:
            field = -np.abs(field - np.median(field))
        reached[color] = field >= np.quantile(field, 1.0 - rng.uniform(*coverage))
    for number in range(rim + islands + holes):
        center = rng.uniform(0.2, 0.8, 2) * (size - 1)
        if number < rim:
            center[rng.integers(2)] = rng.integers(2) * (size - 1)
        radius = rng.uniform(0.09, 0.2) * size
        disc = np.hypot(x - center[0], y - center[1]) <= radius
        reached[:, disc] = False
        if number < rim + islands:
            reached[rng.integers(colors), disc] = True
    vertex_colors = tuple(
        tuple(np.flatnonzero(available).tolist()) for available in reached.reshape(colors, -1).T
    )
    faces = _grid_faces(size)
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(size * size)], axis=1).astype(np.float64)
    return LabelledSurface(
        f"blobs_{seed}",
        tuple(f"c{color}" for color in range(colors)),
        vertices,
        faces,
        vertex_colors,
        _crack_paths(rng, faces, vertex_colors, cracks, size),
        {"family": "blobs", "seed": seed},
    )


def _waves(
    rng: np.random.Generator, x: NDArray[np.float64], y: NDArray[np.float64], frequency: float
) -> NDArray[np.float64]:
    """A smooth random field: a dozen plane waves of about the given frequency."""
    field = np.zeros_like(x)
    for _ in range(12):
        kx, ky = rng.normal(0.0, frequency / 2, 2)
        field += np.cos(2 * np.pi * (kx * x + ky * y) + rng.uniform(0, 2 * np.pi))
    return field


def _grid_faces(size: int) -> NDArray[np.int64]:
    """Two counter-clockwise triangles for each square of the grid."""
    corner = (np.arange(size - 1)[:, None] * size + np.arange(size - 1)).ravel()
    lower = np.stack([corner, corner + 1, corner + size + 1], axis=1)
    upper = np.stack([corner, corner + size + 1, corner + size], axis=1)
    return np.stack([lower, upper], axis=1).reshape(-1, 3).astype(np.int64)


def _crack_paths(
    rng: np.random.Generator,
    faces: NDArray[np.int64],
    vertex_colors: Sequence[tuple[int, ...]],
    count: int,
    length: int,
) -> tuple[Crack, ...]:
    """Walks from triangle to triangle; what they cross is cracked for a few common colors."""
    faces_of: dict[tuple[int, int], list[int]] = {}
    for number, face in enumerate(faces.tolist()):
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            faces_of.setdefault((min(a, b), max(a, b)), []).append(number)
    edges_of: list[list[tuple[int, int]]] = [[] for _ in faces]
    for edge, sides in faces_of.items():
        for side in sides:
            edges_of[side].append(edge)
    cracked: dict[tuple[int, int], tuple[int, ...]] = {}
    for _ in range(count):
        face = int(rng.integers(len(faces)))
        available = sorted({color for vertex in faces[face] for color in vertex_colors[vertex]})
        chosen = {color for color in available if rng.random() < 0.7}
        visited = {face}
        for _ in range(int(rng.integers(2, length + 1))):
            onward = [
                (edge, side)
                for edge in edges_of[face]
                for side in faces_of[edge]
                if side not in visited and edge not in cracked
            ]
            if not onward:
                break
            edge, face = onward[int(rng.integers(len(onward)))]
            visited.add(face)
            common = chosen & set(vertex_colors[edge[0]]) & set(vertex_colors[edge[1]])
            if common:
                cracked[edge] = tuple(sorted(common))
    return tuple(Crack(i, j, common) for (i, j), common in sorted(cracked.items()))


def hub(seed: int, petals: int, colors: int) -> Instance:
    """One cell with all colors, ringed by single-colored cells, no two equal neighbors.

    Its minimum is known (:func:`hub_minimum`) and bounds that count colors say nothing about it.

    Args:
        seed: of the petals' colors.
        petals: how many, two or more.
        colors: how many, two or more; three or more for an odd number of petals.

    Raises:
        InputError: there is no such hub.
    """
    if petals < 2 or colors < 2 or (petals % 2 and colors == 2):
        raise InputError(None, None, f"no hub has {petals} petals in {colors} colors")
    rng = random.Random(f"hub {seed} {petals} {colors}")
    while True:
        ring = [rng.randrange(colors)]
        while len(ring) < petals:
            ring.append(rng.choice([color for color in range(colors) if color != ring[-1]]))
        if ring[0] != ring[-1]:
            break
    return _hub(f"hub_{seed}_{petals}", ring, colors)


def _hub(name: str, ring: Sequence[int], colors: int) -> Instance:
    n = len(ring)
    cells = [Cell(0, tuple(range(colors)), (tuple(range(1, n + 1)),))]
    edges = [Edge(i, 0, i) for i in range(1, n + 1)]
    for i in range(1, n + 1):
        before, after, outer = n + (i - 2) % n + 1, n + i, 2 * n + i
        cells.append(Cell(i, (ring[i - 1],), ((-i, -before, outer, after),)))
        edges.append(Edge(after, i, i % n + 1))
        edges.append(Edge(outer, i, OUTSIDE))
    return Instance(
        name,
        tuple(f"c{color}" for color in range(colors)),
        tuple(cells),
        tuple(sorted(edges, key=lambda edge: edge.id)),
        known=Known(paper=KnownResult(hub_minimum(ring))),
    )


def hub_minimum(petal_colors: Sequence[int]) -> int:
    """The minimum of a hub: its petals less the most that corridors through the hub can join.

    The corridors join petals of one color without crossing. A petal is the first of its interval
    and stays alone, or is joined to a later one, which leaves what lies between and beyond.
    """

    @cache
    def joined(first: int, last: int) -> int:
        if first >= last:
            return 0
        best = joined(first + 1, last)
        for k in range(first + 1, last + 1):
            if petal_colors[k] == petal_colors[first]:
                best = max(best, joined(first + 1, k - 1) + 1 + joined(k, last))
        return best

    return len(petal_colors) - joined(0, len(petal_colors) - 1)


def hub_grid(seed: int, rows: int, columns: int, colors: int, side: int = 2) -> Instance:
    """Hubs in a grid that share the petals between them.

    A hub is a square cell with all colors and ``side`` single-colored petals on each of its four
    sides. A petal between two hubs has a live edge to both, one at the rim of the grid to one; no
    two successive petals of a side are equal. What lies between four hubs is unreachable. Bounds
    that count colors say nothing here, and unlike a single hub it has no recursion for its minimum.

    Args:
        seed: of the petals' colors.
        rows: of hubs, one or more.
        columns: of hubs, one or more.
        colors: how many, two or more.
        side: petals on each side of a hub, one or more.

    Raises:
        InputError: there is no such grid.
    """
    if rows < 1 or columns < 1 or colors < 2 or side < 1:
        raise InputError(
            None,
            None,
            f"no grid has {rows} x {columns} hubs, {side} petals a side, {colors} colors",
        )
    rng = random.Random(f"hub grid {seed} {rows} {columns} {colors} {side}")
    sets: list[tuple[int, ...]] = [tuple(range(colors))] * (rows * columns)
    loops: list[tuple[int, ...]] = [()] * (rows * columns)
    edges: list[Edge] = []

    def border(left: int, right: int) -> int:
        edges.append(Edge(len(edges) + 1, left, right))
        return len(edges)

    def strip(near: int, far: int) -> tuple[list[int], list[int]]:
        """Petals between two areas, as walks round each of the two meet them.

        Looking from the near area to the far one they follow each other from right to left.
        """
        nears: list[int] = []
        fars: list[int] = []
        behind = None
        for number in range(side):
            petal = len(sets)
            last = sets[-1] if number else ()
            sets.append((rng.choice([color for color in range(colors) if color not in last]),))
            right = border(petal, OUTSIDE) if behind is None else -behind
            nears.append(border(near, petal))
            fars.insert(0, -border(petal, far))
            behind = border(petal, petal + 1 if number < side - 1 else OUTSIDE)
            loops.append((right, -fars[0], behind, -nears[-1]))
        return nears, fars

    # Row by row from the bottom, so that the strips below and to the left of a hub are known.
    above: dict[tuple[int, int], list[int]] = {}
    beside: dict[tuple[int, int], list[int]] = {}
    for row in range(rows):
        for column in range(columns):
            hub_id = row * columns + column
            bottom = above[row - 1, column] if row else strip(OUTSIDE, hub_id)[1]
            left = beside[row, column - 1] if column else strip(OUTSIDE, hub_id)[1]
            right_hub = hub_id + 1 if column < columns - 1 else OUTSIDE
            right, beside[row, column] = strip(hub_id, right_hub)
            top, above[row, column] = strip(hub_id, hub_id + columns if row < rows - 1 else OUTSIDE)
            loop: list[int] = []
            for darts in (bottom, right, top, left):
                loop += [*darts, border(hub_id, OUTSIDE)]
            loops[hub_id] = tuple(loop)
    return Instance(
        f"hub_grid_{seed}_{rows}x{columns}x{side}",
        tuple(f"c{color}" for color in range(colors)),
        tuple(Cell(i, own, (loop,)) for i, (own, loop) in enumerate(zip(sets, loops, strict=True))),
        tuple(edges),
    )


def planar_graph(
    seed: int, cells: int, edges: int, colors: int, *, self_edges: bool = False
) -> Instance:
    """A random connected planar graph with random color sets, no surface behind it.

    Grown edge by edge between two corners around one point where areas meet, which keeps it
    planar and every cell's border one loop. Some edges are joinable in fewer colors than their
    cells share, some are dead.

    Args:
        seed: of everything random.
        cells: how many, one or more.
        edges: between cells, at least ``cells - 1``.
        colors: how many, one or more.
        self_edges: whether a cell may lie on both sides of an edge.

    Raises:
        InputError: too few cells, edges or colors.
    """
    if cells < 1 or colors < 1 or edges < cells - 1:
        raise InputError(None, None, f"no graph has {cells} cells, {edges} edges, {colors} colors")
    rng = random.Random(f"planar {seed} {cells} {edges} {colors} {self_edges}")
    sets = [tuple(sorted(rng.sample(range(colors), rng.randint(1, colors)))) for _ in range(cells)]
    rotation = _Rotation()
    made: list[Edge] = []
    for number in range(1, edges + 1):
        if number < cells:
            left, right = rng.randrange(number), number
            rotation.insert(number, left, rotation.any_dart(rng, left))
            rotation.insert(-number, right, None)
        else:
            ends = rotation.corners_to_join(rng, self_edges)
            if ends is None:
                break
            (left, after_left), (right, after_right) = ends
            rotation.insert(number, left, after_left)
            rotation.insert(-number, right, number if after_right == after_left else after_right)
        shared = sorted(set(sets[left]) & set(sets[right]))
        kept = None
        if shared and rng.random() < 0.25:
            kept = tuple(sorted(rng.sample(shared, rng.randrange(len(shared)))))
        made.append(Edge(number, left, right, kept))
    return Instance(
        f"planar_{seed}",
        tuple(f"c{color}" for color in range(colors)),
        tuple(
            Cell(i, sets[i], (tuple(rotation.darts[i]),) if rotation.darts.get(i) else ())
            for i in range(cells)
        ),
        tuple(made),
    )


class _Rotation:
    """The cyclic list of darts of each cell while a planar graph grows."""

    def __init__(self) -> None:
        self.darts: dict[int, list[int]] = {}
        self._cell: dict[int, int] = {}

    def insert(self, dart: int, cell: int, after: int | None) -> None:
        """Put a dart into a cell's list after another, or first of all."""
        darts = self.darts.setdefault(cell, [])
        darts.insert(0 if after is None else darts.index(after) + 1, dart)
        self._cell[dart] = cell

    def any_dart(self, rng: random.Random, cell: int) -> int | None:
        """A random dart of a cell, None if it has none yet."""
        darts = self.darts.get(cell)
        return rng.choice(darts) if darts else None

    def corners_to_join(
        self, rng: random.Random, self_edges: bool
    ) -> tuple[tuple[int, int | None], tuple[int, int | None]] | None:
        """Two corners around one point, each as its cell and the dart before it."""
        pairs: list[tuple[int, int]] = []
        for first in self._cell:
            here = first
            while True:
                if self_edges or self._cell[here] != self._cell[first]:
                    pairs.append((first, here))
                # The end of a dart is the start of its twin: the corner before the twin is next.
                darts = self.darts[self._cell[-here]]
                here = darts[darts.index(-here) - 1]
                if here == first:
                    break
        if not pairs:
            if self._cell or not self_edges:
                return None
            return (0, None), (0, None)
        one, other = rng.choice(sorted(pairs))
        return (self._cell[one], one), (self._cell[other], other)
