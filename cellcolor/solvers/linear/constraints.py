"""A 0-1 linear model, as plain lists: what every file format and solver is given."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations

Literals = tuple[int, ...]
"""Variables, counted from 1; a negative number stands for the variable's negation."""


class Model:
    """Variables that are 0 or 1, and constraints on how many of some literals are true.

    With no other constraints than these three the model is at once a linear program over integers,
    a set of pseudo-Boolean constraints, and, by :meth:`clauses`, a formula in clauses.

    Attributes:
        names: of the variables, a word and numbers each; entry 0 is no variable.
        at_least_one: of these literals one or more is true: a clause.
        at_most_one: of these literals none or one is true.
        exactly_one: of these literals one is true.
        costs: variables of which as few as possible are to be true.
    """

    def __init__(self) -> None:
        self.names: list[tuple[str, *tuple[int, ...]]] = [("",)]
        self.at_least_one: list[Literals] = []
        self.at_most_one: list[Literals] = []
        self.exactly_one: list[Literals] = []
        self.costs: list[int] = []

    @property
    def variables(self) -> int:
        """How many there are."""
        return len(self.names) - 1

    def new(self, word: str, *numbers: int) -> int:
        """A new variable."""
        self.names.append((word, *numbers))
        return self.variables

    def some(self, *literals: int) -> None:
        """One of them at least is true."""
        self.at_least_one.append(literals)

    def one_at_most(self, literals: Iterable[int]) -> None:
        """One of them at most is true; says nothing of fewer than two."""
        found = tuple(literals)
        if len(found) > 1:
            self.at_most_one.append(found)

    def exactly(self, literals: Iterable[int]) -> None:
        """Just one of them is true."""
        self.exactly_one.append(tuple(literals))

    def rows(self) -> Iterator[tuple[str, Literals]]:
        """Every constraint as (``>=``, ``<=`` or ``=``, literals): so many are true as 1."""
        for sense, group in (
            (">=", self.at_least_one),
            ("<=", self.at_most_one),
            ("=", self.exactly_one),
        ):
            for literals in group:
                yield sense, literals

    def clauses(self) -> tuple[int, list[Literals]]:
        """The constraints as clauses, with further variables after the model's own.

        Returns:
            The number of all variables, and the clauses.
        """
        top = self.variables
        found = [*self.at_least_one, *self.exactly_one]
        for literals in (*self.at_most_one, *self.exactly_one):
            rest: Sequence[int] = literals
            # Three literals at a time are told from the rest by a new variable: false if one of
            # the three is true, true if one of the rest is.
            while len(rest) > 5:
                top += 1
                found += _pairs((*rest[:3], top))
                rest = (-top, *rest[3:])
            found += _pairs(rest)
        return top, found


def _pairs(literals: Sequence[int]) -> list[Literals]:
    return [(-a, -b) for a, b in combinations(literals, 2)]
