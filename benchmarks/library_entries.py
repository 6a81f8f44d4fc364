"""The index of the instance library: made from the files beside it, and compared with them.

What the index says is known of an instance is what the stored solutions show (docs/library.md): a
division for each upper bound, and for each lower bound the solution that claims it, with its
certificate where there is one.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

from cellcolor.checker.certificates import BoundVerdict
from cellcolor.checker.claimed_numbers import contradictions
from cellcolor.checker.division import check_solution
from cellcolor.data.bounds import KINDS
from cellcolor.data.instance import Instance
from cellcolor.data.library_index import (
    KnownRange,
    LibraryEntry,
    LibraryIndex,
    LowerBound,
    UpperBound,
)
from cellcolor.data.solution import SearchSpace, Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError

INDEX = "index.json"
"""The index's name in the folder of the library."""
SOLUTIONS = "solutions"
"""The folder of the stored solutions in that of the library."""
_SURFACE = ".surface.json"
_SPACES: tuple[SearchSpace, ...] = ("paper", "surface")


@dataclass(frozen=True)
class Origin:
    """What the file of a graph does not say of itself.

    Attributes:
        family: what the graph is one of.
        source: where it comes from.
        license: an SPDX identifier.
    """

    family: str
    source: str
    license: str


def graph_files(folder: Path) -> dict[str, Path]:
    """The file of each graph by name: an instance, or where there is none a labelled surface."""
    found: dict[str, Path] = {}
    for path in sorted(folder.rglob("*.json")):
        if path.parent == folder or path.parent.name == SOLUTIONS:
            continue
        name = path.name.removesuffix(_SURFACE).removesuffix(".json")
        if not path.name.endswith(_SURFACE) or name not in found:
            found[name] = path
    return dict(sorted(found.items()))


def graph_of(path: Path) -> Instance:
    """The graph in a file of the library.

    Raises:
        InputError: there is none.
    """
    if path.name.endswith(_SURFACE):
        return decompose(LabelledSurface.read(path))
    return Instance.read(path)


def solution_files(folder: Path, name: str) -> list[Path]:
    """The stored solutions of a graph: one in the search space paper, one in ``surface``."""
    names = (f"{name}.solution.json", f"{name}.surface.solution.json")
    return [path for path in (folder / SOLUTIONS / file for file in names) if path.exists()]


def entry_of(
    folder: Path,
    path: Path,
    origin: Origin,
    before: LibraryEntry | None,
    version_of: Callable[[str], str],
    date: str,
) -> LibraryEntry:
    """The entry of a graph that is stored with its solutions.

    Args:
        folder: of the library.
        path: of the graph, in that folder.
        origin: where it comes from.
        before: the entry until now: bounds that stay keep their versions and dates.
        version_of: the version that a solver has now, by its name.
        date: today.

    Raises:
        InputError: a file cannot be used, or a solution is not valid.
    """
    graph = graph_of(path)
    name = path.name.removesuffix(_SURFACE).removesuffix(".json")
    shown = [_Shown.read(folder, file, graph) for file in solution_files(folder, name)]
    ranges: dict[SearchSpace, KnownRange] = {}
    for space in _SPACES:
        kept: KnownRange | None = getattr(before, space, None)
        lower = _dated(_lower(space, shown), kept.lower if kept else None, version_of, date)
        upper = _upper(space, shown)
        if upper is not None:
            upper = _dated(upper, kept.upper if kept else None, version_of, date)
        ranges[space] = KnownRange(lower, upper)
    return LibraryEntry(
        name=name,
        family=origin.family,
        source=origin.source,
        license=origin.license,
        file=path.relative_to(folder).as_posix(),
        outside=None,
        sha256=_sha256(path),
        fingerprint=graph.sha256,
        paper=ranges["paper"],
        surface=ranges["surface"],
        **_numbers(graph),
    )


def problems(folder: Path) -> list[str]:
    """What is not as the index of a library says, each beginning with the name of a file.

    Every file is read, every solution checked, every certificate verified again.

    Args:
        folder: of the library.

    Raises:
        InputError: the index cannot be read.
    """
    index = LibraryIndex.read(folder / INDEX)
    files = {path.relative_to(folder).as_posix() for path in graph_files(folder).values()}
    found = [
        f"{file}: is not in the index" for file in sorted(files - {e.file for e in index.entries})
    ]
    known = {path for entry in index.entries for path in solution_files(folder, entry.name)}
    strays = sorted(set((folder / SOLUTIONS).glob("*.json")) - known)
    found += [f"{path.relative_to(folder).as_posix()}: is of no graph here" for path in strays]
    if [entry.name for entry in index.entries] != sorted(entry.name for entry in index.entries):
        found.append(f"{INDEX}: the entries are not in the order of their names")
    return found + [line for entry in index.entries for line in problems_of(folder, entry)]


