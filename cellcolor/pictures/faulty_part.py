"""A picture of a part on which its faults are marked."""

from __future__ import annotations

import textwrap

import numpy as np

from cellcolor.frontend.parts.inspection import Inspection
from cellcolor.pictures.palette import FAINT
from cellcolor.pictures.picture import Layer, Picture3D, SpaceLines

_MOST = 60_000  # faces drawn; a larger part is thinned evenly to this many
_MOST_MARKS = 20_000  # of one kind of fault
_FILLS = ("#EE6677", "#AA3377", "#4477AA", "#228833", "#CCBB44")  # of faulty faces
_LINES = ("#D55E00", "#CC0000", "#555555")  # holes, edges with more than two faces, sharp ones
_WIDTH = 60  # characters a line of a note, all that fits beside the picture


def faulty_part(inspection: Inspection) -> Picture3D:
    """The part, its sharp edges, and each kind of fault in a color of its own."""
    faces, notes = inspection.mesh.corners, []
    if len(faces) > _MOST:
        notes.append(f"{_MOST:,} of {len(faces):,} faces are drawn.")
        faces = faces[np.linspace(0, len(faces) - 1, _MOST).astype(np.int64)]
    used, number = np.unique(faces, return_inverse=True)
    corners_of = number.reshape(-1, 3).astype(np.int64)
    layers = [Layer("part", FAINT, inspection.mesh.points[used], corners_of)]
    for (name, corners), fill in zip(inspection.faulty_faces.items(), _FILLS, strict=True):
        if len(corners):
            some = corners[:_MOST_MARKS]
            own = np.arange(3 * len(some)).reshape(-1, 3)
            layers.append(Layer(f"{name}: {len(corners):,}", fill, some.reshape(-1, 3), own))
    lines = []
    for (name, ends), fill in zip(inspection.faulty_edges.items(), _LINES, strict=True):
        if len(ends):
            lines.append(SpaceLines(f"{name}: {len(ends):,} edges", fill, ends[:_MOST_MARKS]))
    usable = inspection.refusal is None
    text = "Usable unchanged." if usable else f"Not usable unchanged: {inspection.refusal}"
    notes += textwrap.wrap(text, _WIDTH)
    eye = np.array([1.0, -1.6, 1.1])
    return Picture3D(
        title=inspection.name if usable else f"{inspection.name}: what is wrong with it",
        mesh=None,
        layers=tuple(layers),
        lines=tuple(lines),
        texts=(),
        notes=tuple(notes),
        towards=eye / np.linalg.norm(eye),
    )
