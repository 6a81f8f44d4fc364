"""Gecode and Chuffed on the MiniZinc model, run by the program ``minizinc``.

The model is ``models/constraints/coloring.mzn``; ``docs/models.md`` says what it has and why. It
shares nothing but the color regions with other solvers. Neither solver gives a bound before it has
searched everything, so there is a bound with the last solution or none.
"""

from __future__ import annotations

import math
import re
import shutil
import subprocess
from collections.abc import Iterable
from functools import cached_property
from pathlib import Path
from typing import ClassVar

from cellcolor.data.instance import Instance
from cellcolor.errors import SolverMissing, TooLarge
from cellcolor.files.writing import shipped_folder
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.joined_chains import division_of_chains, only_loops
from cellcolor.solvers.peers import PeerSearch, ProgramPeer, Started

_MOST_PAIRS = 30_000
"""The most pairs of darts of one cell: the model has a constraint for each, and MiniZinc takes a
second and 10 MB to write down some thousand of them."""


def minizinc_data(instance: Instance) -> str:
    """The parameters of the model, which says what each of them is; one a line.

    Cells, darts and colors are counted from 1.

    Raises:
        InputError: a cell has several loops with live darts, which the model cannot divide.
        TooLarge: the cells have so many live darts that MiniZinc would not be done with it in time.
    """
    loops = only_loops(instance)
    pairs = sum(len(loop) * (len(loop) - 1) // 2 for loop in loops)
    if pairs > _MOST_PAIRS:
        raise TooLarge(f"{pairs} pairs of darts are too many for the MiniZinc model")
    darts = [dart for loop in loops for dart in loop]
    number = {dart: place for place, dart in enumerate(darts, start=1)}
    regions = [
        [(cell, color) for cell in cells]
        for color, cells in color_regions(instance)
        if any(color in instance.joinable(dart) for cell in cells for dart in loops[cell])
    ]
    region = {own: number for number, all_ in enumerate(regions, start=1) for own in all_}
    colors = len(instance.colors)
    cell_of = {dart: cell for cell, loop in enumerate(loops) for dart in loop}
    first = [1 + sum(map(len, loops[:cell])) for cell in range(len(loops))]
    region_of = [
        region[cell_of[dart], color] if color in instance.joinable(dart) else 0
        for dart in darts
        for color in range(colors)
    ]
    of_cell = [
        {region[cell.id, color] for color in cell.colors if (cell.id, color) in region}
        for cell in instance.cells
    ]
    return "".join(
        f"{name} = {value};\n"
        for name, value in (
            ("cells", len(loops)),
            ("colors", colors),
            ("darts", len(darts)),
            ("first", _array(first)),
            ("last", _array(at + len(loop) - 1 for at, loop in zip(first, loops, strict=True))),
            ("twin", _array(number[-dart] for dart in darts)),
            ("joinable", _array(_set(c + 1 for c in instance.joinable(dart)) for dart in darts)),
            ("id", _array(darts)),
            ("regions", len(regions)),
            ("region", f"array2d(1..{len(darts)}, 1..{colors}, {_array(region_of)})"),
            ("regions_of", _array(map(_set, of_cell))),
        )
    )


def _array(values: Iterable[object]) -> str:
    return f"[{', '.join(map(str, values))}]"


def _set(values: Iterable[int]) -> str:
    return f"{{{', '.join(map(str, sorted(values)))}}}"


MODEL = shipped_folder() / "models" / "constraints" / "coloring.mzn"
"""The model."""


class _MiniZinc(ProgramPeer):
    """A solver that MiniZinc knows by a tag."""

    how: ClassVar[str]
    flags: ClassVar[tuple[str, ...]] = ()

    def __init__(self) -> None:
        if shutil.which("minizinc") is None or self._known is None:
            raise SolverMissing(self.name, self.how)

    @cached_property
    def _known(self) -> str | None:
        """What MiniZinc calls the solver, with its version."""
        command = ["minizinc", "--solvers"]
        said = subprocess.run(command, capture_output=True, text=True, check=False).stdout
        found = re.search(rf"^\s+(\S+ \S+) \(org\.\w+\.{self.name}\b", said, re.MULTILINE | re.I)
        return found[1] if found else None

    @property
    def version(self) -> str:
        return self._known or self.name

    def begin(self, search: PeerSearch, folder: Path) -> Started:
        file = folder / "instance.dzn"
        file.write_text(minizinc_data(search.instance), encoding="ascii")
        color: dict[int, int] = {}
        after: dict[int, int] = {}

        def hear(line: str) -> None:
            word, *numbers = line.split() or [""]
            if word in ("joined", "link"):
                into = color if word == "joined" else after
                into[int(numbers[0])] = int(numbers[1])
            elif word == "-" * 10:  # a division is complete
                search.found(division_of_chains(search.instance, color, after))
                color.clear()
                after.clear()
            elif word == "=" * 10:
                search.done()

        command: list[str | Path] = ["minizinc", "--solver", self.name, "-a", *self.flags]
        command += ["-r", str(search.seed)]
        if math.isfinite(search.deadline.left):
            # For the case that this process is killed; a second later than the deadline, since
            # MiniZinc ends with an error where its limit comes before it has begun to search.
            command += ["--time-limit", str(math.ceil(1000 * (search.deadline.left + 1.0)))]
        return [*command, MODEL, file], hear


class GecodeSolver(_MiniZinc):
    """Gecode, a solver by propagation and search."""

    name, called = "gecode", "Gecode"
    how = "install MiniZinc with Gecode, for example: apt install minizinc fzn-gecode"


class ChuffedSolver(_MiniZinc):
    """Chuffed, which learns clauses. It may leave the model's search order (``-f``)."""

    name, called = "chuffed", "Chuffed"
    how = "install the MiniZinc bundle (https://www.minizinc.org), which has Chuffed"
    flags = ("-f",)
