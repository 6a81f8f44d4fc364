"""The index of the instance library: where each graph comes from, and what is known of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated

from pydantic import Field, NonNegativeInt

from cellcolor.data.value import Document, Value
from cellcolor.data.wording import span
from cellcolor.errors import InputError
from cellcolor.files.validation import settle

Sha256 = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]
Date = Annotated[str, Field(pattern=r"^\d{4}-\d{2}-\d{2}$")]


@dataclass(frozen=True, slots=True)
class LowerBound(Value):
    """No division has fewer segments.

    Attributes:
        value: this many.
        kind: how it was proved, a kind of the bounds of solutions (docs/formats.md).
        verified: whether the checker verifies it by a certificate, without a solver.
        solver: what found it.
        version: of that solver.
        date: when it was found, as 2026-11-22.
    """

    value: NonNegativeInt
    kind: str
    verified: bool
    solver: str
    version: str
    date: Date


@dataclass(frozen=True, slots=True)
class UpperBound(Value):
    """A division has this many segments.

    Attributes:
        value: this many.
        solver: what found the division.
        version: of that solver.
        date: when it was found, as 2026-11-22.
        solution: the file with the division, seen from the index; null if it is not here.
    """

    value: NonNegativeInt
    solver: str
    version: str
    date: Date
    solution: str | None


@dataclass(frozen=True, slots=True)
class KnownRange(Value):
    """Where the minimum lies in a search space.

    Attributes:
        lower: the best lower bound.
        upper: the best division; null if none is known.
    """

    lower: LowerBound
    upper: UpperBound | None

    def __post_init__(self) -> None:
        settle(self)
        if self.upper is not None and self.lower.value > self.upper.value:
            message = f"is {self.lower.value}, above that of a division, {self.upper.value}"
            raise InputError(None, "lower.value", message)

    def __str__(self) -> str:
        return span(self.lower.value, None if self.upper is None else self.upper.value)

    @property
    def proved(self) -> bool:
        """Whether the minimum is known."""
        return self.upper is not None and self.upper.value == self.lower.value


@dataclass(frozen=True, slots=True)
class OutsideFile(Value):
    """A file that is not here, and how it becomes the instance: ``cellcolor import``.

    Attributes:
        place: where it can be found.
        corrections: of lines of the file, as ``--correct`` takes them.
    """

    place: str
    corrections: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class LibraryEntry(Value):
    """One graph of the library.

    Attributes:
        name: what it is called.
        family: the family that it belongs to.
        source: where it comes from, or how to make it again.
        license: that of the graph, an SPDX identifier; null where none is stated.
        file: an instance, or a labelled surface that is decomposed into one, seen from the index;
            null where the graph is not here.
        outside: where it can be found otherwise; null for a file that is here.
        sha256: of the bytes of the file, which may be here or outside.
        fingerprint: of the graph: what solutions refer to it by (docs/formats.md).
        cells: how many.
        edges: how many.
        darts: live darts of the cell with the most of them.
        loops: loops with live darts of the cell with the most of them.
        colors: how many.
        holes: loops beyond the first of all cells together, dead ones included.
        paper: where the minimum lies in the search space ``paper``.
        surface: where it lies for any division of the surface.
    """

    name: str
    family: str
    source: str
    license: str | None
    file: str | None
    outside: OutsideFile | None
    sha256: Sha256
    fingerprint: Sha256
    cells: NonNegativeInt
    edges: NonNegativeInt
    darts: NonNegativeInt
    loops: NonNegativeInt
    colors: NonNegativeInt
    holes: NonNegativeInt
    paper: KnownRange
    surface: KnownRange

    def __post_init__(self) -> None:
        settle(self)
        if (self.file is None) == (self.outside is None):
            raise InputError(None, "file", "is either here or outside, one of the two")
        paper, surface = self.paper, self.surface
        if surface.lower.value > paper.lower.value:
            message = "what holds for any division holds in the search space paper as well"
            raise InputError(None, "paper.lower.value", message)
        if paper.upper is not None and (
            surface.upper is None or surface.upper.value > paper.upper.value
        ):
            message = "a division of the search space paper is one of the surface"
            raise InputError(None, "surface.upper.value", message)


@dataclass(frozen=True, slots=True)
class LibraryIndex(Document):
    """All graphs of the library.

    Attributes:
        entries: in the order of their names.
    """

    FORMAT = "cellcolor/library"
    LINES = ("entries",)

    entries: tuple[LibraryEntry, ...]

    def __post_init__(self) -> None:
        settle(self)
        names = Counter(entry.name for entry in self.entries)
        for place, entry in enumerate(self.entries):
            if names[entry.name] > 1:
                raise InputError(None, f"entries[{place}].name", f"{entry.name!r} appears twice")

    def __len__(self) -> int:
        return len(self.entries)

    def __iter__(self) -> Iterator[str]:
        """The names, in order, as of a mapping."""
        return (entry.name for entry in self.entries)

    def __getitem__(self, name: str) -> LibraryEntry:
        """The entry of a name.

        Raises:
            KeyError: there is none.
        """
        for entry in self.entries:
            if entry.name == name:
                return entry
        raise KeyError(name)
