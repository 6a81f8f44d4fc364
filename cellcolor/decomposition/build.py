"""Cells, topological edges and loops of darts of a labelled surface."""

from __future__ import annotations

from collections import Counter
from pathlib import PurePath

import numpy as np
from numpy.typing import NDArray

from cellcolor.data.instance import OUTSIDE, Cell, Edge, Instance, SurfaceReference
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition.borders import Borders, ClosedMesh, Curve, Step
from cellcolor.errors import InputError


def decompose(surface: LabelledSurface, path: PurePath | str | None = None) -> Instance:
    """The topological graph of a labelled surface (paper, section III-C).

    Cells are numbered by their smallest vertex. Areas and lengths are those of the barycentric
    dual of the mesh: a vertex owns a third of each of its triangles.

    Args:
        surface: the labelled surface.
        path: where it is stored, relative to the instance; None leaves the reference out.

    Raises:
        InputError: a cell is not planar (its genus is not 0).
    """
    mesh = ClosedMesh(surface)
    cracks = {(c.i, c.j): frozenset(c.colors) for c in surface.cracks}
    sets = [frozenset(colors) for colors in surface.vertex_colors]
    sets += [frozenset()] * (mesh.vertex_count - mesh.real_count)

    def crack(a: int, b: int) -> frozenset[int]:
        return cracks.get((a, b) if a < b else (b, a), frozenset())

    def joinable(a: int, b: int) -> frozenset[int]:
        return (sets[a] & sets[b]) - crack(a, b)

    area = _cells(surface, mesh, cracks)
    borders = Borders(mesh, area, joinable, lambda a, b: bool(crack(a, b)))
    curves = borders.curves()
    loops = _loops(borders, curves, area)
    _check_planar(surface, area, borders, loops)

    measure = _DualMeasure(surface, mesh)
    areas = measure.areas(area)
    cells = tuple(
        Cell(
            number, surface.vertex_colors[area.index(number)], loops.get(number, ()), areas[number]
        )
        for number in range(max(area, default=OUTSIDE) + 1)
    )
    edges = []
    for number, curve in enumerate(curves, start=1):
        left, right = curve.steps[0]
        shared, joined = sets[left] & sets[right], joinable(left, right)
        colors = None if shared == joined else tuple(sorted(joined))
        edges.append(Edge(number, area[left], area[right], colors, measure.length(curve)))
    reference = None
    if path is not None:
        reference = SurfaceReference(str(path), tuple(area[: mesh.real_count]), surface.sha256)
    return Instance(
        surface.name, surface.colors, cells, tuple(edges), surface.meta or None, reference
    )


def _cells(
    surface: LabelledSurface, mesh: ClosedMesh, cracks: dict[tuple[int, int], frozenset[int]]
) -> list[int]:
    """The cell of each vertex: equal color sets, connected over mesh edges without a crack."""
    area = [OUTSIDE] * mesh.vertex_count
    neighbours: list[list[int]] = [[] for _ in range(mesh.real_count)]
    for a, b in surface.left_of:
        pair = (a, b) if a < b else (b, a)
        if surface.vertex_colors[a] == surface.vertex_colors[b] and pair not in cracks:
            neighbours[a].append(b)
            neighbours[b].append(a)
    count = 0
    for vertex, colors in enumerate(surface.vertex_colors):
        if area[vertex] != OUTSIDE or not colors:
            continue
        area[vertex] = count
        stack = [vertex]
        while stack:
            for neighbour in neighbours[stack.pop()]:
                if area[neighbour] == OUTSIDE:
                    area[neighbour] = count
                    stack.append(neighbour)
        count += 1
    return area


def _loops(
    borders: Borders, curves: list[Curve], area: list[int]
) -> dict[int, tuple[tuple[int, ...], ...]]:
    """Each cell's border loops, as cyclic lists of darts with the cell on the left."""
    dart_at: dict[Step, int] = {}
    for number, curve in enumerate(curves, start=1):
        dart_at[curve.steps[0]] = number
        last = curve.steps[-1]
        dart_at[last[1], last[0]] = -number
    loops: dict[int, list[tuple[int, ...]]] = {}
    walked: set[Step] = set()
    for first in dart_at:
        cell = area[first[0]]
        if cell == OUTSIDE or first in walked:
            continue
        darts = []
        step = first
        while True:
            if step in dart_at:
                walked.add(step)
                darts.append(dart_at[step])
            step = borders.following(step)
            if step == first:
                break
        loops.setdefault(cell, []).append(tuple(darts))
    return {cell: tuple(found) for cell, found in loops.items()}


def _check_planar(
    surface: LabelledSurface,
    area: list[int],
    borders: Borders,
    loops: dict[int, tuple[tuple[int, ...], ...]],
) -> None:
    """Euler's formula for each cell: a surface of genus g with b border loops has 2 - 2g - b."""
    characteristic: Counter[int] = Counter(c for c in area if c != OUTSIDE)
    for a, b in surface.left_of:
        # A mesh edge stands here once for each of its triangles: count it at one of them.
        inner = area[a] == area[b] and (a, b) not in borders.steps
        if inner and (a < b or (b, a) not in surface.left_of):
            characteristic[area[a]] -= 1
    for a, b, c in surface.faces.tolist():
        if not borders.steps.intersection(((a, b), (b, c), (c, a))):
            characteristic[area[a]] += 1
    for cell in range(max(area, default=OUTSIDE) + 1):
        handles = 2 - len(loops.get(cell, ())) - characteristic[cell]
        if handles != 0:
            raise InputError(
                None,
                f"vertices[{area.index(cell)}]",
                f"lies in cell {cell}, which is not planar (genus {handles // 2})",
            )


class _DualMeasure:
    """Areas and lengths on the barycentric dual of the mesh."""

    def __init__(self, surface: LabelledSurface, mesh: ClosedMesh) -> None:
        self._surface = surface
        self._mesh = mesh

    def areas(self, area: list[int]) -> list[float]:
        """Square metres of each cell."""
        corners = self._surface.vertices[self._surface.faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        thirds = np.repeat(np.linalg.norm(normals, axis=1) / 6.0, 3)
        owner = np.array(area)[self._surface.faces.ravel()]
        reached = owner != OUTSIDE
        sums = np.bincount(owner[reached], weights=thirds[reached], minlength=max(area) + 1)
        return [round(float(value), 12) for value in sums]

    def length(self, curve: Curve) -> float:
        """Metres along a curve, from triangle to triangle over the middles of mesh edges."""
        total = 0.0
        for left, right in curve.steps:
            here = self._crossing(left, right)
            for a, b in ((left, right), (right, left)):
                total += float(np.linalg.norm(self._centre(a, b) - here))
        return round(total, 12)

    def _crossing(self, a: int, b: int) -> NDArray[np.float64]:
        """Where the dual crosses edge a-b; an edge to the outside is crossed at its real end."""
        vertices, count = self._surface.vertices, self._mesh.real_count
        if a >= count:
            return np.asarray(vertices[b])
        if b >= count:
            return np.asarray(vertices[a])
        return np.asarray((vertices[a] + vertices[b]) / 2.0)

    def _centre(self, a: int, b: int) -> NDArray[np.float64]:
        """Centre of the triangle left of a-b; of a virtual one, the middle of its real edge."""
        corners = (a, b, self._mesh.third[a, b])
        real = [v for v in corners if v < self._mesh.real_count]
        return np.asarray(self._surface.vertices[real].mean(axis=0))
