"""A 0-1 linear model as plain lists, and as text: OPB, WCNF and free MPS.

Variable n is ``xn`` in the text, in WCNF ``n``.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations

from cellcolor.data.solution import ModelSize

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
        costs: variables; as few of them as possible are to be true.
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

    @property
    def size(self) -> ModelSize:
        """How many variables and constraints there are."""
        groups = (self.at_least_one, self.at_most_one, self.exactly_one)
        return ModelSize(self.variables, sum(map(len, groups)))

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
        """Every constraint as (``>=``, ``<=`` or ``=``, literals); the right-hand side is 1."""
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


_SHOWN = ("joined", "link")
"""The variables that a solution is read off, which comments explain."""


def opb(model: Model, title: str) -> Iterator[str]:
    """Lines of the format of the pseudo-Boolean competitions (linear, small integers).

    Literals are written without negation: ``1 - x`` instead of the negation of ``x``.
    """
    rows = [(_signed(literals), sense) for sense, literals in model.rows()]
    yield f"* #variable= {model.variables} #constraint= {len(rows)}"
    yield from _comments(model, title, "*")
    yield "min: " + " ".join(f"+1 x{variable}" for variable in model.costs) + " ;"
    for (terms, ones), sense in rows:
        flip = -1 if sense == "<=" else 1  # the format has no <=
        left = " ".join(f"{flip * factor:+d} x{variable}" for factor, variable in terms)
        yield f"{left} {'=' if sense == '=' else '>='} {flip * ones} ;"


def wcnf(model: Model, title: str) -> Iterator[str]:
    """Lines of the format of the MaxSAT evaluations since 2022: ``h`` marks hard clauses."""
    yield from _comments(model, title, "c")
    for clause in model.clauses()[1]:
        yield f"h {' '.join(map(str, clause))} 0"
    for variable in model.costs:
        yield f"1 -{variable} 0"


def mps(model: Model, title: str) -> Iterator[str]:
    """Lines of free MPS, a binary variable a column; minimized, as is the default."""
    yield from _comments(model, title, "*")
    yield "NAME segments"
    yield "ROWS"
    yield " N segments"
    column: dict[int, list[tuple[int, int]]] = defaultdict(list)
    right = []
    for number, (sense, literals) in enumerate(model.rows(), start=1):
        yield f" {({'>=': 'G', '<=': 'L', '=': 'E'})[sense]} r{number}"
        terms, ones = _signed(literals)
        right.append(ones)
        for factor, variable in terms:
            column[variable].append((number, factor))
    yield "COLUMNS"
    yield " MARK0 'MARKER' 'INTORG'"
    costs = frozenset(model.costs)
    for variable in range(1, model.variables + 1):
        yield f" x{variable} segments {int(variable in costs)}"
        for number, factor in column[variable]:
            yield f" x{variable} r{number} {factor}"
    yield " MARK1 'MARKER' 'INTEND'"
    yield "RHS"
    for number, ones in enumerate(right, start=1):
        if ones:
            yield f" RHS r{number} {ones}"
    yield "BOUNDS"
    for variable in range(1, model.variables + 1):
        yield f" BV BND x{variable}"
    yield "ENDATA"


def _comments(model: Model, title: str, mark: str) -> Iterator[str]:
    yield f"{mark} cellcolor: {title}"
    for variable, (word, *numbers) in enumerate(model.names):
        if word in _SHOWN:
            yield f"{mark} x{variable} = {word} {' '.join(map(str, numbers))}"


def _signed(literals: Literals) -> tuple[list[tuple[int, int]], int]:
    """How many literals are true as a sum of (factor, variable); and what it is instead of 1."""
    terms = [(1 if literal > 0 else -1, abs(literal)) for literal in literals]
    return terms, 1 - sum(literal < 0 for literal in literals)
