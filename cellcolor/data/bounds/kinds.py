"""The kinds of bounds by name."""

from __future__ import annotations

from cellcolor.data.bound import Bound
from cellcolor.data.bounds.cells import COVER, STRANGERS
from cellcolor.data.bounds.kind import EVERY_CELL, BoundKind, Certificate
from cellcolor.data.bounds.parts import CONFLICTS, HUBS

_STRANDS = (
    "It holds for the number of segments, where every cell has to be covered, in divisions with "
    "the solution's strands."
)

_UNKNOWN = BoundKind()

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
    return KINDS.get(bound.kind, _UNKNOWN)


def certificate_of(bound: Bound) -> Certificate | None:
    """What a bound can be verified by; None if there is nothing.

    Raises:
        InputError: it is no certificate of its kind.
    """
    form = kind_of(bound).certificate
    if form is None or bound.certificate is None:
        return None
    return form.from_document(bound.certificate)
