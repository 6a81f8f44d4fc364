"""The surfaces of docs/concepts.md: small, flat, made for one term each, solved by the package."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cellcolor.data.solution import Solution
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decomposition_of
from cellcolor.decomposition.borders import ClosedMesh
from cellcolor.pictures.surface_pictures import draw_segments
from cellcolor.solvers.checked import enumerate_schemes, solve
from cellcolor.solvers.interface import Options

Array = NDArray[np.float64]
Where = Callable[[Array, Array], NDArray[np.bool_]]
RED, BLUE, GREEN, YELLOW = range(4)
NAMES = ("red", "blue", "green", "yellow")


class Example:
    """A flat surface with its cells and topological edges.

    Args:
        domains: where each color is available, as functions of x and y.
        size: width and height.
        step: the distance of neighboring points.
        hole: where there is no surface.
        cracked: mesh edges, by the places of their two ends (n, 2), that red and blue do not cross.
    """

    def __init__(
        self,
        *domains: Where,
        size: tuple[float, float] = (4.0, 2.6),
        step: float = 0.1,
        hole: Where | None = None,
        cracked: Callable[[Array, Array], NDArray[np.bool_]] | None = None,
    ) -> None:
        points, faces = _mesh(*size, step)
        x, y = points.T
        if hole is not None:
            faces = faces[~hole(*points[faces].mean(axis=1).T)]
            used, faces = np.unique(faces, return_inverse=True)
            points, faces = points[used], faces.reshape(-1, 3)
            x, y = points.T
        reached = np.stack([domain(x, y) & np.ones(len(x), dtype=bool) for domain in domains], 1)
        colors = tuple(tuple(np.flatnonzero(own).tolist()) for own in reached)
        self.points, self.faces = points, faces
        self.surface = LabelledSurface(
            "example",
            NAMES[: len(domains)],
            np.column_stack([points, np.zeros(len(points))]),
            faces,
            colors,
            () if cracked is None else _cracks(points, faces, colors, cracked),
        )
        self.decomposition = decomposition_of(self.surface)
        self.graph = self.decomposition.instance
        self.cells = np.array(self.decomposition.vertex_cell)

    def best(self, space: str = "paper") -> Solution:
        """One of the best divisions of a search space."""
        strands = {"paper": 1, "surface": 2}[space]
        found = solve(self.graph, Options(space, strands, Deadline.after(10.0), workers=1))
        assert found.status == "optimal", found.status
        return found

    def cut_beside(self, color: int) -> Solution:
        """One of the best divisions in which a divided cell shows that color, the first listed."""
        found = self.best()
        for division in enumerate_schemes(self.graph, Options(), "dfs", found.segments):
            cut = [sub for cell in division for sub in cell.subcells if len(cell.subcells) > 1]
            if color in {sub.color for sub in cut}:
                return replace(found, cells=division)
        raise AssertionError(f"no best division cuts a cell beside {NAMES[color]}")

    def segments(self, division: Solution) -> NDArray[np.int64]:
        """The segment of each point in a division, as ``cellcolor show`` paints it."""
        drawn = draw_segments(self.surface, self.decomposition, division)
        assert drawn.mesh is not None
        return drawn.mesh.labels

    @cached_property
    def edges(self) -> dict[int, Array]:
        """Each topological edge as a smooth line (k, 2), its left cell on the left."""
        mesh = ClosedMesh(self.surface)

        def middle(*vertices: int) -> Array:
            return self.points[[v for v in vertices if v < mesh.real_count]].mean(axis=0)

        lines = {}
        for number, curve in self.decomposition.curves.items():
            u, v = curve[0]
            line = [middle(u, v, mesh.third[v, u])]
            for u, v in curve:
                line += [middle(u, v), middle(u, v, mesh.third[u, v])]
            lines[number] = self._smooth(np.array(line))
        return lines

    def _smooth(self, line: Array) -> Array:
        """The line with its jags worn down; its ends stay, and so does the rim of the surface."""
        closed = bool(np.allclose(line[0], line[-1]))
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        fixed = (np.isclose(line, low) | np.isclose(line, high)).any(axis=1)
        for _ in range(12):
            before, after = np.roll(line, 1, axis=0), np.roll(line, -1, axis=0)
            if closed:
                before[0], after[-1] = line[-2], line[1]
            else:
                fixed[[0, -1]] = True
            line = np.where(fixed[:, None], line, (before + 2 * line + after) / 4)
        return line

    def dart(self, name: int, inwards: float) -> Array:
        """A dart's line (k, 2), moved into its cell by that distance, without its ends."""
        line = self.edges[abs(name)][:: 1 if name > 0 else -1]
        along = np.gradient(line, axis=0)
        along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
        line = line + inwards * np.column_stack([-along[:, 1], along[:, 0]])
        lengths = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        margin = min(1.1 * inwards, lengths[-1] / 4)
        places = np.linspace(margin, lengths[-1] - margin, 40)
        return np.column_stack([np.interp(places, lengths, along) for along in line.T])

    def inside(self, cell: int) -> Array:
        """A place (2,) for a text: the point of a cell that is farthest from all others."""
        own, others = self.points[self.cells == cell], self.points[self.cells != cell]
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        rim = np.minimum(own - low, high - own).min(axis=1)
        if len(others):
            rim = np.minimum(rim, np.linalg.norm(own[:, None] - others, axis=2).min(axis=1))
        return own[rim.argmax()]


