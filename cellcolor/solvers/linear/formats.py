"""A 0-1 linear model as text: OPB, WCNF and free MPS. Variable n is ``xn``, in WCNF ``n``."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from cellcolor.solvers.linear.constraints import Literals, Model

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
