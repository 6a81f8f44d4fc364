"""Places on a surface that a question is about: a box in the world, or a mask of vertices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Mask
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError
from cellcolor.files.documents import read_document


@dataclass(frozen=True, slots=True)
class WorldBox:
    """All between two corners, along the axes of the world, m.

    Raises:
        InputError: a coordinate is no number, or the box is empty.
    """

    lowest: tuple[float, float, float]
    highest: tuple[float, float, float]

    def __post_init__(self) -> None:
        corners = np.array([self.lowest, self.highest], dtype=float)
        if corners.shape != (2, 3) or not np.isfinite(corners).all():
            raise InputError(None, None, "a box needs two corners of three coordinates each, m")
        if (corners[0] > corners[1]).any():
            raise InputError(None, None, "the box is empty: its first corner is the lowest one")


Place = WorldBox | LabelledSurface | Sequence[bool] | Mask
"""A box; one truth value for each vertex; or a labelled surface on the same mesh or a refinement of
it, for the vertices that it gives up."""


def chosen(surface: LabelledSurface, place: Place, field: str) -> Mask:
    """The vertices (n,) of a surface in a place.

    Args:
        field: what the place was given as.

    Raises:
        InputError: a mask has another number of vertices, or is none of truth values; a surface is
            on another mesh; no vertex is in a box.
    """
    if isinstance(place, LabelledSurface):
        return _given_up(surface, place, field)
    if isinstance(place, WorldBox):
        inside = (surface.vertices >= place.lowest) & (surface.vertices <= place.highest)
        found = np.asarray(inside.all(axis=1))
        if not found.any():
            low, high = (
                ", ".join(f"{x:.4g}" for x in corner)
                for corner in (surface.vertices.min(axis=0), surface.vertices.max(axis=0))
            )
            message = f"no vertex is in the box; the surface is from ({low}) to ({high}) m"
            raise InputError(None, field, message)
        return found
    mask = np.asarray(place)
    if mask.dtype != np.bool_ or mask.ndim != 1:
        raise InputError(None, field, "must be a box, or true or false for each vertex")
    if len(mask) != len(surface.vertices):
        message = (
            f"is a mask of {len(mask)} vertices, and the surface has {len(surface.vertices)}: "
            "is it of another mesh?"
        )
        raise InputError(None, field, message)
    return mask


def _given_up(surface: LabelledSurface, other: LabelledSurface, field: str) -> Mask:
    """What another surface gives up; where it was refined, its first vertices are the old ones."""
    own = len(surface.vertices)
    if not np.array_equal(other.vertices[:own], surface.vertices):
        raise InputError(None, field, f"the surface {other.name!r} is on another mesh")
    mask = np.zeros(len(other.vertices), dtype=bool)
    mask[list(other.given_up)] = True
    return mask[:own]


def read_place(text: str, field: str) -> Place:
    """A place as a command is given it: six coordinates of a box, or a file.

    Args:
        text: ``x,y,z,x,y,z`` of the lowest and the highest corner in m, or the name of a JSON file
            whose member ``mask`` has ``true`` or ``false`` for each vertex, or of a labelled
            surface.
        field: what the place is given as.

    Raises:
        InputError: it is neither; names the option or the file.
    """
    words = text.split(",")
    if len(words) == 6:
        try:
            x, y, z, a, b, c = map(float, words)
            return WorldBox((x, y, z), (a, b, c))
        except ValueError as error:
            raise InputError(None, field, "a box is six numbers: x,y,z,x,y,z") from error
        except InputError as error:
            raise InputError(None, field, error.message) from error
    document = read_document(text)
    if document.get("format") == LabelledSurface.FORMAT:
        return LabelledSurface.read(text)
    content = document.get("mask")
    if not isinstance(content, list) or not all(isinstance(one, bool) for one in content):
        raise InputError(text, "mask", "must be a list of true or false for each vertex")
    return content
