"""The numbers of a solution: against its division, the instance, results known from elsewhere, and
each other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import astuple
from math import isclose

from cellcolor.checker.certificates import BoundVerdict
from cellcolor.checker.groups import Groups, regions_of_cells
from cellcolor.data.bounds import greatest
from cellcolor.data.instance import Coverage, Instance, KnownResult
from cellcolor.data.solution import Solution
from cellcolor.data.wording import count


def number_problems(instance: Instance, solution: Solution, segments: int | None) -> list[str]:
    """What is wrong with a solution's numbers, each naming its member.

    Args:
        segments: of the division, which is legal; None without one.
    """
    problems = _bound_problems(instance, solution, segments)
    problems += _proof_problems(solution, segments)
    problems += _scheme_problems(instance, solution)
    if segments is not None:
        if solution.segments != segments:
            problems.append(f"segments: says {solution.segments}, the division has {segments}")
        if solution.lift_offs != max(0, segments - 1):
            problems.append(f"lift_offs: says {solution.lift_offs}, must be {max(0, segments - 1)}")
    own, said = instance.coverage, solution.coverage
    if own is not None and said is not None and not _agree(own, said):
        problems.append("coverage: is not that of the instance")
    return problems


def claims(
    instance: Instance, solution: Solution, verdicts: Sequence[BoundVerdict] = ()
) -> dict[str, object]:
    """The members of a valid solution that were not verified, with what they say.

    That there is one segment where there is a cell needs no proof.
    """
    verified = [verdict.bound for verdict in verdicts if verdict.outcome == "verified"]
    least = min(1, len(instance.cells))
    proved = max(least, greatest(verified, "strands"))
    found: dict[str, object] = {}
    for name in ("lower_bound", "surface_lower_bound"):
        value = getattr(solution, name)
        if value > proved:
            found[name] = value
    if solution.status == "optimal" and found:
        found["status"] = solution.status
    if solution.proved_for_surface and "surface_lower_bound" in found:
        found["proved_for_surface"] = True
    if solution.instance.of == "text":
        found["instance.sha256"] = solution.instance.sha256
    for name in ("cutting_paths", "cutting_paths_lower_bound"):
        if value := getattr(solution, name):
            found[name] = value
    if solution.schemes is not None:
        found |= {"schemes": solution.schemes, "complete": solution.complete}
    if solution.coverage is not None and instance.coverage is None:
        found["coverage"] = solution.coverage.to_document()
    return found


def _agree(one: Coverage, other: Coverage) -> bool:
    """Another processor may round the sums of areas in another way."""
    pairs = zip(astuple(one), astuple(other), strict=True)
    return all(isclose(a, b, rel_tol=1e-6, abs_tol=1e-9) for a, b in pairs)


def _bound_problems(instance: Instance, solution: Solution, segments: int | None) -> list[str]:
    """Bounds above a division that exists, or that contradict each other."""
    problems = []
    if segments is None:
        most, why = segments_of_whole_cells(instance), "whole cells can be painted in"
    else:
        most, why = segments, "found"
    lower, surface = solution.lower_bound, solution.surface_lower_bound
    for name, bound in (("lower_bound", lower), ("surface_lower_bound", surface)):
        if bound > most:
            problems.append(f"{name}: {bound} cannot be above the {count(most, 'segment')} {why}")
    if lower < surface:
        # Whatever the search space, its divisions are divisions of the surface.
        problems.append(f"lower_bound: {lower} cannot be below surface_lower_bound, {surface}")
    if solution.bounds is not None:
        for name, bound, best in (
            ("surface_lower_bound", surface, greatest(solution.bounds, "surface")),
            ("lower_bound", lower, greatest(solution.bounds, "strands")),
        ):
            if bound != best:
                problems.append(f"{name}: says {bound}, the greatest of bounds is {best}")
    return problems


def _proof_problems(solution: Solution, segments: int | None) -> list[str]:
    """Claims of a proof that the bounds do not bear out."""
    if segments is None:
        if solution.proved_for_surface:
            return ["proved_for_surface: must be false, since there is no division"]
        return []
    problems = []
    surface = solution.surface_lower_bound
    proved = segments == surface
    if solution.proved_for_surface != proved:
        since = f"surface_lower_bound is {surface} and the division has"
        must = f"proved_for_surface: must be {str(proved).lower()}"
        problems.append(f"{must}, since {since} {count(segments, 'segment')}")
    bound = solution.lower_bound if solution.search_space == "paper" else surface
    if solution.status == "optimal" and bound != segments:
        one = f"a division with {count(segments, 'segment')}"
        problems.append(f"status: {one} is not proved optimal by a lower bound of {bound}")
    return problems


def _scheme_problems(instance: Instance, solution: Solution) -> list[str]:
    """The number of optimal schemes; that it is right cannot be seen without listing them."""
    schemes, complete = solution.schemes, solution.complete
    if schemes is None and complete is None:
        return []
    if schemes is None or complete is None:
        return ["schemes: goes with complete"]
    problems = []
    if (schemes or complete) and (solution.search_space != "paper" or solution.strands != 1):
        problems.append("schemes: are defined in search space 'paper' only")
    if (schemes or complete) and solution.status != "optimal":
        problems.append(f"schemes: cannot be known to be optimal in a result {solution.status!r}")
    if complete and not schemes:
        problems.append("schemes: cannot be 0 and complete; some optimal division is a scheme")
    if not instance.cells and schemes > 1:
        problems.append(f"schemes: says {schemes}, an instance without cells has 1")
    return problems


def segments_of_whole_cells(instance: Instance) -> int:
    """The segments of a painting of undivided cells, each in the largest of its color regions.

    To paint every cell whole is legal in both search spaces, with any number of strands, and cells
    of one color are joined wherever they can be. So the fewest segments are at most these.
    """
    regions = regions_of_cells(instance)
    size = Counter(region for own in regions for region in own)
    painted = [max(own, key=lambda region: (size[region], region)) for own in regions]
    segments = Groups(range(len(painted)))
    for edge in instance.edges:
        for color in instance.joinable(edge.id):
            if painted[edge.left][0] == painted[edge.right][0] == color:
                segments.join(edge.left, edge.right)
    return len(segments.sets())


def contradictions(instance: Instance, solution: Solution) -> list[str]:
    """Where a solution that the checker has passed and ``known`` cannot both be right."""
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
    all_, found = known.schemes, solution.schemes
    if all_ is None or not found or solution.segments != known.segments:
        return []
    if found == all_ or (found < all_ and not solution.complete):
        return []
    return [f"known.paper.schemes: {all_} are said to be all, {found} are found"]
