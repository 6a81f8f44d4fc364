"""A grid of boxes as an obstacle: the occupied cells of a map, for example from a scanner."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.files.documents import read_text
from cellcolor.frontend.arm.polyhedron import one_of_each_part
from cellcolor.frontend.contact.fcl_bodies import mesh_model
from cellcolor.frontend.contact.obstacle import Obstacle
from cellcolor.frontend.contact.solids import Solid
from cellcolor.frontend.parts.surface import Faces
from cellcolor.frontend.tables import Length

_FARTHEST = 1_000_000  # a cell's number may be at most so far from 0
_MOST_SIDES = 375_000  # with two triangles each; as many as a mesh of 250,000 vertices has at most
_NEIGHBORS = 8  # nearest cells that are looked at for each point
_SIDES = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])


class BoxGridObstacle(Obstacle):
    """Solid cubes of one size in a grid; the corner of the cell 0,0,0 is on the position.

    Attributes:
        file: a text with the three numbers of an occupied cell on each line, ``i,j,k``; that cell
            reaches from (i, j, k) to (i + 1, j + 1, k + 1) times the size of a cell.
        cell_m: the size of a cell, m.
    """

    kind: Literal["box-grid"] = "box-grid"
    file: str
    cell_m: Length

    def cells(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Index:
        """The occupied cells (k, 3), each once, in lexicographic order.

        Raises:
            InputError: the file cannot be read, a line has not three whole numbers, a number is
                too far from 0, or there is none; names the line.
            OutOfTime: the deadline came first.
        """
        path = folder / self.file
        rows = []
        for number, line in deadline.watch(enumerate(read_text(path).splitlines(), start=1)):
            if not line.strip():
                continue
            try:
                i, j, k = (int(word) for word in line.split(","))
            except ValueError as error:
                message = "needs the three whole numbers of a cell, i,j,k"
                raise InputError(str(path), f"line {number}", message) from error
            if max(map(abs, (i, j, k))) > _FARTHEST:
                message = f"a cell's numbers are within {_FARTHEST:,} of 0"
                raise InputError(str(path), f"line {number}", message)
            rows.append((i, j, k))
        if not rows:
            raise InputError(str(path), None, "has no cell")
        return np.unique(np.array(rows, dtype=np.int64), axis=0)

    def shell(self, folder: Path = Path(), deadline: Deadline = NEVER) -> tuple[Array, Faces]:
        """The sides of cells that have no cell beyond them, each as two triangles."""
        cells = self.cells(folder, deadline)
        outer = _outer_sides(cells)
        if outer.sum() > _MOST_SIDES:
            message = (
                f"the cells have {outer.sum():,} sides to the outside, at most {_MOST_SIDES:,} fit:"
                " take larger cells"
            )
            raise InputError(str(folder / self.file), None, message)
        corners = np.concatenate(
            [_side(cells[outer[:, side]], normal) for side, normal in enumerate(_SIDES)]
        )
        places, number = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
        a, b, c, d = number.reshape(-1, 4).T
        faces = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
        return places * self.cell_m, faces.astype(np.int64)

    def solid(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Solid:
        """The filled cells."""
        vertices, faces = self.shell(folder, deadline)
        middles = (self.cells(folder, deadline) + 0.5) * self.cell_m
        tree, half = cKDTree(middles), self.cell_m / 2
        nearest = min(_NEIGHBORS, len(middles))

        def distances(points: Array) -> tuple[Array, Array]:
            """A cube lies between the balls about its middle through sides and corners."""
            to_middle, _ = tree.query(points)
            return np.maximum(to_middle - np.sqrt(3) * half, 0.0), np.maximum(to_middle - half, 0.0)

        def near(points: Array, reach: float) -> tuple[Array, Array]:  # noqa: ARG001
            """A cell that is not among the nearest has a middle at least as far as theirs."""
            to_middle, cell = tree.query(points, k=[*range(1, nearest + 1)])
            beyond = np.maximum(np.abs(points[:, None] - middles[cell]) - half, 0.0)
            to_cell = np.linalg.norm(beyond, axis=2).min(axis=1)
            if nearest == len(middles):
                return to_cell, to_cell
            others = np.maximum(to_middle[:, -1] - np.sqrt(3) * half, 0.0)
            return np.minimum(to_cell, others), to_cell

        extent = sorted(np.ptp(vertices, axis=0).tolist())
        parts = one_of_each_part(vertices, faces)
        solid = Solid(mesh_model(vertices, faces), extent[1], distances, near, parts)
        return solid.placed(self)


def _outer_sides(cells: Index) -> Mask:
    """Which of the six sides of cells (k, 3) have no cell beyond them, (k, 6)."""
    low = cells.min(axis=0) - 1
    size = cells.max(axis=0) - low + 2
    key = np.array([size[1] * size[2], size[2], 1])
    own = (cells - low) @ key
    beyond = own[:, None] + _SIDES @ key
    return np.asarray(np.isin(beyond, own, invert=True))


def _side(cells: Index, normal: Index) -> Index:
    """Corners (k, 4, 3) of one side of cells (k, 3), counter-clockwise as seen from outside."""
    axis = int(np.argmax(np.abs(normal)))
    u, v = np.eye(3, dtype=np.int64)[[(axis + 1) % 3, (axis + 2) % 3]]
    first = np.eye(3, dtype=np.int64)[axis] * (normal[axis] > 0)
    corners = np.array([first, first + u, first + u + v, first + v])
    return np.asarray(cells[:, None] + (corners if normal[axis] > 0 else corners[::-1]))
