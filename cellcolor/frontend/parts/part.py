"""Parts that can be covered: the kinds of ``[object]`` in a scene."""

from __future__ import annotations

from abc import abstractmethod
from pathlib import Path

from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.tables import Registry, Table


class Part(Table):
    """An object in its own frame: the keys of its table, and the surface that they describe.

    A kind that files can name has a key ``kind`` with its name, and is registered in ``PARTS`` or
    by an entry point of the group ``cellcolor.parts``.
    """

    @abstractmethod
    def surface(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Surface:
        """The part's surface in its own frame.

        Args:
            folder: what the names of files in the table are relative to.

        Raises:
            InputError: there is no such surface.
        """


PARTS: Registry[Part] = Registry(
    "cellcolor.parts",
    Part,  # type: ignore[type-abstract]
    {
        "spherical-cap": "cellcolor.frontend.parts.shapes:CapObject",
        "pipe": "cellcolor.frontend.parts.shapes:PipeObject",
        "rectangle": "cellcolor.frontend.parts.shapes:RectangleObject",
        "mesh": "cellcolor.frontend.parts.mesh_file:MeshObject",
    },
)
