"""Lower bounds of the number of segments: each with its kind, and what its certificate holds.

The solvers find bounds and the checker verifies them; neither is in here, so that they share the
data and nothing else.

"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from pydantic import NonNegativeInt

from cellcolor.data.instance import Instance
from cellcolor.data.value import Value
from cellcolor.data.wording import count, listed
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


def greatest(bounds: Sequence[Bound], extent: Extent) -> int:
    """The greatest bound for an extent, 0 if there is none.

    What holds for any division of the surface holds for those with strands as well.
    """
    return max((b.value for b in bounds if b.holds_for in ("surface", extent)), default=0)


EVERY_CELL = "It holds for the number of segments, where every cell has to be covered."
"""The objective of most kinds of bounds."""


@dataclass(frozen=True, slots=True)
class Mark:
    """Cells to be marked on the surface.

    Attributes:
        label: what is written on them.
        text: what they are.
        cells: the cells.
        colors: those that they can be covered in, as far as that matters.
    """

    label: str
    text: str
    cells: Collection[int]
    colors: Collection[int]


@dataclass(frozen=True, slots=True)
class Connection:
    """A way from one area to another in one color, to be drawn on the surface."""

    text: str
    color: int
    near: Collection[int]
    far: Collection[int]


@dataclass(frozen=True, slots=True)
class Shown:
    """What is to be seen of a certificate, before anything draws it.

    Attributes:
        marks: of a cell in several of them the last is to be seen.
        connections: where two of them cross is marked as well.
        notes: lines under the legend.
    """

    marks: tuple[Mark, ...]
    connections: tuple[Connection, ...]
    notes: tuple[str, ...]


class Certificate(Value, ABC):
    """What proves a bound. A subclass is a frozen dataclass with the members of the JSON object."""

    __slots__ = ()

    @abstractmethod
    def shown(self, value: int, instance: Instance) -> Shown:
        """What is to be seen of it.

        Args:
            value: the bound's.
        """

    def witness(self, value: int) -> tuple[int, ...]:  # noqa: ARG002
        """As many cells as the bound says, no two of which can share a segment; or none."""
        return ()


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


def marks_of(instance: Instance, cells: Sequence[int]) -> tuple[Mark, ...]:
    """Cells, each by itself, with their colors."""
    return tuple(
        Mark(
            str(cell),
            f"cell {cell}: {listed(instance.colors[c] for c in instance.cells[cell].colors)}",
            (cell,),
            instance.cells[cell].colors,
        )
        for cell in cells
    )
