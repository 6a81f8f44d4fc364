"""Places on a surface that a question is about: a box in the world, or a mask of vertices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cellcolor.arrays import Mask
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError
from cellcolor.files.documents import read_document

__all__ = ["Place", "WorldBox", "chosen", "left_alone", "read_place", "read_weights"]


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


Place = WorldBox | Sequence[bool] | Mask
"""A box, or one truth value for each vertex."""


def chosen(surface: LabelledSurface, place: Place, field: str) -> Mask:
    """The vertices (n,) of a surface in a place.

    Args:
        field: what the place was given as.

    Raises:
        InputError: a mask has another number of vertices, or is none of truth values.
    """
    if isinstance(place, WorldBox):
        inside = (surface.vertices >= place.lowest) & (surface.vertices <= place.highest)
        return np.asarray(inside.all(axis=1))
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


def left_alone(surface: LabelledSurface, mask: Mask) -> LabelledSurface:
    """The surface without colors at some vertices (n,): nothing there is asked about."""
    out = np.flatnonzero(mask).tolist()
    colors = list(surface.vertex_colors)
    given_up = {*surface.given_up, *(vertex for vertex in out if colors[vertex])}
    for vertex in out:
        colors[vertex] = ()
    cracks = tuple(crack for crack in surface.cracks if not (mask[crack.i] or mask[crack.j]))
    return replace(
        surface, vertex_colors=tuple(colors), given_up=tuple(sorted(given_up)), cracks=cracks
    )


def read_place(text: str, field: str) -> Place:
    """A place as a command is given it: six coordinates of a box, or the file of a mask.

    Args:
        text: ``x,y,z,x,y,z`` of the lowest and the highest corner in m, or the name of a JSON file
            whose member ``mask`` has ``true`` or ``false`` for each vertex.
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
    content = _list_of(text, "mask")
    if not all(isinstance(one, bool) for one in content):
        raise InputError(text, "mask", "must be true or false for each vertex")
    return content


def read_weights(file: str) -> list[float]:
    """What each vertex weighs, from a JSON file whose member ``weights`` is a list of numbers.

    Raises:
        InputError: it is something else; names the file.
    """
    content = _list_of(file, "weights")
    for place, one in enumerate(content):
        if isinstance(one, bool) or not isinstance(one, (int, float)):
            raise InputError(file, f"weights[{place}]", "must be a number")
    return content


def _list_of(file: str, member: str) -> list[Any]:
    content = read_document(file).get(member)
    if not isinstance(content, list):
        raise InputError(file, member, "must be a list with an entry for each vertex")
    return content
