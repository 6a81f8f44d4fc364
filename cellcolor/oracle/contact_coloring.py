"""The plan that a tool path makes of a surface, and how many stretches of the path it needs.

What holds of these numbers is proved in docs/semantics.md, section 9.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.vertex_contacts import VertexContacts


@dataclass(frozen=True)
class ContactColoring:
    """What a path's contacts make of a surface.

    Attributes:
        plan: each vertex in the color of its first contact, None without any.
        color_changes: how often the color changes in contact: between one contact and the next of
            the same stroke.
        runs: into how many stretches the contacts fall that are in the color of ``plan``, if they
            are cut wherever the stroke ends, the color changes, or the path does not stay at its
            vertex or go on to a neighbor along an uncracked edge.
    """

    plan: Plan
    color_changes: int
    runs: int


def coloring_of(surface: LabelledSurface, contacts: VertexContacts) -> ContactColoring:
    """The coloring that the first contacts make, and the path's stretches in it."""
    stroke, vertex, color = contacts.stroke, contacts.vertex, contacts.color
    touched, first = np.unique(vertex, return_index=True)
    own = np.full(len(surface.vertices), -1, dtype=np.int64)
    own[touched] = color[first]
    together = stroke[1:] == stroke[:-1]
    changes = int((together & (color[1:] != color[:-1])).sum())
    kept = np.flatnonzero(color == own[vertex])
    joined = 0
    for one, other in zip(kept[:-1].tolist(), kept[1:].tolist(), strict=True):
        if stroke[one] == stroke[other] and color[one] == color[other]:
            joined += _adjoin(surface, int(vertex[one]), int(vertex[other]), int(color[one]))
    plan = Plan(tuple([None if number < 0 else number for number in own.tolist()]))
    return ContactColoring(plan, changes, len(kept) - joined)


def _adjoin(surface: LabelledSurface, a: int, b: int, color: int) -> bool:
    """Whether two vertices are one, or have an edge along which a color is continuous."""
    if a == b:
        return True
    edge = (a, b) in surface.left_of or (b, a) in surface.left_of
    return edge and color not in surface.cracked(a, b)
