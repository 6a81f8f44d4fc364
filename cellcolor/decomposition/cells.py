"""Cells, topological edges and loops of darts of a labelled surface."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePath

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
from cellcolor.data.instance import Instance, SurfaceReference
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition.borders import Borders, ClosedMesh, Curve, Step
from cellcolor.errors import InputError


@dataclass(frozen=True, slots=True)
class Decomposition:
    """A topological graph with the part of the mesh that each of its elements is.

    Attributes:
        instance: the graph.
        curves: where each topological edge lies, by its id; empty if that is not known.
        vertex_cell: the cell of each vertex, ``OUTSIDE`` where unreachable.
    """

    instance: Instance
    curves: Mapping[int, Curve]
    vertex_cell: tuple[int, ...]


def decompose(
    surface: LabelledSurface, path: PurePath | str | None = None, deadline: Deadline = NEVER
) -> Instance:
    """The topological graph of a labelled surface: that of :func:`decomposition_of`."""
    return decomposition_of(surface, path, deadline).instance


def decomposition_of(
    surface: LabelledSurface, path: PurePath | str | None = None, deadline: Deadline = NEVER
) -> Decomposition:
    """The topological graph of a labelled surface (paper, section III-C), and where it lies there.

    Cells are numbered by their smallest vertex. Areas and lengths are those of the barycentric
    dual of the mesh: a vertex owns a third of each of its triangles.

    Args:
        path: where it is stored, relative to the instance; None leaves the reference out.

    Raises:
        InputError: a cell is not planar (its genus is not 0).
    """
    deadline.check()
    vertex_cell, firsts = pieces_of(surface, surface.vertex_colors, (), deadline)
    borders = Borders(surface, vertex_cell)
    curves = borders.curves(deadline)
    loops = loops_of(borders, curves, deadline)
    for cell, genus in handles_of(surface, borders, loops, deadline).items():
        if genus:
            message = f"lies in cell {cell}, which is not planar (genus {genus})"
            raise InputError(None, f"vertices[{firsts[cell]}]", message)
    areas = areas_of(surface, vertex_cell, len(firsts))
    cells = tuple(
        Cell(number, surface.vertex_colors[first], loops.get(number, ()), areas[number])
        for number, first in enumerate(firsts)
    )
    edges = []
    lengths = _lengths(surface, borders.mesh, curves)
    for number, (curve, length) in enumerate(zip(curves, lengths, strict=True), start=1):
        left, right, joinable = borders.kind(curve[0])
        colors = tuple(sorted(joinable)) if surface.cracked(*curve[0]) else None
        edges.append(Edge(number, left, right, colors, length))
    deadline.check()
    reference = None
    if path is not None:
        reference = SurfaceReference(str(path), tuple(vertex_cell), surface.sha256)
    instance = Instance(
        surface.name,
        surface.colors,
        cells,
        tuple(edges),
        surface.meta or None,
        reference,
        coverage=surface.coverage,
    )
    return Decomposition(instance, dict(enumerate(curves, start=1)), tuple(vertex_cell))


def pieces_of(
    surface: LabelledSurface, labels: Sequence[object], unreached: object, deadline: Deadline
) -> tuple[list[int], list[int]]:
    """The piece of each vertex, and the smallest vertex of each piece.

    A piece has equal labels (n,) and is connected over mesh edges without a crack. Vertices that
    are labelled ``unreached`` are ``OUTSIDE``.
    """
    piece_of = [OUTSIDE] * len(labels)
    neighbours: list[list[int]] = [[] for _ in labels]
    for a, b in deadline.watch(surface.left_of):
        if labels[a] == labels[b] and not surface.cracked(a, b):
            neighbours[a].append(b)
            neighbours[b].append(a)
    firsts: list[int] = []
    for vertex, label in deadline.watch(enumerate(labels)):
        if piece_of[vertex] != OUTSIDE or label == unreached:
            continue
        piece_of[vertex] = count = len(firsts)
        firsts.append(vertex)
        stack = [vertex]
        while stack:
            for neighbour in neighbours[stack.pop()]:
                if piece_of[neighbour] == OUTSIDE:
                    piece_of[neighbour] = count
                    stack.append(neighbour)
    return piece_of, firsts


def loops_of(
    borders: Borders, curves: list[Curve], deadline: Deadline
) -> dict[int, tuple[tuple[int, ...], ...]]:
    """Each cell's border loops, as cyclic lists of darts with the cell on the left."""
    dart_at: dict[Step, int] = {}
    for number, curve in enumerate(curves, start=1):
        dart_at[curve[0]] = number
        dart_at[curve[-1][::-1]] = -number
    loops: dict[int, list[tuple[int, ...]]] = {}
    walked: set[Step] = set()
    for first in deadline.watch(dart_at):
        cell = borders.cell_of[first[0]]
        if cell == OUTSIDE or first in walked:
            continue
        darts: list[int] = []
        step = first
        while not darts or step != first:
            if step in dart_at:
                walked.add(step)
                darts.append(dart_at[step])
            step = borders.following(step)
        loops.setdefault(cell, []).append(tuple(darts))
    return {cell: tuple(found) for cell, found in loops.items()}


