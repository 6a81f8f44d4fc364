"""Lower bounds of the number of segments: their kinds, and what their certificates hold.

The solvers find bounds and the checker verifies them; neither is in here, so that they share the
data and nothing else.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

from pydantic import NonNegativeInt

from cellcolor.data.value import Value
from cellcolor.data.wording import count
from cellcolor.files.validation import FreeContent

Extent = Literal["surface", "strands"]
"""What a bound holds for: any division of the surface, or those with the solution's strands."""


@dataclass(frozen=True, slots=True)
class Bound(Value):
    """No division of some kind has fewer segments than this.

    Attributes:
        kind: how it was proved; docs/formats.md has the kinds that cellcolor writes.
        value: the number of segments.
        holds_for: ``surface`` for any division of the physical surface, ``strands`` for those
            that the solution's strands allow (in the search space ``paper``: its divisions).
        certificate: what a checker without a solver can verify, if there is one.
    """

    kind: str
    value: NonNegativeInt
    holds_for: Extent
    certificate: FreeContent | None = field(default=None, hash=False)

    def __str__(self) -> str:
        extent = "any division of the surface" if self.holds_for == "surface" else "these strands"
        return f"at least {count(self.value, 'segment')} for {extent}, by {self.kind}"


def greatest(bounds: Sequence[Bound], extent: Extent) -> int:
    """The greatest bound for an extent, 0 if there is none.

    What holds for any division of the surface holds for those with strands as well.
    """
    return max((b.value for b in bounds if b.holds_for in ("surface", extent)), default=0)


EVERY_CELL = "It holds for the number of segments, where every cell has to be covered."
"""The objective of most kinds of bounds."""


class Certificate(Value):
    """What proves a bound. A subclass is a frozen dataclass with the members of the JSON object."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class BoundKind:
    """A way to prove a lower bound.

    Attributes:
        because: why no division has fewer segments, a clause; empty for what holds for the
            solution's strands only.
        objective: what it bounds, and what has to be covered for that, a sentence.
        by: what proves a minimum for the solution's strands; empty for what holds for the surface
            only.
        certificate: what a bound of this kind can be verified by; None if it is taken on trust.
    """

    because: str = ""
    objective: str = ""
    by: str = ""
    certificate: type[Certificate] | None = None

    def __str__(self) -> str:
        because = f"{self.because[:1].upper()}{self.because[1:]}. " if self.because else ""
        return because + self.objective


@dataclass(frozen=True, slots=True)
class CertifiedCells(Certificate):
    """Cells that fewer color regions than the bound says do not touch.

    If there are as many as it says, no color region touches two of them.
    """

    cells: tuple[int, ...]


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
        parts: no color region of one lies in another.
    """

    parts: tuple[CertifiedPart, ...]


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

    Nothing verifies older certificates any more that leave out color regions, or have hubs or
    tangles in a part.

    Raises:
        InputError: it is no certificate of its kind.
    """
    form = kind_of(bound).certificate
    if form is None or bound.certificate is None:
        return None
    document = dict(bound.certificate)
    if form is CertifiedParts:
        older, parts = bool(document.pop("left_out", [])), document.get("parts")
        for part in parts if isinstance(parts, list) else []:
            older |= isinstance(part, dict) and not part.keys().isdisjoint(("hubs", "tangles"))
        if older:
            return None
    return form.from_document(document)