def _mesh(width: float, height: float, step: float) -> tuple[Array, NDArray[np.int64]]:
    """Points (n, 2) in rows, every other one moved by half a step, and triangles (m, 3)."""
    columns, rows = round(width / step) + 1, round(height / (step * 0.866)) + 1
    y, x = np.mgrid[0:rows, 0:columns].astype(float)
    inner = (x > 0) & (x < columns - 1)
    x = x + np.where(inner, 0.25 * np.where(y % 2 == 1, 1, -1), 0.0)
    points = np.column_stack([x.ravel() * step, y.ravel() * step * 0.866])
    at = np.arange(rows * columns).reshape(rows, columns)
    faces = []
    for row in range(rows - 1):
        a, b, c, d = at[row, :-1], at[row, 1:], at[row + 1, :-1], at[row + 1, 1:]
        pairs = [(a, b, d), (a, d, c)] if row % 2 else [(a, b, c), (b, d, c)]
        faces += [np.column_stack(corners) for corners in pairs]
    return points, np.concatenate(faces)


def _cracks(
    points: Array,
    faces: NDArray[np.int64],
    colors: tuple[tuple[int, ...], ...],
    cracked: Callable[[Array, Array], NDArray[np.bool_]],
) -> tuple[Crack, ...]:
    ends = np.unique(
        np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])), axis=0
    )
    chosen = ends[cracked(points[ends[:, 0]], points[ends[:, 1]])]
    shared = [(i, j, sorted(set(colors[i]) & set(colors[j]))) for i, j in chosen.tolist()]
    return tuple(Crack(i, j, tuple(own)) for i, j, own in shared if own)


def everywhere(x: Array, _: Array) -> NDArray[np.bool_]:
    """The domain of a color that is available at all points."""
    return np.ones(len(x), dtype=bool)


def overlap() -> Example:
    """Three colors that overlap; nothing reaches the corner on the upper right."""
    return Example(
        lambda x, y: (x < 2.4 + 0.25 * np.sin(2.2 * y)) & (x + y < 5.0),
        lambda x, y: (x > 1.3 + 0.2 * np.cos(2 * y)) & (x + y < 5.4),
        lambda x, y: np.hypot(x - 3.6, y - 0.3) < 0.75,
    )


def overlap_of_two() -> Example:
    """Two colors that overlap."""
    return Example(
        lambda x, y: x < 2.4 + 0.25 * np.sin(2.2 * y), lambda x, y: x > 1.3 + 0.2 * np.cos(2 * y)
    )


def split() -> Example:
    """A cell of two colors in the middle that both have to get through: it must be cut."""
    return Example(
        lambda x, y: ((x < 0.9) & (y > 1.3)) | ((x >= 0.9) & (x < 3.1)) | ((x >= 3.1) & (y > 1.3)),
        lambda x, y: (
            ((x < 0.9) & (y <= 1.3)) | ((x >= 0.9) & (x < 3.1)) | ((x >= 3.1) & (y <= 1.3))
        ),
    )


def flower() -> Example:
    """A round cell of four colors with eight cells of one color around it."""
    order = (RED, BLUE, RED, GREEN, BLUE, GREEN, YELLOW, BLUE)

    def domain(color: int) -> Callable[[Array, Array], Array]:
        def available(x: Array, y: Array) -> Array:
            radius, angle = np.hypot(x - 1.5, y - 1.5), np.arctan2(y - 1.5, x - 1.5)
            petal = np.floor((angle + np.pi) / (2 * np.pi) * 8).astype(int) % 8
            return (radius < 1.45) & ((radius < 0.75) | (np.array(order)[petal] == color))

        return available

    return Example(*[domain(color) for color in range(4)], size=(3.0, 3.0), step=0.075)


def corridors() -> Example:
    """Two cells side by side that a red and a blue corridor both have to pass."""

    def ends(x: Array) -> Array:
        return (x < 0.8) | (x > 3.2)

    return Example(
        lambda x, y: ~ends(x) | (y > 1.3),
        lambda x, y: ~ends(x) | (y <= 1.3),
        lambda x, _: (x >= 0.8) & (x < 2.0),
    )


def ring() -> Example:
    """A ring of two colors; inside it and around it parts that have one of them only."""

    def domain(color: int) -> Callable[[Array, Array], Array]:
        def available(x: Array, y: Array) -> Array:
            radius = np.hypot(x - 1.5, y - 1.5)
            outside = (x > 1.5) == (y > 1.5)
            alone = np.where(radius < 0.5, x > 1.5, outside)
            return ((radius >= 0.5) & (radius < 1.2)) | (alone == (color == RED))

        return available

    return Example(domain(RED), domain(BLUE), size=(3.0, 3.0), step=0.075)