def handles_of(
    surface: LabelledSurface,
    borders: Borders,
    loops: Mapping[int, tuple[tuple[int, ...], ...]],
    deadline: Deadline,
) -> dict[int, int]:
    """The genus of each cell. By Euler's formula vertices - edges + triangles are 2 - 2 g - b in a
    surface of genus g with b border loops."""
    cell_of = borders.cell_of
    characteristic = Counter(cell_of)
    for a, b in deadline.watch(surface.left_of):
        # A mesh edge stands here once for each of its triangles: count it at one of them.
        inner = cell_of[a] == cell_of[b] and (a, b) not in borders.steps
        if inner and (a < b or (b, a) not in surface.left_of):
            characteristic[cell_of[a]] -= 1
    for a, b, c in deadline.watch(surface.faces.tolist()):
        if not borders.steps.intersection(((a, b), (b, c), (c, a))):
            characteristic[cell_of[a]] += 1
    return {
        cell: (2 - len(loops.get(cell, ())) - own) // 2
        for cell, own in characteristic.items()
        if cell != OUTSIDE
    }


def areas_of(surface: LabelledSurface, vertex_cell: Sequence[int], cells: int) -> list[float]:
    """Square metres of each cell."""
    owner = np.array(vertex_cell)
    reached = owner != OUTSIDE
    sums = np.bincount(owner[reached], surface.vertex_areas[reached], cells)
    return [round(float(value), 12) for value in sums]


def _lengths(surface: LabelledSurface, mesh: ClosedMesh, curves: list[Curve]) -> list[float]:
    """Metres along each curve, from triangle to triangle over the middles of mesh edges."""
    steps = np.array([step for curve in curves for step in curve], dtype=np.int64)
    if not len(steps):
        return []

    def middles(corners: Index) -> Array:
        """Means of the real ones among vertices (k, c), (k, 3); one of each row is real.

        An edge to the outside is crossed at its real end, and the centre of a virtual triangle is
        the middle of its real edge.
        """
        real = corners < mesh.real_count
        places = surface.vertices[np.where(real, corners, 0)] * real[:, :, None]
        return np.asarray(places.sum(axis=1) / real.sum(axis=1)[:, None])

    left, right = steps.T
    here = middles(steps)
    total = np.zeros(len(steps))
    for a, b in ((left, right), (right, left)):
        ahead = np.array([mesh.third[pair] for pair in zip(a.tolist(), b.tolist(), strict=True)])
        total += np.linalg.norm(middles(np.column_stack([a, b, ahead])) - here, axis=1)
    counts = [len(curve) for curve in curves]
    sums = np.add.reduceat(total, np.concatenate([[0], np.cumsum(counts)[:-1]]))
    return [round(float(value), 12) for value in sums]
