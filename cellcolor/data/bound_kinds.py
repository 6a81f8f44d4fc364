"""The kinds of bounds by name, and what their certificates hold and show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from pydantic import NonNegativeInt

from cellcolor.data.bounds import (
    EVERY_CELL,
    Bound,
    BoundKind,
    Certificate,
    Connection,
    Mark,
    Shown,
    marks_of,
)
from cellcolor.data.instance import Instance
from cellcolor.data.value import Value
from cellcolor.data.wording import count, listed


@dataclass(frozen=True, slots=True)
class CertifiedCells(Certificate):
    """Cells that fewer color regions than the bound says do not touch."""

    cells: tuple[int, ...]

    def shown(self, value: int, instance: Instance) -> Shown:
        """The cells."""
        cells = sorted(set(self.cells))
        notes: tuple[str, ...] = (
            f"No {count(value - 1, 'color region')} touch all of these cells.",
        )
        if len(cells) == value:
            notes = (
                "No two of these cells can share a segment:",
                "no color leads from one to another.",
            )
        return Shown(marks_of(instance, cells), (), notes)

    def witness(self, value: int) -> tuple[int, ...]:
        """The cells if there are as many: then no color region touches two of them."""
        return self.cells if len(self.cells) == value else ()


STRANGERS = BoundKind(
    "that many cells cannot share a segment, no two of them",
    "It holds for the number of segments, also where only those cells have to be covered.",
    certificate=CertifiedCells,
)
COVER = BoundKind(
    "fewer color regions cannot touch every cell",
    "It holds for the number of segments, also where only the cells of its certificate have to be "
    "covered.",
    certificate=CertifiedCells,
)


_Cells = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class CertifiedCrossing(Value):
    """Two segments that would have to cross.

    Attributes:
        colors: the first segment's color, and the second one's.
        one: two sets of cells of which the first segment touches one each.
        other: the same for the second segment.
    """

    colors: tuple[int, int]
    one: tuple[_Cells, _Cells]
    other: tuple[_Cells, _Cells]


@dataclass(frozen=True, slots=True)
class CertifiedPart(Value):
    """Cells that so many segments at least are needed to touch, and why fewer cannot.

    Attributes:
        value: so many.
        cells: what they are needed to touch.
        conflicts: what two segments cannot do.
    """

    value: NonNegativeInt
    cells: _Cells
    conflicts: tuple[CertifiedCrossing, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class CertifiedParts(Certificate):
    """Parts whose values add up.

    Attributes:
        left_out: color regions that are left out, in older certificates: each by its color and one
            of its cells, with the color that replaces it.
        parts: no color region of one lies in another.
    """

    left_out: tuple[tuple[int, int, int], ...] = ()
    parts: tuple[CertifiedPart, ...]

    def shown(self, value: int, instance: Instance) -> Shown:
        """One conflict if there is any, or else the cells."""
        conflicts = [conflict for part in self.parts for conflict in part.conflicts]
        if conflicts:
            return _conflict_shown(conflicts, instance)
        cells = tuple(cell for part in self.parts for cell in part.cells)
        return CertifiedCells(cells).shown(value, instance)


def _conflict_shown(conflicts: Sequence[CertifiedCrossing], instance: Instance) -> Shown:
    """The four areas of one conflict, and two connections, which would cross."""
    first = conflicts[0]
    marks, connections = [], []
    for group, (letter, areas) in enumerate(zip("ab", (first.one, first.other), strict=True)):
        color = first.colors[group]
        name = instance.colors[color]
        for place, area in enumerate(areas, start=1):
            which = f"{'cell' if len(area) == 1 else 'cells'} {listed(area)}"
            text = f"{letter}{place}: {which}, to be connected in {name}"
            marks.append(Mark(f"{letter}{place}", text, area, (color,)))
        text = f"a connection of {letter}1 and {letter}2 in {name}"
        connections.append(Connection(text, color, *areas))
    notes = [
        "A segment that touches a1 and a2 and one that touches b1",
        "and b2 would cross, wherever they run. Two are drawn.",
    ]
    if len(conflicts) > 1:
        notes.append(f"The certificate names {count(len(conflicts) - 1, 'conflict')} more.")
    return Shown(tuple(marks), tuple(connections), tuple(notes))


CONFLICTS = BoundKind(
    "fewer segments would have to cross each other",
    EVERY_CELL,
    certificate=CertifiedParts,
)


COMPLETE_MODEL = "the complete model"
"""How texts call the model that a solution gives the size of."""

_STRANDS = (
    "It holds for the number of segments, where every cell has to be covered, in divisions with "
    "the solution's strands."
)


KINDS = {
    "strangers": STRANGERS,
    "cover": COVER,
    "conflicts": CONFLICTS,
    "exact": BoundKind(
        "a recursion over the graph has nothing better, and more strands would be of no use",
        EVERY_CELL,
        "a recursion over the graph",
    ),
    "crossings": BoundKind(
        f"{COMPLETE_MODEL} has nothing better, and more strands would be of no use", EVERY_CELL
    ),
    "model": BoundKind("", _STRANDS, COMPLETE_MODEL),
    "search": BoundKind("", _STRANDS, "exhaustive search"),
}
"""What cellcolor writes. A bound may be of another kind: it is kept, and taken on trust."""


def kind_of(bound: Bound) -> BoundKind:
    """The kind of a bound; of one that is not known nothing is said."""
    return KINDS.get(bound.kind, BoundKind())


def certificate_of(bound: Bound) -> Certificate | None:
    """What a bound can be verified by; None if there is nothing.

    Nothing verifies older certificates any more that have hubs or tangles in a part.

    Raises:
        InputError: it is no certificate of its kind.
    """
    form = kind_of(bound).certificate
    if form is None or bound.certificate is None:
        return None
    parts = bound.certificate.get("parts")
    if form is CertifiedParts and isinstance(parts, list):
        members = {name for part in parts if isinstance(part, dict) for name in part}
        if not members.isdisjoint(("hubs", "tangles")):
            return None
    return form.from_document(bound.certificate)
