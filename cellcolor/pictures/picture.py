"""What a picture consists of, before any library draws it, and what it is painted with.

What a thing is filled or drawn with is called its ``rgb``: a color is a class of configurations
here (docs/semantics.md, section 1). Paints are told apart also by readers with color-vision
deficiencies. A posture (a color of the surface) has one paint in every picture of a scene: its
place in the scene's list of colors decides which. If there are more postures than paints, paints
repeat, so every picture also has numbers or names.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index

PAINTS = (
    "#77AADD",
    "#EE8866",
    "#EEDD88",
    "#44BB99",
    "#FFAABB",
    "#99DDFF",
    "#AAAA00",
    "#BBCC33",
    "#B59BD6",
    "#C9A27A",
    "#7FB7BE",
    "#E3A6DE",
    "#F2B872",
    "#93A8C6",
    "#D9909E",
    "#A8D5A2",
)
"""For postures: light enough for black text. The first eight are the colors of "light" in Paul Tol,
Colour Schemes, 2021, without its grey; the others are as light."""

LINES = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#000000")
"""For curves of plots and small pieces (Okabe and Ito, Color Universal Design, 2008)."""

REASONS = (
    "#CC6677",
    "#332288",
    "#DDCC77",
    "#117733",
    "#88CCEE",
    "#882255",
    "#44AA99",
    "#999933",
    "#AA4499",
    "#661100",
    "#777777",
)
"""For the reasons why points are out of reach. These are the colors of Paul Tol's "muted", one of
his browns, and a grey."""

FAINT = "#DDDDDD"
"""The lighter grey, for unreachable points and for what is in the background."""
GREY = "#AAAAAA"
"""The darker grey, for points that were given up."""
INK = "#222222"
"""Nearly black, for borders and text."""
WARNING = "#CC3311"
"""Red, for cracks, faults and what is picked out."""


def paints_of(colors: Sequence[str]) -> dict[str, str]:
    """The paint of each color of a surface or instance, by its name, like ``#77AADD``."""
    return {name: PAINTS[number % len(PAINTS)] for number, name in enumerate(colors)}


def mixed(paints: Iterable[str]) -> str:
    """The mean of paints, for what can be in any of them, paler the more they are."""
    parts = [[int(paint[at : at + 2], 16) for at in (1, 3, 5)] for paint in paints] or [[255] * 3]
    mean = np.mean(parts, axis=0)
    pale = mean + (255 - mean) * 0.5 * (1 - 1 / len(parts))
    return "#" + "".join(f"{round(part):02X}" for part in pale)


@dataclass(frozen=True)
class VertexClass:
    """A class of vertices: its name for the legend, its fill, and a number to write on it."""

    name: str
    rgb: str
    number: str | None = None


class Line(IntEnum):
    """What runs over a mesh between two vertices that an edge joins."""

    NONE = 0
    BORDER = 1
    CRACK = 2
    MARKED = 3

    @property
    def text(self) -> str:
        """What the legend says."""
        return ("", "border", "crack", "border of a marked segment")[self]

    @property
    def rgb(self) -> str:
        """``#RRGGBB``."""
        return ("", INK, WARNING, "#AA0077")[self]


@dataclass(frozen=True)
class ClassedMesh:
    """A mesh with a class for each vertex, which fills the vertex's barycentric dual.

    Attributes:
        points: (n, 3) in m.
        faces: (m, 3) int64 rows of ``points``, counter-clockwise seen from outside.
        labels: (n,) the class of each vertex, an index of ``classes``.
        classes: those without a vertex are left out of the legend.
        lines: (m, 3) uint8 :class:`Line`; number k is between the corners k and k + 1 of a face.
    """

    points: Array
    faces: Index
    labels: Index
    classes: Sequence[VertexClass]
    lines: NDArray[np.uint8]

    @property
    def legend(self) -> list[tuple[str, str, Line]]:
        """Name and fill of the classes that there are, then of the kinds of lines."""
        used = [self.classes[number] for number in np.unique(self.labels)]
        kinds = [Line(kind) for kind in np.unique(self.lines) if kind]
        return [
            *((own.name, own.rgb, Line.NONE) for own in used),
            *((kind.text, kind.rgb, kind) for kind in kinds),
        ]


@dataclass(frozen=True)
class Layer:
    """Triangles with one fill, one entry of the legend.

    Attributes:
        name: what the legend says.
        rgb: ``#RRGGBB``.
        points: (n, 3) in m.
        triangles: (m, 3) int64 rows of ``points``, counter-clockwise seen from outside.
    """

    name: str
    rgb: str
    points: Array
    triangles: NDArray[np.int64]


@dataclass(frozen=True)
class SpaceLines:
    """Straight pieces of one kind of line in space: (k, 2, 3) in m."""

    name: str
    rgb: str
    ends: Array


@dataclass(frozen=True)
class Text:
    """A short text on a surface, at a place (3,) with an outward unit normal (3,).

    Attributes:
        label: the class whose number it is; None for a mark that points at this place.
    """

    text: str
    at: Array
    outward: Array
    label: int | None = None


@dataclass(frozen=True)
class Picture3D:
    """A scene in space, axes in meters.

    Attributes:
        title: one line.
        mesh: the surface with classes, if there is one.
        layers: solids.
        lines: edges of a part, the ground.
        texts: numbers on the surface, and marks.
        notes: lines under the legend.
        towards: (3,) unit vector from the scene to the eye.
    """

    title: str
    mesh: ClassedMesh | None
    layers: tuple[Layer, ...]
    lines: tuple[SpaceLines, ...]
    texts: tuple[Text, ...]
    notes: tuple[str, ...]
    towards: Array

    @property
    def legend(self) -> list[tuple[str, str]]:
        """Name and fill of each thing that is drawn."""
        things = [(layer.name, layer.rgb) for layer in self.layers]
        things += [(line.name, line.rgb) for line in self.lines]
        return things if self.mesh is None else [one[:2] for one in self.mesh.legend] + things


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

    @property
    def legend(self) -> list[tuple[str, str]]:
        """Name and color of each kind of line."""
        return list({line.name: (line.name, line.rgb) for line in self.lines}.values())
