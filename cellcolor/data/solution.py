"""A solver's answer: a division of every cell into colored sub-cells, its proof, and schemes."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import combinations
from os import PathLike
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, NonNegativeFloat, NonNegativeInt, PositiveInt

from cellcolor.data.bounds import (
    COMPLETE_MODEL,
    Bound,
    CertifiedCells,
    Extent,
    certificate_of,
    kind_of,
)
from cellcolor.data.cells_and_edges import DartName, twin
from cellcolor.data.instance import Coverage, Instance
from cellcolor.data.value import Document, Value, adapter_of, read_one_of
from cellcolor.data.wording import count, listed
from cellcolor.errors import InputError
from cellcolor.files.documents import is_json, parse_json, read_text, take_body, validate
from cellcolor.files.validation import settle
from cellcolor.union_find import UnionFind

_MOST_WITNESSES = 12  # cells; more of them convince nobody

SearchSpace = Literal["paper", "surface"]
"""Which divisions are looked for (docs/semantics.md, section 4)."""
Status = Literal["optimal", "feasible", "unknown"]


@dataclass(frozen=True, slots=True)
class SubCell(Value):
    """One part of a divided cell (or the whole of an undivided one).

    Attributes:
        color: the color it is painted in.
        darts: its darts in state 1, in no particular order.
        segment: the segment it belongs to, counted from 0.
    """

    color: int
    darts: tuple[DartName, ...]
    segment: int


@dataclass(frozen=True, slots=True)
class CellDivision(Value):
    """How one cell is divided and painted."""

    id: int
    subcells: tuple[SubCell, ...]


Division = tuple[CellDivision, ...]
"""How every cell is divided and painted, in the order of the cells."""


def count_segments(division: Division) -> int:
    """The number of segments of a division with numbered segments."""
    return len({sub.segment for cell in division for sub in cell.subcells})


SchemeKey = tuple[frozenset[tuple[int, frozenset[DartName]]], ...]


def scheme_key(division: Division) -> SchemeKey:
    """A key that two schemes share exactly when they are the same (states, blocks, colors)."""
    return tuple(
        frozenset((sub.color, frozenset(sub.darts)) for sub in cell.subcells) for cell in division
    )


@dataclass(frozen=True, slots=True)
class Seam(Value):
    """A virtual edge that makes one cyclic list of two loops of a cell.

    Attributes:
        id: above every edge id; ``+id`` is walked after ``from_``, ``-id`` after ``to``.
        cell: the cell on both of its sides.
        from_: the dart of one loop after which the seam leaves (``from`` in the file).
        to: the dart of another loop after which the seam arrives.
        strands: how many corridors may pass between the loops across the seam.
    """

    id: PositiveInt
    cell: int
    from_: Annotated[int, Field(alias="from")]
    to: int
    strands: NonNegativeInt


@dataclass(frozen=True, slots=True)
class InstanceReference(Value):
    """The instance that was solved.

    Attributes:
        name: what it is called.
        sha256: its fingerprint.
        of: what that was taken of: the ``graph``, or the whole ``text`` of its file as in
            solutions of version 1.
    """

    name: str
    sha256: str
    of: Literal["graph", "text"] = "graph"


@dataclass(frozen=True, slots=True)
class ModelSize(Value):
    """How large the complete model is that was solved (docs/formulation.md)."""

    variables: NonNegativeInt
    constraints: NonNegativeInt

    def __str__(self) -> str:
        return f"{self.variables:,} variables, {self.constraints:,} constraints"


@dataclass(frozen=True, slots=True)
class Preference(Value):
    """What was preferred among divisions with as few segments (docs/motion.md, "Posture").

    Attributes:
        posture: ``near-home`` or ``well-conditioned``.
        cost: the mean over the area: how far a joint is from home, rad; or from 0, best, to 1.
        branch: what was to be painted in some branches first; None if none was named.
        outside: the share of the area that is painted in other branches.
        unproved: why it is not proved that no division with as many segments costs less; None if
            it is.
    """

    posture: Literal["near-home", "well-conditioned"]
    cost: NonNegativeFloat
    branch: str | None = None
    outside: NonNegativeFloat = 0.0
    unproved: str | None = None

    def __str__(self) -> str:
        said = f"conditioning {self.cost:.2f} from 0, best, to 1"
        if self.posture == "near-home":
            said = f"joints {self.cost:.2f} rad from home on average"
        if self.branch is not None:
            said = f"{self.outside:.1%} of the area not {self.branch}, {said}"
        if self.unproved is not None:
            return f"{said}, not proved to be the best: {self.unproved}"
        return f"{said}, proved to be the best with as many segments"


@dataclass(frozen=True, slots=True, repr=False)
class Solution(Document):
    """A solver's answer, never stronger than its proof.

    Attributes:
        instance: what was solved.
        search_space: ``paper`` or ``surface``.
        strands: strands per topological edge; 1 in ``paper``.
        solver: the solver's name.
        status: ``optimal`` (proved in the search space), ``feasible`` or ``unknown``.
        segments: number of segments, None when no division was found.
        lift_offs: ``max(0, segments - 1)``, None when no division was found.
        lower_bound: no division in the search space has fewer segments.
        surface_lower_bound: no division of the physical surface has fewer segments.
        proved_for_surface: ``segments`` equals ``surface_lower_bound``.
        seams: the seams of cells with several loops.
        cells: the division, None when none was found.
        seconds: wall-clock time spent solving.
        schemes: with "all optimal schemes" asked for, how many were found.
        complete: with "all optimal schemes" asked for, whether that is all of them.
        cutting_paths: in older solutions that have it, how many the division has.
        cutting_paths_lower_bound: in older solutions that have it, no division in the search space
            with as few segments has fewer.
        bounds: how ``lower_bound`` and ``surface_lower_bound`` were proved, each the greatest of
            its kind in here; None where that is not said, as in files of version 1.
        coverage: the instance's, so that the solution alone gives the shares.
        notes: what was left out and why, a sentence each.
        model: how large the complete model is, where one was built and solved.
        preference: which of several divisions a scene's is.
    """

    FORMAT = "cellcolor/solution"
    ADDED = (("bounds", "coverage", "notes", "instance.of"), ("model", "preference"))
    LINES = ("bounds", "cells")

    instance: InstanceReference
    search_space: SearchSpace
    strands: PositiveInt
    solver: str
    status: Status
    segments: NonNegativeInt | None
    lift_offs: NonNegativeInt | None
    lower_bound: NonNegativeInt
    surface_lower_bound: NonNegativeInt
    proved_for_surface: bool
    seams: tuple[Seam, ...]
    cells: Division | None
    seconds: NonNegativeFloat
    schemes: NonNegativeInt | None = None
    complete: bool | None = None
    cutting_paths: NonNegativeInt | None = None
    cutting_paths_lower_bound: NonNegativeInt | None = None
    bounds: tuple[Bound, ...] | None = None
    coverage: Coverage | None = None
    notes: tuple[str, ...] = ()
    model: ModelSize | None = None
    preference: Preference | None = None

    def __post_init__(self) -> None:
        settle(self)
        found = ("segments", "lift_offs", "cells")
        missing = [name for name in found if getattr(self, name) is None]
        if self.status == "unknown" and len(missing) < 3:
            raise InputError(None, "status", f"an unknown result has null {listed(found)}")
        if self.status != "unknown" and missing:
            raise InputError(None, missing[0], f"must not be null in a result {self.status!r}")

    @property
    def witness(self) -> tuple[int, ...]:
        """As many cells as there are segments, no two of which can be in one segment; ascending.

        They come from the certificate of the bound that proves the number. There are none if the
        number is not proved for any division, if one segment is enough or more than 12 are
        needed, or if the certificate is missing or has other cells.
        """
        wanted = self.segments or 0
        if self.proved_for_surface and 1 < wanted <= _MOST_WITNESSES:
            for bound in self.bounds or ():
                with suppress(InputError):  # a certificate that says nothing
                    certificate = certificate_of(bound) if bound.value == wanted else None
                    if isinstance(certificate, CertifiedCells) and len(certificate.cells) == wanted:
                        return certificate.cells
        return ()

    def why_not_fewer(self, instance: Instance | None = None) -> str | None:
        """Why no division of the surface has fewer segments, a clause.

        None if that is not proved, if it needs no reason (a single segment), or if none is known.

        Args:
            instance: what was solved, to name the cells of the proof where there are a few.
        """
        if not self.proved_for_surface or (self.segments or 0) < 2:
            return None
        witness = None if instance is None else witness_in_words(instance, self.witness)
        return witness or self._told("surface", "because")

    @property
    def proved_by(self) -> str | None:
        """By what a minimum is proved that is one in the search space only, without ``by``.

        None if there is no such proof, or if nothing is known of it.
        """
        if self.status != "optimal" or self.proved_for_surface:
            return None
        return self._told("strands", "by")

    def _told(self, extent: Extent, member: Literal["because", "by"]) -> str | None:
        """What the kind of the bound that proves the minimum says of itself."""
        for bound in self.bounds or ():
            if bound.holds_for == extent and bound.value == self.segments:
                told: str = getattr(kind_of(bound), member)
                size = "" if self.model is None else f" ({self.model})"
                return told.replace(COMPLETE_MODEL, COMPLETE_MODEL + size) or None
        return None

    def in_words(self, instance: Instance | None = None) -> str:
        """Segments, lift-offs and proof, like ``2 segments, 1 lift-off, optimal: proved for …``.

        Args:
            instance: what was solved, to name the cells of the proof where there are a few.
        """
        if self.segments is None or self.lift_offs is None:
            if self.coverage is not None and self.coverage.covered == 0:
                return "no division: no point of the surface can be covered"
            return f"no division found; at least {count(self.lower_bound, 'segment')}"
        found = f"{count(self.segments, 'segment')}, {count(self.lift_offs, 'lift-off')}"
        if self.proved_for_surface:
            reason = self.why_not_fewer(instance)
            because = "" if reason is None else f", because {reason}"
            return f"{found}, optimal: proved for any division of the surface{because}"
        everywhere = f"any division of the surface has at least {self.surface_lower_bound}"
        if self.status == "optimal":
            by = "" if self.proved_by is None else f", by {self.proved_by}"
            return f"{found}, optimal in the search space {self.search_space}{by}; {everywhere}"
        return (
            f"{found}, not proved to be the fewest: at least {self.lower_bound} in the search "
            f"space {self.search_space}; {everywhere}"
        )

    def __str__(self) -> str:
        return self.in_words()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.instance.name!r}: {self}>"

    def to_document(self) -> dict[str, Any]:
        return Document.to_document(self) | {"seconds": round(self.seconds, 4)}

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> Solution:
        body = take_body(document, cls.FORMAT, cls.ADDED)
        if document["version"] == 1 and isinstance(body.get("instance"), dict):
            body["instance"] = body["instance"] | {"of": "text"}
        found: Solution = validate(adapter_of(cls), body)
        return found

    @classmethod
    def read(cls, path: str | PathLike[str]) -> Solution:
        """A solution from a file; of a file with schemes, its first line.

        Raises:
            InputError: the file cannot be read or holds something that the format forbids.
        """
        found: Solution = read_one_of(path, (cls,))
        return found


def witness_in_words(instance: Instance, cells: tuple[int, ...]) -> str | None:
    """What is to be seen at cells no two of which can share a segment, a clause.

    Args:
        cells: as many as there are segments; with none there is nothing to be said.
    """
    if not cells:
        return None
    colors = (set(instance.cells[cell].colors) for cell in cells)
    disjoint = all(a.isdisjoint(b) for a, b in combinations(colors, 2))
    if len(cells) == 2:
        apart = "share no color" if disjoint else "can share no segment"
        return f"cells {listed(cells)} {apart}"
    shared = "share a color" if disjoint else "can be in one segment"
    return f"no two of the cells {listed(cells)} {shared}"


def number_segments(blocks: Sequence[Iterable[tuple[int, Sequence[DartName]]]]) -> Division:
    """A division from each cell's (color, darts in state 1) pairs, its segments numbered.

    Darts ``+e`` and ``-e`` (of the same strand) join the sub-cells that hold them. Segments are
    numbered in the order in which the cells meet them.
    """
    flat = [
        (cell, color, tuple(darts)) for cell, subs in enumerate(blocks) for color, darts in subs
    ]
    segments: UnionFind[int] = UnionFind(range(len(flat)))
    holder: dict[DartName, int] = {}
    for node, (_, _, darts) in enumerate(flat):
        for dart in darts:
            if twin(dart) in holder:
                segments.union(node, holder[twin(dart)])
            holder[dart] = node
    numbers: dict[int, int] = {}
    division: list[list[SubCell]] = [[] for _ in blocks]
    for node, (cell, color, darts) in enumerate(flat):
        segment = numbers.setdefault(segments[node], len(numbers))
        division[cell].append(SubCell(color, darts, segment))
    return tuple(CellDivision(cell, tuple(subs)) for cell, subs in enumerate(division))


@dataclass(frozen=True, slots=True)
class SchemeLine(Value):
    """One line of JSON Lines after the solution."""

    FORMAT: ClassVar[str] = "cellcolor/scheme"

    cells: Division


def read_schemes(path: str | PathLike[str]) -> Iterator[Division]:
    """The schemes that follow the solution in a file of JSON Lines; none in any other file.

    Raises:
        InputError: a line is not a scheme; the field names the line.
    """
    head, _, rest = read_text(path).partition("\n")
    if not is_json(head):
        return
    for number, line in enumerate(rest.splitlines(), start=2):
        try:
            body = parse_json(line)
            if body.pop("format", None) != SchemeLine.FORMAT:
                raise InputError(None, "format", f"must be {SchemeLine.FORMAT!r}")
            yield SchemeLine.from_document(body).cells
        except InputError as error:
            field = f"line {number}" + (f", {error.field}" if error.field else "")
            raise InputError(path, field, error.message) from error


def scheme_line(division: Division) -> str:
    """One line of JSON Lines for one optimal scheme."""
    document = {"format": SchemeLine.FORMAT} | SchemeLine(division).to_document()
    return json.dumps(document, ensure_ascii=False)
