"""A mesh file as an obstacle."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.contact.obstacle import Obstacle
from cellcolor.frontend.parts.mesh_file import load_mesh
from cellcolor.frontend.parts.surface import Faces
from cellcolor.frontend.tables import Positive

__all__ = ["MeshObstacle"]


class MeshObstacle(Obstacle):
    """A mesh file as a shell, its origin on the position."""

    kind: Literal["mesh"] = "mesh"
    file: str
    meters_per_unit: Positive

    def shell(self, folder: Path = Path(), deadline: Deadline = NEVER) -> tuple[Array, Faces]:
        """The file's mesh."""
        mesh = load_mesh(folder / self.file, self.meters_per_unit, deadline=deadline)
        return mesh.vertices, mesh.faces