def problems_of(folder: Path, entry: LibraryEntry) -> list[str]:
    """What is not as one entry says; see :func:`problems`."""
    if entry.file is None:
        return []
    path = folder / entry.file
    found = []
    try:
        if _sha256(path) != entry.sha256:
            found.append(f"{entry.file}: sha256 is not that of the index")
        graph = graph_of(path)
    except OSError as error:
        return [f"{entry.file}: {error.strerror}"]
    except InputError as error:
        return [*found, str(error.in_file(entry.file))]
    shown = []
    for file in solution_files(folder, entry.name):
        try:
            shown.append(_Shown.read(folder, file, graph))
        except InputError as error:
            found.append(str(error.in_file(file.relative_to(folder).as_posix())))
    told = {name: getattr(entry, name) for name in _numbers(graph)}
    differing = [name for name, number in _numbers(graph).items() if told[name] != number]
    found += [f"{entry.file}: {name} is not that of the index" for name in differing]
    if graph.sha256 != entry.fingerprint:
        found.append(f"{entry.file}: fingerprint is not that of the index")
    for one in shown:
        found += [f"{one.file}: {text}" for text in contradictions(graph, one.solution)]
    return found + list(_bound_problems(entry, shown))


def _bound_problems(entry: LibraryEntry, shown: Sequence[_Shown]) -> Iterator[str]:
    """Where an entry says other bounds than the solutions show."""
    for space in _SPACES:
        said: KnownRange = getattr(entry, space)
        lower, upper = _lower(space, shown), _upper(space, shown)
        if replace(lower, version=said.lower.version, date=said.lower.date) != said.lower:
            yield f"{entry.file}: {space}.lower is {said.lower}, the solutions show {lower}"
        if upper is not None and said.upper is not None:
            upper = replace(upper, version=said.upper.version, date=said.upper.date)
        if upper != said.upper:
            yield f"{entry.file}: {space}.upper is {said.upper}, the solutions show {upper}"


@dataclass(frozen=True)
class _Shown:
    """A stored solution that the checker has passed.

    Attributes:
        file: seen from the index.
        solution: what it says.
        verdicts: what came of verifying its bounds.
    """

    file: str
    solution: Solution
    verdicts: tuple[BoundVerdict, ...]

    @classmethod
    def read(cls, folder: Path, path: Path, graph: Instance) -> _Shown:
        """A solution, checked.

        Raises:
            InputError: it is not valid, or not in the search space that its name says.
        """
        file = path.relative_to(folder).as_posix()
        solution = Solution.read(path)
        report = check_solution(graph, solution)
        if report.problems:
            raise InputError(file, None, f"is not valid: {report.problems[0]}")
        wanted = "surface" if path.name.endswith(".surface.solution.json") else "paper"
        if solution.search_space != wanted:
            raise InputError(file, "search_space", f"must be {wanted} by the file's name")
        return cls(file, solution, report.bounds)


def _lower(space: SearchSpace, shown: Sequence[_Shown]) -> LowerBound:
    """The best lower bound that solutions claim, a verified one if there is a choice, or else one
    of a kind that is not gone.

    A bound for some strands holds in the search space paper, whose divisions have one.
    """
    bounds = [
        LowerBound(
            verdict.bound.value,
            verdict.bound.kind,
            verdict.outcome == "verified",
            one.solution.solver,
            "",
            _NO_DATE,
        )
        for one in shown
        for verdict in one.verdicts
        if space == "paper" or verdict.bound.holds_for == "surface"
    ]
    nothing = LowerBound(0, "none", True, "none", "", _NO_DATE)
    return max([nothing, *bounds], key=lambda own: (own.value, own.verified, own.kind in KINDS))


def _upper(space: SearchSpace, shown: Sequence[_Shown]) -> UpperBound | None:
    """The best division, that of the search space paper if there is a choice."""
    bounds = [
        UpperBound(one.solution.segments, one.solution.solver, "", _NO_DATE, one.file)
        for one in shown
        if one.solution.segments is not None
        and (space == "surface" or one.solution.search_space == "paper")
    ]
    return min(bounds, key=lambda bound: bound.value, default=None)


_NO_DATE = "0000-00-00"
_End = TypeVar("_End", LowerBound, UpperBound)


def _dated(found: _End, kept: _End | None, version_of: Callable[[str], str], date: str) -> _End:
    """An end of a range with version and date: those that it had, if it has not changed."""
    if kept is not None and _claim(kept) == _claim(found):
        return replace(found, version=kept.version, date=kept.date)
    return replace(found, version=version_of(found.solver), date=date)


def _claim(end: LowerBound | UpperBound) -> tuple[int, str, str]:
    """What an end of a range says, and who found it."""
    return end.value, end.solver, end.kind if isinstance(end, LowerBound) else ""


def _numbers(graph: Instance) -> dict[str, int]:
    """What an entry counts of a graph."""
    return {
        "cells": len(graph.cells),
        "edges": len(graph.edges),
        "darts": graph.most_live_darts,
        "loops": graph.most_live_loops,
        "colors": len(graph.colors),
        "holes": sum(max(0, len(cell.loops) - 1) for cell in graph.cells),
    }


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
