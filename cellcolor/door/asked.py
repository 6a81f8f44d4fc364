"""Options that several functions of the front door take as keywords, stated once."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, TypedDict

from cellcolor.deadline import Deadline, TimeLimit
from cellcolor.door.leaving_out import Wanted
from cellcolor.questions.places import Place
from cellcolor.solvers.interface import Options


class Search(TypedDict, total=False):
    """How long is searched, and how.

    Attributes:
        time_limit: seconds for all of it, None or left out for as long as it takes.
        workers: CP-SAT's search workers, None or left out for its portfolio.
        seed: for all random choices, 0 if it is left out.
    """

    time_limit: TimeLimit
    workers: int | None
    seed: int


class SearchOfAPart(Search, total=False):
    """The same, with what has to be covered: the attributes of
    :class:`~cellcolor.door.leaving_out.Wanted`; without any of them it is everything."""

    cover: float | None
    required: Place | None
    left_alone: Place | None
    uncovered_price: float | None


def options_of(given: Search, kind: type[Search] = Search) -> Options:
    """The options of a search in the search space ``paper``.

    Raises:
        TypeError: a keyword is none of the kind.
        InputError: an option is out of its range.
    """
    for name in given:
        if name not in kind.__annotations__:
            raise TypeError(f"got an unexpected keyword argument {name!r}")
    workers, seed = given.get("workers"), given.get("seed", 0)
    return Options(deadline=Deadline.of(given.get("time_limit")), workers=workers, seed=seed)


def wanted_of(given: SearchOfAPart) -> Wanted:
    """What has to be covered.

    Raises:
        InputError: as of :class:`~cellcolor.door.leaving_out.Wanted`.
    """
    known = {field.name for field in fields(Wanted)}
    members: dict[str, Any] = {name: own for name, own in given.items() if name in known}
    return Wanted(**members)
