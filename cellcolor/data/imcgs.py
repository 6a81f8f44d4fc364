"""Graphs in the text format of IMCGS, the solver that the paper's authors published.

docs/formats/other-programs.md describes the format. A file has a cyclic list of edges for each
cell, and the two cells beside each edge. These two statements have to agree.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from os import PathLike
from typing import NamedTuple

from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.wording import count, listed
from cellcolor.errors import InputError, naming
from cellcolor.files.documents import read_text
from cellcolor.files.writing import path_of

_NUMBER = re.compile(r"[+-]?[0-9]{1,9}")
_CORRECTION = re.compile(r"([0-9]{1,9})=(-1|[0-9]{1,9}),(-1|[0-9]{1,9})")

Sides = tuple[int, int]


class _Line(NamedTuple):
    """The numbers in one line of the file, and its own number, from 1."""

    number: int
    values: tuple[int, ...]

    def wrong(self, message: str) -> InputError:
        """An error about this line."""
        return InputError(None, f"line {self.number}", message)


def parse_correction(text: str) -> tuple[int, Sides]:
    """Parse a correction: ``16=-1,0`` says that edge 16 lies between the outside and cell 0.

    Raises:
        InputError: it is not written like that.
    """
    found = _CORRECTION.fullmatch(text)
    if found is None:
        raise InputError(None, "correct", f"must be written like 16=-1,0, is {text!r}")
    return int(found[1]), (int(found[2]), int(found[3]))


def read_imcgs(
    path: str | PathLike[str], corrections: Sequence[str] = (), name: str | None = None
) -> Instance:
    """Read an instance.

    Edges keep their order: edge 0 of the file is edge 1 of the instance. Color 3 of the file is
    named ``c3``.

    Args:
        corrections: replacements for wrong lines about edges, see :func:`parse_correction`. They
            are recorded in ``meta``.
        name: of the instance; None for the name of the file without its suffix.

    Raises:
        InputError: the file cannot be read, has another format, or contradicts itself; names file
            and line.
    """
    corrected = dict(map(parse_correction, corrections))
    text = read_text(path)
    with naming(path):
        cells, edges, colors = _parsed(text, corrected)
    meta = {"made_by": f"cellcolor import {path_of(path).name}"}
    if corrections:
        meta["made_by"] += "".join(f" --correct {correction}" for correction in corrections)
    return Instance(path_of(path).stem if name is None else name, colors, cells, edges, meta)


def _parsed(
    text: str, corrections: Mapping[int, Sides]
) -> tuple[tuple[Cell, ...], tuple[Edge, ...], tuple[str, ...]]:
    """Cells, edges and the names of the colors."""
    lines = list(_lines(text))
    if not lines or len(lines[0].values) != 2 or min(lines[0].values) < 0:
        raise InputError(None, "line 1", "must have two numbers: of cells and of edges")
    cell_count, edge_count = lines[0].values
    wanted = 1 + 2 * cell_count + edge_count
    if len(lines) != wanted:
        raise InputError(
            None,
            f"line {lines[-1].number}",
            f"is the last of {count(len(lines), 'line')} with numbers, but {cell_count} cells with "
            f"two lines each and {edge_count} edges with one make {wanted} with the first",
        )
    loops, colors = lines[1 : 1 + 2 * cell_count : 2], lines[2 : 1 + 2 * cell_count : 2]
    sides = _sides(lines[1 + 2 * cell_count :], corrections, cell_count)
    holders, darts = _walked(loops, edge_count)
    for edge, (line, beside) in enumerate(sides):
        if sorted(holders[edge]) != sorted(cell for cell in beside if cell != OUTSIDE):
            raise line.wrong(
                f"edge {edge} lies between {beside[0]} and {beside[1]} here, "
                f"but in the lists of cells: {listed(holders[edge])}"
            )
    for line in colors:
        if len(set(line.values)) < len(line.values) or min(line.values) < 0:
            raise line.wrong("colors must be different numbers from 0 on")
    names = sorted({color for line in colors for color in line.values})
    cells = tuple(
        Cell(cell, tuple(names.index(name) for name in line.values), (tuple(darts[cell]),))
        for cell, line in enumerate(colors)
    )
    edges = tuple(
        Edge(edge + 1, holders[edge][0], (*holders[edge], OUTSIDE)[1]) for edge in range(edge_count)
    )
    return cells, edges, tuple(f"c{name}" for name in names)


def _lines(text: str) -> Iterable[_Line]:
    """The non-empty lines."""
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.split()
        for word in words:
            if not _NUMBER.fullmatch(word):
                raise InputError(None, f"line {number}", f"{word[:40]!r} is not a whole number")
        if words:
            yield _Line(number, tuple(map(int, words)))


def _sides(
    lines: Sequence[_Line], corrections: Mapping[int, Sides], cell_count: int
) -> list[tuple[_Line, Sides]]:
    """The line of each edge and the two cells beside it, corrected."""
    for edge in corrections:
        if edge >= len(lines):
            raise InputError(None, "correct", f"there is no edge {edge}")
    found: list[tuple[_Line, Sides]] = []
    for edge, line in enumerate(lines):
        values = corrections.get(edge, line.values)
        if len(values) != 2:
            raise line.wrong(f"must have the two cells beside edge {edge}")
        for cell in values:
            if not OUTSIDE <= cell < cell_count:
                raise line.wrong(f"edge {edge} lies beside cell {cell}, which does not exist")
        if values == (OUTSIDE, OUTSIDE):
            raise line.wrong(f"edge {edge} has the outside (-1) on both sides")
        found.append((line, (values[0], values[1])))
    return found


def _walked(loops: Sequence[_Line], edge_count: int) -> tuple[list[list[int]], list[list[int]]]:
    """For each edge the cells whose lists contain it, in their order; and the darts of each cell.

    Where an edge appears first in the lists is its left side, then its right.
    """
    holders: list[list[int]] = [[] for _ in range(edge_count)]
    darts: list[list[int]] = [[] for _ in loops]
    for cell, line in enumerate(loops):
        for edge in line.values:
            if not 0 <= edge < edge_count:
                raise line.wrong(f"cell {cell} has an edge {edge}, which does not exist")
            holders[edge].append(cell)
            darts[cell].append(edge + 1 if len(holders[edge]) == 1 else -edge - 1)
    return holders, darts
