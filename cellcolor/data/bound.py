"""Lower bounds of the number of segments, each with the kind of its proof."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from pydantic import NonNegativeInt

from cellcolor.data.value import Value
from cellcolor.data.wording import count
from cellcolor.files.validation import json_content, settle

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
    certificate: dict[str, Any] | None = field(default=None, hash=False)

    def __post_init__(self) -> None:
        settle(self)
        if self.certificate is not None:
            content = json_content(self.certificate, "certificate")
            object.__setattr__(self, "certificate", content)

    def __str__(self) -> str:
        extent = "any division of the surface" if self.holds_for == "surface" else "these strands"
        return f"at least {count(self.value, 'segment')} for {extent}, by {self.kind}"

    def to_document(self) -> dict[str, Any]:
        """The JSON object."""
        document: dict[str, Any] = {
            "kind": self.kind,
            "value": self.value,
            "holds_for": self.holds_for,
        }
        if self.certificate is not None:
            document["certificate"] = self.certificate
        return document


def greatest(bounds: Sequence[Bound], extent: Extent) -> int:
    """The greatest bound for an extent, 0 if there is none.

    What holds for any division of the surface holds for those with strands as well.
    """
    return max((b.value for b in bounds if b.holds_for in ("surface", extent)), default=0)
