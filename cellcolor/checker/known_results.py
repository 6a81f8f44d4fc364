"""What an instance says is known, against what was found."""

from __future__ import annotations

from cellcolor.data.instance import Instance, KnownResult
from cellcolor.data.solution import Solution


def contradictions(instance: Instance, solution: Solution) -> list[str]:
    """Where a solution that the checker has passed and ``known`` cannot both be right.

    Args:
        instance: the topological graph, with results known from elsewhere or without.
        solution: a valid solution of it, in either search space.
    """
    known = instance.known
    if known is None:
        return []
    found = []
    if known.surface is not None:
        # Every division is one of the surface; bounds for fewer of them say nothing of all.
        found += _minimum("surface", known.surface, solution.segments, solution.surface_lower_bound)
    if known.paper is not None:
        paper = solution.search_space == "paper"
        bound = solution.lower_bound if paper else solution.surface_lower_bound
        segments = solution.segments if paper else None
        found += _minimum("paper", known.paper, segments, bound)
        found += _schemes(known.paper, solution)
    return found


def _minimum(space: str, known: KnownResult, segments: int | None, bound: int) -> list[str]:
    where = f"known.{space}.segments: {known.segments} are claimed to be the fewest"
    if segments is not None and segments < known.segments:
        return [f"{where}, the division found has {segments}"]
    if bound > known.segments:
        return [f"{where}, the lower bound found is {bound}"]
    return []


def _schemes(known: KnownResult, solution: Solution) -> list[str]:
    if known.schemes is None or not solution.schemes or solution.segments != known.segments:
        return []
    wrong = solution.schemes > known.schemes
    if solution.complete:
        wrong = solution.schemes != known.schemes
    if not wrong:
        return []
    return [
        f"known.paper.schemes: {known.schemes} are said to be all, {solution.schemes} are found"
    ]
