"""Options that several functions of the front door take as keywords, stated once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypedDict

from cellcolor.deadline import Deadline, TimeLimit
from cellcolor.questions.places import Place
from cellcolor.solvers.interface import Options

Telling = Callable[[str], None]


class Work(TypedDict, total=False):
    """How long something may take, and who hears of it.

    Attributes:
        time_limit: seconds for all of it, None or left out for as long as it takes.
        progress: told what is being done.
    """

    time_limit: TimeLimit
    progress: Telling | None


class Search(TypedDict, total=False):
    """How long is searched, and how.

    Attributes:
        time_limit: seconds for all of it, None or left out for as long as it takes.
        workers: CP-SAT's search workers, None for its portfolio.
        seed: for all random choices, 0 if it is left out.
    """

    time_limit: TimeLimit
    workers: int | None
    seed: int


class SearchAndTell(Search, total=False):
    """The same, with ``progress``: told what is being done."""

    progress: Telling | None


class SearchOfAPart(Search, total=False):
    """The same, with what has to be covered, everything if it is left out.

    Attributes:
        cover: the share of the area that can be covered and is not left alone which has to be, 0
            to 1. What is best left out is settled first, as by ``tradeoff``.
        left_alone: vertices that must not be covered: a mask (n,), a
            :class:`~cellcolor.questions.places.WorldBox`, or what a labelled surface gives up.
    """

    cover: float | None
    left_alone: Place | None


def begun(given: Work) -> tuple[Deadline, Telling]:
    """When some work has to end, and whom to tell of it.

    Raises:
        TypeError: a keyword is none of these.
        InputError: the time limit is no positive number of seconds.
    """
    _check_names(given, Work)
    return Deadline.of(given.get("time_limit")), given.get("progress") or (lambda _: None)


def options_of(given: Search, kind: type[Search] = SearchAndTell) -> Options:
    """The options of a search in the search space ``paper``.

    Raises:
        TypeError: a keyword is none of the kind.
        InputError: an option is out of its range.
    """
    _check_names(given, kind)
    workers, seed = given.get("workers"), given.get("seed", 0)
    return Options(deadline=Deadline.of(given.get("time_limit")), workers=workers, seed=seed)


def _check_names(given: Mapping[str, Any], kind: type) -> None:
    for name in given:
        if name not in kind.__annotations__:
            raise TypeError(f"got an unexpected keyword argument {name!r}")
