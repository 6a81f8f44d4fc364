"""Gecode and Chuffed on the MiniZinc model, run by the program ``minizinc``.

The model is ``models/constraints/coloring.mzn``; ``docs/models.md`` says what it has and why. It
shares nothing with the other solvers. Neither solver gives a bound before it has searched
everything, so there is a bound with the last solution or none.
"""

from __future__ import annotations

import math
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterable
from contextlib import suppress
from functools import cached_property
from pathlib import Path
from typing import ClassVar

from cellcolor.data.bounds import Bound
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, count_segments
from cellcolor.deadline import OutOfTime
from cellcolor.errors import CellcolorError, SolverMissing, TooLarge
from cellcolor.files.writing import shipped_folder
from cellcolor.processes import Child
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options
from cellcolor.solvers.joined_chains import division_of_chains, only_loops

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
    region = _regions(instance, loops)
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
            ("regions", len(set(region.values()))),
            ("region", f"array2d(1..{len(darts)}, 1..{colors}, {_array(region_of)})"),
            ("regions_of", _array(map(_set, of_cell))),
        )
    )


def _regions(instance: Instance, loops: list[tuple[int, ...]]) -> dict[tuple[int, int], int]:
    """Color regions by cell and color, numbered from 1; those of a single cell are left out."""
    number: dict[tuple[int, int], int] = {}
    for cell in instance.cells:
        for color in cell.colors:
            begin = (cell.id, color)
            if begin in number or not any(color in instance.joinable(d) for d in loops[cell.id]):
                continue
            name = len(set(number.values())) + 1
            number[begin] = name
            waiting = [cell.id]
            while waiting:
                for dart in loops[waiting.pop()]:
                    other = instance.across(dart), color
                    if color in instance.joinable(dart) and other not in number:
                        number[other] = name
                        waiting.append(other[0])
    return number


def _array(values: Iterable[object]) -> str:
    return f"[{', '.join(map(str, values))}]"


def _set(values: Iterable[int]) -> str:
    return f"{{{', '.join(map(str, sorted(values)))}}}"


MODEL = shipped_folder() / "models" / "constraints" / "coloring.mzn"
"""The model."""


class _MiniZinc:
    """A solver that MiniZinc knows by a tag."""

    abilities = Abilities()
    name: ClassVar[str]
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
        """The version of the solver."""
        return self._known or self.name

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """As the interface says; a CellcolorError if MiniZinc or the solver fails."""
        data = minizinc_data(instance)
        best: Division | None = None
        complete, failure = False, None
        color: dict[int, int] = {}
        after: dict[int, int] = {}
        # A moment is kept back for reading the answer.
        deadline = options.deadline.earlier(0.05 * min(options.deadline.left, 10.0))
        with tempfile.TemporaryDirectory(prefix="cellcolor-") as place, suppress(OutOfTime):
            file = Path(place) / "instance.dzn"
            file.write_text(data, encoding="ascii")
            command = ["minizinc", "--solver", self.name, "-a", "-r", str(options.seed)]
            if math.isfinite(deadline.left):
                # For the case that this process is killed; a second later than the deadline, since
                # MiniZinc ends with an error where its limit comes before it has begun to search.
                command += ["--time-limit", str(math.ceil(1000 * (deadline.left + 1.0)))]
            with Child([*command, *self.flags, str(MODEL), str(file)], Path(place)) as child:
                # A signal may stand for the end of the time: OutOfTime.
                for line in child.lines(deadline):
                    word, *numbers = line.split() or [""]
                    if word in ("joined", "link"):
                        into = color if word == "joined" else after
                        into[int(numbers[0])] = int(numbers[1])
                    elif word == "-" * 10:  # a division is complete, better than those before
                        best = division_of_chains(instance, color, after)
                        color, after = {}, {}
                        if progress is not None:
                            progress(count_segments(best), 0)
                    elif word == "=" * 10:
                        complete = True
                failure = child.failure
        if failure is not None and best is None:
            raise CellcolorError(f"{self.name}: {failure}")
        if best is None or not complete:
            return Answer(best, (), ())
        return Answer(best, (), (Bound("search", count_segments(best), "strands"),))


class GecodeSolver(_MiniZinc):
    """Gecode, a solver by propagation and search."""

    name = "gecode"
    how = "install MiniZinc with Gecode, for example: apt install minizinc fzn-gecode"


class ChuffedSolver(_MiniZinc):
    """Chuffed, which learns clauses. It may leave the model's search order (``-f``)."""

    name = "chuffed"
    how = "install the MiniZinc bundle (https://www.minizinc.org), which has Chuffed"
    flags = ("-f",)
