"""Obstacles: the kinds of ``[[obstacle]]`` in a scene."""

from __future__ import annotations

from abc import abstractmethod
from pathlib import Path
from typing import Literal

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.contact.solids import Solid, mesh_solid
from cellcolor.frontend.parts.mesh_file import load_mesh
from cellcolor.frontend.parts.placement import Placement
from cellcolor.frontend.parts.surface import Faces
from cellcolor.frontend.registry import Registry
from cellcolor.frontend.tables import Positive


class Obstacle(Placement):
    """A thing that neither the arm nor the tool may touch, and its place.

    A kind that files can name has a key ``kind`` with its name, and is registered in ``OBSTACLES``
    or by an entry point of the group ``cellcolor.obstacles``.
    """

    @abstractmethod
    def shell(self, folder: Path = Path(), deadline: Deadline = NEVER) -> tuple[Array, Faces]:
        """The obstacle's outside in its own frame: vertices (n, 3) in m and faces (m, 3).

        Pictures show it, and the arm is tested against it, unless :meth:`solid` says otherwise.

        Args:
            folder: what the names of files in the table are relative to.
            deadline: when to give up.

        Raises:
            InputError: there is no such obstacle.
            OutOfTime: the deadline came first.
        """

    def solid(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Solid:
        """What the arm is tested against, in the world; arguments and errors as for the shell."""
        vertices, faces = self.shell(folder, deadline)
        return mesh_solid(vertices, faces, deadline).placed(self)


OBSTACLES: Registry[Obstacle] = Registry(
    "cellcolor.obstacles",
    Obstacle,  # type: ignore[type-abstract]
    {
        "box": "cellcolor.frontend.contact.primitives:BoxObstacle",
        "cylinder": "cellcolor.frontend.contact.primitives:CylinderObstacle",
        "sphere": "cellcolor.frontend.contact.primitives:SphereObstacle",
        "cone": "cellcolor.frontend.contact.primitives:ConeObstacle",
        "capsule": "cellcolor.frontend.contact.primitives:CapsuleObstacle",
        "half-space": "cellcolor.frontend.contact.half_space:HalfSpaceObstacle",
        "box-grid": "cellcolor.frontend.contact.box_grid:BoxGridObstacle",
        "mesh": "cellcolor.frontend.contact.obstacle:MeshObstacle",
    },
)


class MeshObstacle(Obstacle):
    """A mesh file as a shell, its origin on the position."""

    kind: Literal["mesh"] = "mesh"
    file: str
    meters_per_unit: Positive

    def shell(self, folder: Path = Path(), deadline: Deadline = NEVER) -> tuple[Array, Faces]:
        """The file's mesh."""
        mesh = load_mesh(folder / self.file, self.meters_per_unit, deadline=deadline)
        return mesh.vertices, mesh.faces
