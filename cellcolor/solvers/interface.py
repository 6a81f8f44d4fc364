"""What every solver takes and hands back."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Annotated, Protocol, cast, runtime_checkable

from annotated_types import Ge, Le

from cellcolor.data.bound import Bound, greatest
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Seam, SearchSpace
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.files.validation import settle

PORTFOLIO = 8
"""CP-SAT's workers unless asked for otherwise: different searches, useful beyond the cores."""

STRANDS: dict[SearchSpace, int] = {"paper": 1, "surface": 2}
"""Strands per topological edge unless asked for otherwise; in ``paper`` there is no other."""

OnProgress = Callable[[int | None, int], None]
"""Called with the segments of the best division so far (None: none yet) and the lower bound."""


@dataclass(frozen=True, slots=True)
class Start:
    """A legal division to start from.

    Attributes:
        division: as a solution has it.
        seams: the seams that its darts refer to.
    """

    division: Division
    seams: tuple[Seam, ...]


@dataclass(frozen=True, slots=True)
class Options:
    """How to solve, validated.

    Attributes:
        search_space: ``paper``, or ``surface`` for any division of the physical surface.
        strands: strands per topological edge, at least 1; left out, what ``STRANDS`` has for the
            search space.
        deadline: when everything has to end.
        workers: CP-SAT's search workers, at most 1000, None for ``PORTFOLIO``.
        seed: of everything random.
        start: a division to start from, for solvers that are able to.
        fewest_cuts: of the divisions with the fewest segments find one with the fewest cutting
            paths, for solvers that are able to.

    Raises:
        InputError: an option is out of its range, or strands are asked for in ``paper``.
    """

    search_space: SearchSpace = "paper"
    strands: Annotated[int, Ge(1)] = cast(int, None)  # until __post_init__
    deadline: Deadline = NEVER
    workers: Annotated[int, Ge(1), Le(1000)] | None = None
    seed: Annotated[int, Ge(0), Le(2**31 - 1)] = 0
    start: Start | None = None
    fewest_cuts: bool = False

    def __post_init__(self) -> None:
        if self.strands is None:
            object.__setattr__(self, "strands", STRANDS.get(self.search_space, 1))
        settle(self)
        if self.search_space == "paper" and self.strands != STRANDS["paper"]:
            raise InputError(
                None, "strands", f"must be 1 in search space 'paper', is {self.strands}"
            )


@dataclass(frozen=True, slots=True)
class Answer:
    """A solver's own claim, before the checker has seen it.

    Attributes:
        division: the best division found, None when none was found.
        seams: the seams that its darts refer to.
        bounds: what was proved about the fewest segments, and how.
        cutting_paths_lower_bound: no division in the search space with the fewest segments has
            fewer cutting paths; None when that was not asked for.
        notes: what was left out and why, a sentence each, such as a model too large to be built.
    """

    division: Division | None
    seams: tuple[Seam, ...]
    bounds: tuple[Bound, ...]
    cutting_paths_lower_bound: int | None = None
    notes: tuple[str, ...] = ()

    @property
    def lower_bound(self) -> int:
        """No division in the search space has fewer segments."""
        return greatest(self.bounds, "strands")


@dataclass(frozen=True, slots=True)
class Abilities:
    """What a solver declares that it can do; it is asked for nothing else.

    The least that every solver does is to divide cells with one live loop (one border loop with
    edges that can be joined) in the search space ``paper``.

    Attributes:
        search_spaces: what it can search.
        several_loops: divides cells with several live loops as well.
        optimal_schemes: lists all optimal schemes: it is a :class:`SchemeSolver`.
        schemes_of_several_loops: does so even where cells have several live loops.
        start: can start from a division (``Options.start``).
        fewest_cuts: can look for the fewest cutting paths (``Options.fewest_cuts``).
    """

    search_spaces: tuple[SearchSpace, ...] = ("paper",)
    several_loops: bool = False
    optimal_schemes: bool = False
    schemes_of_several_loops: bool = False
    start: bool = False
    fewest_cuts: bool = False


class Solver(Protocol):
    """One way to solve an instance."""

    @property
    def abilities(self) -> Abilities:
        """What it can do."""

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """A division with the fewest segments, or the best found before the deadline."""


@runtime_checkable
class SchemeSolver(Solver, Protocol):
    """A solver that lists all optimal schemes."""

    def optimal_schemes(
        self, instance: Instance, options: Options, segments: int
    ) -> Iterator[Division]:
        """Every scheme (semantics: docs/semantics.md, section 3) with the given minimum, once.

        Raises:
            OutOfTime: the deadline came first.
            TooLarge: the search would not fit into memory.
        """
