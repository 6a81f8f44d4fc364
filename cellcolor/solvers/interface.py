"""What every solver takes and hands back."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Annotated, Protocol, cast, runtime_checkable

from annotated_types import Ge, Le

from cellcolor.data.bounds import Bound, greatest
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, ModelSize, Seam, SearchSpace
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.files.validation import settle

PORTFOLIO = 8
"""CP-SAT's workers unless asked for otherwise. Each searches in a way of its own, so that more
workers than cores are of use. One or two take turns in a few of these ways (``interruptible``)."""

STRANDS: dict[SearchSpace, int] = {"paper": 1, "surface": 2}
"""Strands per topological edge unless asked for otherwise. A strand is one of the parallel
corridors that may cross an edge. In ``paper`` no other number is allowed."""

OnProgress = Callable[[int | None, int], None]
"""Called with the segments of the best division so far (None: none yet) and the lower bound."""


@dataclass(frozen=True, slots=True)
class Start:
    """A legal division to start from, in the form of ``Solution.cells``, and its seams."""

    division: Division
    seams: tuple[Seam, ...]


@dataclass(frozen=True, slots=True)
class Options:
    """How to solve, validated.

    Attributes:
        search_space: ``paper``, or ``surface`` for any division of the physical surface.
        strands: per topological edge; if left out, as ``STRANDS`` has it for the search space.
        deadline: when everything has to end.
        workers: CP-SAT's search workers, None for ``PORTFOLIO``.
        seed: for everything that is random.
        start: a division to start from, for solvers that can do this.

    Raises:
        InputError: an option is out of its range, or strands are asked for in ``paper``.
    """

    search_space: SearchSpace = "paper"
    strands: Annotated[int, Ge(1)] = cast(int, None)  # None only until __post_init__
    deadline: Deadline = NEVER
    workers: Annotated[int, Ge(1), Le(1000)] | None = None
    seed: Annotated[int, Ge(0), Le(2**31 - 1)] = 0
    start: Start | None = None

    def __post_init__(self) -> None:
        if self.strands is None:
            object.__setattr__(self, "strands", STRANDS.get(self.search_space, 1))
        settle(self)  # checks the annotations above
        if self.search_space == "paper" and self.strands != STRANDS["paper"]:
            raise InputError(
                None, "strands", f"must be 1 in search space 'paper', is {self.strands}"
            )


@dataclass(frozen=True, slots=True)
class Answer:
    """A solver's own claim, before the checker has seen it.

    Attributes:
        division: the best division found, None when none was found.
        seams: those that its darts refer to.
        bounds: what was proved about the fewest segments, and how.
        notes: what was left out and why, a sentence each, such as a model too large to be built.
        model: how large the complete model of the problem is, if one was built and solved.
    """

    division: Division | None
    seams: tuple[Seam, ...]
    bounds: tuple[Bound, ...]
    notes: tuple[str, ...] = ()
    model: ModelSize | None = None

    @property
    def lower_bound(self) -> int:
        """No division in the search space has fewer segments."""
        return greatest(self.bounds, "strands")


@dataclass(frozen=True, slots=True)
class Abilities:
    """What a solver declares that it can do; it is asked for nothing else.

    A live loop is a border loop with edges that can be joined. Every solver divides cells with one
    live loop in the search space ``paper``. One that divides no others is given the strands of
    seams as edges (:mod:`cellcolor.solvers.seamed`).

    Attributes:
        several_loops: it divides cells with several live loops as well.
        optimal_schemes: it lists all optimal schemes, so it is a :class:`SchemeSolver`.
        schemes_of_several_loops: it does so even where cells have several live loops.
        start: it can start from a division (``Options.start``).
    """

    search_spaces: tuple[SearchSpace, ...] = ("paper",)
    several_loops: bool = False
    optimal_schemes: bool = False
    schemes_of_several_loops: bool = False
    start: bool = False


class Solver(Protocol):
    """One way to solve an instance.

    One that needs what is not installed raises :class:`~cellcolor.errors.SolverMissing` when it is
    made. It may have an attribute ``version``, a text such as ``OR-Tools 9.15``, for tables.
    """

    @property
    def abilities(self) -> Abilities:
        """What it can do."""

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """A division with the fewest segments, or the best found before the deadline.

        Raises:
            InputError: a cell has several live loops, and that is more than the solver can do.
            TooLarge: its model would take too much memory or time to be written.
        """


@runtime_checkable
class SchemeSolver(Solver, Protocol):
    """A solver that lists all optimal schemes."""

    def optimal_schemes(
        self, instance: Instance, options: Options, segments: int
    ) -> Iterator[Division]:
        """Every scheme (docs/semantics.md, section 3) with the fewest segments, each once.

        Args:
            segments: the fewest, which have been proved before.

        Raises:
            TooLarge: the search would not fit into memory.
        """
