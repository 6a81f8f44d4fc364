"""A solution's number and what is proved about it, in one sentence that claims no more."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Protocol

from cellcolor.data.wording import count, listed

if TYPE_CHECKING:
    from cellcolor.data.bound import Bound
    from cellcolor.data.coverage import Coverage
    from cellcolor.data.instance import Instance

__all__ = ["in_words", "reason_of", "witness_in_words"]

_REASONS = {
    "strangers": "that many cells cannot share a segment, no two of them",
    "cover": "fewer color regions cannot touch every cell",
    "conflicts": "fewer segments would have to cross each other",
    "hubs": "more connections do not fit side by side into cells with many edges",
    "crossings": "the full model has nothing better, and more strands would be of no use",
}
"""Why no division of the surface has fewer segments, for each kind of bound (docs/formats.md)."""


class _Answer(Protocol):
    """What of a :class:`~cellcolor.data.solution.Solution` is said in words."""

    @property
    def segments(self) -> int | None: ...
    @property
    def lift_offs(self) -> int | None: ...
    @property
    def status(self) -> str: ...
    @property
    def search_space(self) -> str: ...
    @property
    def lower_bound(self) -> int: ...
    @property
    def surface_lower_bound(self) -> int: ...
    @property
    def proved_for_surface(self) -> bool: ...
    @property
    def bounds(self) -> tuple[Bound, ...] | None: ...
    @property
    def coverage(self) -> Coverage | None: ...


def in_words(solution: _Answer, reason: str | None = None) -> str:
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


def reason_of(solution: _Answer) -> str | None:
    """Why no division of the surface has fewer segments, by the kind of its greatest bound.

    None where nothing needs a reason (a single segment) or none is given in the solution.
    """
    if not solution.proved_for_surface or (solution.segments or 0) < 2:
        return None
    for bound in solution.bounds or ():
        if bound.holds_for == "surface" and bound.value == solution.surface_lower_bound:
            return _REASONS.get(bound.kind)
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
