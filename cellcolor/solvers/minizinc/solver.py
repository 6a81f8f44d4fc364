"""Gecode and Chuffed on the MiniZinc model, run by the program ``minizinc``.

Both say nothing of a bound before they have searched everything, so there is a bound with the last
solution or none.
"""

from __future__ import annotations

import math
import re
import shutil
import subprocess
import tempfile
from contextlib import suppress
from functools import cached_property
from pathlib import Path
from typing import ClassVar

from cellcolor.data.bound import Bound
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, count_segments
from cellcolor.deadline import OutOfTime
from cellcolor.errors import CellcolorError, SolverMissing
from cellcolor.files.shipped import shipped_folder
from cellcolor.solvers.child import Child
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options
from cellcolor.solvers.joined_chains import division_of_chains
from cellcolor.solvers.minizinc.data import minizinc_data

MODEL = shipped_folder() / "models" / "constraints" / "coloring.mzn"
"""The model."""


class _MiniZinc:
    """A solver that MiniZinc knows by a tag."""

    abilities = Abilities()
    name: ClassVar[str]
    how: ClassVar[str]
    flags: ClassVar[tuple[str, ...]] = ()

    def __init__(self) -> None:
        """Check that MiniZinc is there and knows the solver.

        Raises:
            SolverMissing: it is not, or does not.
        """
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
        """Of the solver."""
        return self._known or self.name

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """A division with the fewest segments, or the best found before the deadline.

        Raises:
            InputError: a cell has several loops with live darts.
            TooLarge: the model would have too many constraints.
            CellcolorError: MiniZinc or the solver failed.
        """
        data = minizinc_data(instance)
        heard = _Heard(instance)
        failure = None
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
                    if heard.take(line) and progress is not None:
                        progress(count_segments(heard.best or ()), 0)
                failure = child.failure
        if failure is not None and heard.best is None:
            raise CellcolorError(f"{self.name}: {failure}")
        if heard.best is None or not heard.done:
            return Answer(heard.best, (), ())
        bound = Bound("search", count_segments(heard.best), "strands")
        return Answer(heard.best, (), (bound,))


class _Heard:
    """What MiniZinc has printed so far.

    Attributes:
        best: the last division; each is better than the one before.
        done: there is no better one.
    """

    def __init__(self, instance: Instance) -> None:
        self.best: Division | None = None
        self.done = False
        self._instance = instance
        self._color: dict[int, int] = {}
        self._after: dict[int, int] = {}

    def take(self, line: str) -> bool:
        """Read a line; True if a division is complete with it."""
        word, *numbers = line.split() or [""]
        if word in ("joined", "link"):
            into = self._color if word == "joined" else self._after
            into[int(numbers[0])] = int(numbers[1])
        self.done |= line == "=" * 10
        if line != "-" * 10:
            return False
        self.best = division_of_chains(self._instance, self._color, self._after)
        self._color, self._after = {}, {}
        return True


class GecodeSolver(_MiniZinc):
    """Gecode, a solver by propagation and search."""

    name = "gecode"
    how = "install MiniZinc with Gecode, for example: apt install minizinc fzn-gecode"


class ChuffedSolver(_MiniZinc):
    """Chuffed, which learns clauses. It may leave the model's search order (``-f``)."""

    name = "chuffed"
    how = "install the MiniZinc bundle (https://www.minizinc.org), which has Chuffed"
    flags = ("-f",)
