"""A solution of the 0-1 model: whether it is one, and the division that it describes."""

from __future__ import annotations

from collections.abc import Collection

from cellcolor.errors import InputError
from cellcolor.solvers.linear.coloring import Coloring


def require_solution(coloring: Coloring, true: Collection[int]) -> None:
    """Refuse values that break a constraint of the model.

    Args:
        coloring: the model of an instance.
        true: the variables that are 1; those above the model's own are left alone.

    Raises:
        InputError: a constraint does not hold; the first is identified by its variables.
    """
    model = coloring.model
    for sense, literals in model.rows():
        count = sum((literal > 0) == (abs(literal) in true) for literal in literals)
        if (count > 1 and sense != ">=") or (count < 1 and sense != "<="):
            names = ", ".join(
                f"{'not ' if literal < 0 else ''}{' '.join(map(str, model.names[abs(literal)]))}"
                for literal in literals[:4]
            )
            more = ", …" if len(literals) > 4 else ""
            message = (
                f"is not a solution of the model: of ({names}{more}) {count} hold, not {sense} 1"
            )
            raise InputError(None, None, message)


def joined_and_linked(
    coloring: Coloring, true: Collection[int]
) -> tuple[dict[int, int], dict[int, int]]:
    """The color of each edge that is joined, and the dart that follows each linked dart."""
    color = {edge: c for (edge, c), variable in coloring.joined.items() if variable in true}
    after = {dart: d for (dart, d), variable in coloring.link.items() if variable in true}
    return color, after
