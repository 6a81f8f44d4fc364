"""A solution's number and what is proved about it, in one sentence that claims no more."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

from cellcolor.data.bounds.kinds import kind_of
from cellcolor.data.wording import count, listed

if TYPE_CHECKING:
    from cellcolor.data.instance import Instance
    from cellcolor.data.solution import Solution


def in_words(solution: Solution, reason: str | None = None) -> str:
    """Segments, lift-offs and proof, like ``2 segments, 1 lift-off, optimal: proved for …``.

    Args:
        solution: a solver's answer.
        reason: why there cannot be fewer segments, a clause, where more is known of it than the
            solution's bounds say; only used if the number is proved for any division.
    """
    if solution.segments is None or solution.lift_offs is None:
        if solution.coverage is not None and solution.coverage.covered == 0:
            return "no division: no point of the surface can be covered"
        return f"no division found; at least {count(solution.lower_bound, 'segment')}"
    found = f"{count(solution.segments, 'segment')}, {count(solution.lift_offs, 'lift-off')}"
    if solution.proved_for_surface:
        reason = reason or reason_of(solution)
        because = "" if reason is None else f", because {reason}"
        return f"{found}, optimal: proved for any division of the surface{because}"
    everywhere = f"any division of the surface has at least {solution.surface_lower_bound}"
    if solution.status == "optimal":
        return f"{found}, optimal in the search space {solution.search_space}; {everywhere}"
    return (
        f"{found}, not proved to be the fewest: at least {solution.lower_bound} in the search "
        f"space {solution.search_space}; {everywhere}"
    )


def reason_of(solution: Solution) -> str | None:
    """Why no division of the surface has fewer segments, by the kind of its greatest bound.

    None where nothing needs a reason (a single segment) or none is given in the solution.
    """
    if not solution.proved_for_surface or (solution.segments or 0) < 2:
        return None
    for bound in solution.bounds or ():
        if bound.holds_for == "surface" and bound.value == solution.surface_lower_bound:
            return kind_of(bound).because or None
    return None


def witness_in_words(instance: Instance, cells: tuple[int, ...]) -> str | None:
    """What is to be seen at cells no two of which can share a segment, a clause.

    Args:
        instance: the topological graph.
        cells: as many as there are segments; with none there is nothing to be said.
    """
    if not cells:
        return None
    colors = (set(instance.cells[cell].colors) for cell in cells)
    disjoint = all(a.isdisjoint(b) for a, b in combinations(colors, 2))
    if len(cells) == 2:
        return f"cells {listed(cells)} " + (
            "share no color" if disjoint else "can share no segment"
        )
    shared = "share a color" if disjoint else "can be in one segment"
    return f"no two of the cells {listed(cells)} {shared}"
