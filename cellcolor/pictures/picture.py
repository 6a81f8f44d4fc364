"""What a picture consists of, before any library draws it.

What a thing is filled or drawn with is called its ``rgb``: a color is a class of configurations
here (docs/semantics.md, section 1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array


@dataclass(frozen=True)
class Layer:
    """Triangles with one fill, one entry of the legend.

    Attributes:
        name: what the legend says.
        rgb: ``#RRGGBB``.
        points: (n, 3) in m.
        triangles: (m, 3) int64 rows of ``points``, counter-clockwise seen from outside.
        solid: shade it by its direction to the light; what is flat keeps the fill of the legend.
    """

    name: str
    rgb: str
    points: Array
    triangles: NDArray[np.int64]
    solid: bool = False


@dataclass(frozen=True)
class SpaceLines:
    """Straight pieces of one kind of line in space: (k, 2, 3) in m."""

    name: str
    rgb: str
    ends: Array


@dataclass(frozen=True)
class Text:
    """A short text on a surface, at a place (3,) with an outward unit normal (3,)."""

    text: str
    at: Array
    outward: Array


@dataclass(frozen=True)
class Picture3D:
    """A scene in space, axes in meters.

    Attributes:
        title: one line.
        layers: classes of vertices, and solids.
        lines: borders, cracks, the ground.
        texts: numbers on the surface.
        notes: lines under the legend.
        towards: (3,) unit vector from the scene to the eye.
    """

    title: str
    layers: tuple[Layer, ...]
    lines: tuple[SpaceLines, ...]
    texts: tuple[Text, ...]
    notes: tuple[str, ...]
    towards: Array


@dataclass(frozen=True)
class PlaneLine:
    """A line in the plane: points (k, 2), width in points; ``name`` groups legend entries."""

    name: str
    rgb: str
    points: Array
    width: float
    dashed: bool = False


@dataclass(frozen=True)
class Outline:
    """A filled outline in the plane: points (k, 2)."""

    rgb: str
    points: Array


@dataclass(frozen=True)
class Picture2D:
    """A drawing without units.

    Attributes:
        title: one line.
        lines: drawn first; one legend entry for each name, in this order.
        outlines: drawn over the lines.
        texts: (text, (2,) place, size in points), drawn last.
        notes: lines under the legend.
    """

    title: str
    lines: tuple[PlaneLine, ...]
    outlines: tuple[Outline, ...]
    texts: tuple[tuple[str, Array, float], ...]
    notes: tuple[str, ...]
