"""The kinds of bounds by name, and what their certificates hold and show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

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
    CertifiedCells,
)
COVER = BoundKind(
    "fewer color regions cannot touch every cell",
    "It holds for the number of segments, also where only the cells of its certificate have to be "
    "covered.",
    CertifiedCells,
)


_Cells = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class CertifiedCrossing:
    """Two segments that would have to cross.

    Attributes:
        colors: the first segment's color, and the second one's.
        one: two sets of cells of which the first segment touches one each.
        other: the same for the second segment.
    """

    __pydantic_config__ = Certificate.__pydantic_config__

    colors: tuple[int, int]
    one: tuple[_Cells, _Cells]
    other: tuple[_Cells, _Cells]


@dataclass(frozen=True, slots=True)
class CertifiedSegment:
    """What a tangle says of one of its segments.

    Attributes:
        color: its color.
        groups: groups of areas, each a set of cells; it touches a cell of some area of each group.
        avoided: cells of its color region, none of which it touches.
    """

    __pydantic_config__ = Certificate.__pydantic_config__

    color: int
    groups: tuple[tuple[_Cells, ...], ...]
    avoided: _Cells = ()


@dataclass(frozen=True, slots=True)
class CertifiedTangle:
    """Segments that cannot all be drawn."""

    __pydantic_config__ = Certificate.__pydantic_config__

    segments: tuple[CertifiedSegment, ...]


@dataclass(frozen=True, slots=True)
class CertifiedPart:
    """Cells that so many segments at least are needed to touch, and why fewer cannot.

    Attributes:
        value: so many.
        cells: what they are needed to touch.
        conflicts: what two segments cannot do.
        tangles: what one segment or more cannot do.
        hubs: cells that are taken away, to see how many pieces of segments are needed.
    """

    __pydantic_config__ = Certificate.__pydantic_config__

    value: NonNegativeInt
    cells: _Cells
    conflicts: tuple[CertifiedCrossing, ...] = ()
    tangles: tuple[CertifiedTangle, ...] = ()
    hubs: _Cells = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class CertifiedParts(Certificate):
    """Parts whose values add up; ``left_out`` has color, a cell of the region, and stand-in."""

    left_out: tuple[tuple[int, int, int], ...] = ()
    parts: tuple[CertifiedPart, ...]

    def shown(self, value: int, instance: Instance) -> Shown:
        """One conflict if there is any, or else the cells, with the hubs."""
        conflicts = [conflict for part in self.parts for conflict in part.conflicts]
        tangles = sum(len(part.tangles) for part in self.parts)
        if conflicts:
            return _conflict_shown(conflicts, tangles, instance)
        cells, hubs = (
            sorted({cell for part in self.parts for cell in getattr(part, name)})
            for name in ("cells", "hubs")
        )
        if hubs:
            notes = (
                "Without the hubs no two of the cells can share a segment,",
                "and the hubs join no more.",
            )
        elif tangles:
            fewer = count(value - 1, "segment")
            notes = (f"No {fewer} that touch all of these cells", "can be drawn side by side.")
        else:
            return CertifiedCells(tuple(cells)).shown(value, instance)
        return Shown(marks_of(instance, cells, hubs), (), notes)

    def to_document(self) -> dict[str, Any]:
        """The JSON object; parts have tangles and hubs where there are some."""
        document = Certificate.to_document(self)
        for part in document["parts"]:
            for name in ("tangles", "hubs"):
                if not part[name]:
                    del part[name]
        return document


def _conflict_shown(
    conflicts: Sequence[CertifiedCrossing], tangles: int, instance: Instance
) -> Shown:
    """The four areas of one conflict, and two connections, which would cross."""
    first = conflicts[0]
    marks, connections = [], []
    for group, (letter, areas) in enumerate(zip("ab", (first.one, first.other), strict=True)):
        color = first.colors[group]
        name = instance.colors[color]
        for place, area in enumerate(areas, start=1):
            which = f"{'cell' if len(area) == 1 else 'cells'} {listed(area)}"
            text = f"{letter}{place}: {which}, to be connected in {name}"
            marks.append(Mark(f"{letter}{place}", text, area, group))
        text = f"a connection of {letter}1 and {letter}2 in {name}"
        connections.append(Connection(text, color, *areas))
    notes = [
        "A segment that touches a1 and a2 and one that touches b1",
        "and b2 would cross, wherever they run. Two are drawn.",
    ]
    if len(conflicts) > 1:
        notes.append(f"The certificate names {count(len(conflicts) - 1, 'conflict')} more.")
    if tangles:
        notes.append(f"It names {count(tangles, 'tangle')} of several segments, too.")
    return Shown(tuple(marks), tuple(connections), tuple(notes))


CONFLICTS = BoundKind(
    "fewer segments would have to cross each other",
    EVERY_CELL,
    CertifiedParts,
)
HUBS = BoundKind(
    "more connections do not fit side by side into cells with many edges",
    EVERY_CELL,
    CertifiedParts,
)


_STRANDS = (
    "It holds for the number of segments, where every cell has to be covered, in divisions with "
    "the solution's strands."
)


KINDS = {
    "strangers": STRANGERS,
    "cover": COVER,
    "conflicts": CONFLICTS,
    "hubs": HUBS,
    "crossings": BoundKind(
        "the full model has nothing better, and more strands would be of no use", EVERY_CELL
    ),
    "model": BoundKind("", _STRANDS),
    "search": BoundKind("", _STRANDS),
}
"""What cellcolor writes. A bound may be of another kind: it is kept, and taken on trust."""


def kind_of(bound: Bound) -> BoundKind:
    """The kind of a bound; of one that is not known nothing is said."""
    return KINDS.get(bound.kind, BoundKind())


def certificate_of(bound: Bound) -> Certificate | None:
    """What a bound can be verified by; None if there is nothing.

    Raises:
        InputError: it is no certificate of its kind.
    """
    form = kind_of(bound).certificate
    if form is None or bound.certificate is None:
        return None
    return form.from_document(bound.certificate)
