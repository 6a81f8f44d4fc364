"""Obstacles: the kinds of ``[[obstacle]]`` in a scene."""

from __future__ import annotations

from abc import abstractmethod
from pathlib import Path
from typing import Literal

import numpy as np
import trimesh

from cellcolor.arrays import Array, Index
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.files.documents import read_text
from cellcolor.frontend.arm.body import Kind, Shape
from cellcolor.frontend.parts.mesh_file import MeshObject
from cellcolor.frontend.parts.placement import Placement
from cellcolor.frontend.parts.shapes import grid_mesh
from cellcolor.frontend.parts.surface import Faces
from cellcolor.frontend.tables import Length, Positive, Registry

Shell = tuple[Array, Faces]
"""Vertices (n, 3) in m and faces (m, 3)."""


class Obstacle(Placement):
    """A thing that neither the arm nor the tool may touch, and its place.

    A kind that files can name has a key ``kind`` with its name, and is registered in ``OBSTACLES``
    or by an entry point of the group ``cellcolor.obstacles``.
    """

    @abstractmethod
    def shell(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Shell:
        """The obstacle's outside in its own frame.

        Pictures show it, and the arm is tested against it, unless ``solid`` says otherwise.

        Args:
            folder: what the names of files in the table are relative to.

        Raises:
            InputError: there is no such obstacle.
        """

    def solid(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Shape:
        """What the arm is tested against, in the world; arguments and errors as for the shell."""
        vertices, faces = self.shell(folder, deadline)
        return self.standing(Shape("mesh", vertices=vertices, faces=faces))


class MeshObstacle(Obstacle):
    """A mesh file as a shell, its origin on the position."""

    kind: Literal["mesh"] = "mesh"
    file: str
    meters_per_unit: Positive

    def shell(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Shell:
        part = MeshObject(file=self.file, meters_per_unit=self.meters_per_unit)
        mesh = part.surface(folder, deadline)
        return mesh.vertices, mesh.faces


class Primitive(Obstacle):
    """A filled shape that is centered on its position; its own keys are its sizes, in m.

    See :class:`~cellcolor.frontend.arm.body.Shape`.
    """

    kind: Kind

    @property
    def _sizes(self) -> tuple[float, ...]:
        own = [name for name in type(self).model_fields if name not in Primitive.model_fields]
        return tuple(np.ravel([getattr(self, name) for name in own]).tolist())

    def shell(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Shell:  # noqa: ARG002
        """The shape with its curved faces as many flat ones."""
        radius, *length = self._sizes
        vertices, faces = Shape(self.kind, self._sizes).shell()
        if len(length) == 1:  # pictures sort triangles by depth, which goes wrong with long ones
            longest = max(length[0] / 4, radius)
            vertices, faces = trimesh.remesh.subdivide_to_size(vertices, faces, longest)
        return vertices, faces

    def solid(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Shape:  # noqa: ARG002
        return self.standing(Shape(self.kind, self._sizes))


class BoxObstacle(Primitive):
    """A solid box, centered on its position."""

    kind: Literal["box"] = "box"
    size_m: tuple[Length, Length, Length]


class CylinderObstacle(Primitive):
    """A solid cylinder about its own z axis, centered on its position."""

    kind: Literal["cylinder"] = "cylinder"
    radius_m: Length
    height_m: Length


class SphereObstacle(Primitive):
    """A solid sphere, centered on its position."""

    kind: Literal["sphere"] = "sphere"
    radius_m: Length


class CapsuleObstacle(Primitive):
    """All points within a radius of a piece of its own z axis, centered on the position."""

    kind: Literal["capsule"] = "capsule"
    radius_m: Length
    axis_m: Length


class ConeObstacle(Primitive):
    """A solid cone about its own z axis, its point up; the middle of its height on the position."""

    kind: Literal["cone"] = "cone"
    radius_m: Length
    height_m: Length


_DRAWN, _VERTICES = 2.0, 441  # side of the square that is drawn, m, in squares of 0.1 m


class HalfSpaceObstacle(Obstacle):
    """Everything below its own plane z = 0, without end."""

    kind: Literal["half-space"] = "half-space"

    def shell(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Shell:  # noqa: ARG002
        """What pictures show: a square of the plane, 2 m wide, about the position."""
        flat, faces = grid_mesh(_DRAWN, _DRAWN, _VERTICES, 0.0, 0)
        return np.column_stack([flat - _DRAWN / 2, np.zeros(len(flat))]), faces

    def solid(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Shape:  # noqa: ARG002
        return self.standing(Shape("half-space"))


_FARTHEST = 30_000  # a cell's number may be at most so far from 0; an octree has 2^15
_MOST_SIDES = 375_000  # with two triangles each; as many as a mesh of 250,000 vertices has at most


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

    def shell(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Shell:
        """The sides of cells that have no cell beyond them, each as two triangles."""
        cells = self.cells(folder, deadline)
        cube = trimesh.creation.box(bounds=[(0, 0, 0), (1, 1, 1)])
        low = cells.min(axis=0) - 1
        size = cells.max(axis=0) - low + 2
        key = np.array([size[1] * size[2], size[2], 1])
        own = (cells - low) @ key
        beyond = own[:, None] + cube.face_normals.round().astype(np.int64) @ key
        cell, face = np.nonzero(np.isin(beyond, own, invert=True))
        if len(cell) > 2 * _MOST_SIDES:
            message = (
                f"the cells have {len(cell) // 2:,} sides to the outside, at most {_MOST_SIDES:,} "
                "fit: take larger cells"
            )
            raise InputError(str(folder / self.file), None, message)
        corners = cells[cell][:, None] + cube.vertices[cube.faces[face]].astype(np.int64)
        places, number = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
        return places * self.cell_m, number.reshape(-1, 3)

    def solid(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Shape:
        corners = np.asarray(self.cells(folder, deadline) * self.cell_m, dtype=np.float64)
        return self.standing(Shape("cells", (self.cell_m,), vertices=corners))


OBSTACLES: Registry[Obstacle] = Registry(
    "cellcolor.obstacles",
    Obstacle,  # type: ignore[type-abstract]
    {
        "box": "cellcolor.frontend.contact.obstacle:BoxObstacle",
        "cylinder": "cellcolor.frontend.contact.obstacle:CylinderObstacle",
        "sphere": "cellcolor.frontend.contact.obstacle:SphereObstacle",
        "cone": "cellcolor.frontend.contact.obstacle:ConeObstacle",
        "capsule": "cellcolor.frontend.contact.obstacle:CapsuleObstacle",
        "half-space": "cellcolor.frontend.contact.obstacle:HalfSpaceObstacle",
        "box-grid": "cellcolor.frontend.contact.obstacle:BoxGridObstacle",
        "mesh": "cellcolor.frontend.contact.obstacle:MeshObstacle",
    },
)
