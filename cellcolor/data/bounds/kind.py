"""What a kind of bound is: why it holds, for which objective, and what its certificate shows."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Self

from pydantic import ConfigDict, TypeAdapter

from cellcolor.files.documents import validate

if TYPE_CHECKING:
    from cellcolor.data.instance import Instance

EVERY_CELL = "It holds for the number of segments, where every cell has to be covered."
"""The objective of most kinds of bounds."""


@dataclass(frozen=True, slots=True)
class Mark:
    """Cells to be marked on the surface.

    Attributes:
        label: what is written on them.
        text: what they are.
        cells: the cells.
        group: marks of one group have one color; None for cells that are taken away.
    """

    label: str
    text: str
    cells: Collection[int]
    group: int | None


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


class Certificate(ABC):
    """What proves a bound. A subclass is a frozen dataclass with the members of the JSON object."""

    __slots__ = ()
    __pydantic_config__ = ConfigDict(extra="forbid", strict=True)

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> Self:
        """A certificate from the JSON object.

        Raises:
            InputError: it is none.
        """
        found: Self = validate(cls._adapter(), document)
        return found

    def to_document(self) -> dict[str, Any]:
        """The JSON object."""
        document: dict[str, Any] = self._adapter().dump_python(self)
        return document

    @abstractmethod
    def shown(self, value: int, instance: Instance) -> Shown:
        """What is to be seen of it.

        Args:
            value: the bound's.
            instance: the topological graph.
        """

    def witness(self, value: int) -> tuple[int, ...]:  # noqa: ARG002
        """As many cells as the bound says, no two of which can share a segment; or none."""
        return ()

    @classmethod
    @cache
    def _adapter(cls) -> TypeAdapter[Any]:
        return TypeAdapter(cls)


@dataclass(frozen=True, slots=True)
class BoundKind:
    """A way to prove a lower bound.

    Attributes:
        because: why no division has fewer segments, a clause; empty for what holds for the
            solution's strands only.
        objective: what it bounds, and what has to be covered for that, a sentence.
        certificate: what a bound of this kind can be verified by; None if it is taken on trust.
    """

    because: str = ""
    objective: str = ""
    certificate: type[Certificate] | None = None

    def __str__(self) -> str:
        because = f"{self.because[:1].upper()}{self.because[1:]}. " if self.because else ""
        return because + self.objective
