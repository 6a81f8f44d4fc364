"""One instance, every solver: what they agree on, or that they do not.

On meshes the solvers are also compared with a search over the colorings of the vertices, which
never sees the graph.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import islice
from typing import TypeVar

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, SchemeKey, SearchSpace, scheme_key
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import Disagreement, TooLarge
from cellcolor.solvers.checked import enumerate_schemes, solve
from cellcolor.solvers.interface import Options
from cellcolor.solvers.registry import DEFAULT, REFERENCE

CONTENDERS = (DEFAULT, REFERENCE, "cp-sat-model")
"""Whose minima are compared: also the full CP-SAT model without plans, which settle most instances
before it is built."""

MOST_SCHEMES = 3000
"""Sets of optimal schemes that are larger are not compared."""

MOST_STATES = 6_000
"""Partial colorings of a mesh that the search over vertices keeps at a time."""

_STRANDS = (2, 4)
"""Corridors that the solver may lead across an edge, tried in turn. A coloring of the vertices may
need several, so it contradicts the solver only if it has fewer segments than with the most of
them."""


@dataclass(frozen=True, slots=True)
class Finding:
    """What the solvers agree on.

    Attributes:
        minimum: segments in the search space ``paper``; None when some solver did not prove it.
        schemes: how many optimal schemes there are; None when their sets were not compared.
        always_cut: whether every one of them has a cutting path; None like ``schemes``.
    """

    minimum: int | None
    schemes: int | None
    always_cut: bool | None


@dataclass(frozen=True, slots=True)
class MeshFinding:
    """What a search over the vertices of the mesh says about the search space ``surface``."""

    by_vertices: int  # the fewest segments over all colorings of the vertices
    segments: int  # of the best division of the surface


def compare_solvers(instance: Instance, time_limit: float) -> Finding:
    """Every solver's minimum and, where it is defined, set of optimal schemes.

    Each solve and each set of schemes has ``time_limit`` seconds.

    Raises:
        Disagreement: they do not agree.
    """
    solutions = [solve(instance, _options("paper", 1, time_limit), name) for name in CONTENDERS]
    for one in solutions:
        for other in solutions:
            if one.segments is not None and one.segments < other.lower_bound:
                raise Disagreement(
                    f"{one.solver} has {one.segments} segments, "
                    f"{other.solver} a lower bound of {other.lower_bound}"
                )
    if any(solution.status != "optimal" for solution in solutions):
        return Finding(None, None, None)
    minimum = solutions[0].segments
    assert minimum is not None
    if instance.most_live_loops > 1:
        return Finding(minimum, None, None)
    found: list[dict[SchemeKey, Division]] = []
    for name in (DEFAULT, REFERENCE):
        schemes = _schemes(instance, name, minimum, time_limit)
        if schemes is None:
            return Finding(minimum, None, None)
        found.append(schemes)
    first, second = found
    if first.keys() != second.keys():
        raise Disagreement(
            f"{DEFAULT} lists {len(first.keys() - second.keys())} optimal schemes that "
            f"{REFERENCE} does not, {REFERENCE} {len(second.keys() - first.keys())} that "
            f"{DEFAULT} does not"
        )
    cut = all(any(len(cell.subcells) > 1 for cell in division) for division in first.values())
    return Finding(minimum, len(first), cut)


def compare_on_mesh(
    surface: LabelledSurface, instance: Instance, time_limit: float
) -> MeshFinding | None:
    """CP-SAT in the search space ``surface`` against all colorings of a small mesh's vertices.

    None when the mesh is too large for a search over vertices, or the seconds for a solve ran out.

    Raises:
        Disagreement: a coloring has fewer segments than a lower bound for the surface, or fewer
            than any division with 4 corridors across each edge.
    """
    by_vertices = fewest_by_vertices(surface, MOST_STATES)
    if by_vertices is None:
        return None
    for strands in _STRANDS:
        solution = solve(instance, _options("surface", strands, time_limit), "cp-sat")
        if by_vertices < solution.surface_lower_bound:
            raise Disagreement(
                f"a coloring of the vertices has {by_vertices} segments, cp-sat a lower bound "
                f"of {solution.surface_lower_bound} for any division of the surface"
            )
        if solution.segments is None or solution.seconds >= time_limit:
            return None
        if solution.segments <= by_vertices:
            return MeshFinding(by_vertices, solution.segments)
    raise Disagreement(
        f"a coloring of the vertices has {by_vertices} segments, "
        f"cp-sat finds {solution.segments} with {strands} strands"
    )


_Found = TypeVar("_Found")


def attempt(check: Callable[[], _Found]) -> tuple[_Found | None, str | None]:
    """What a comparison found, or why it failed.

    A solver that breaks down is as much of a finding as one that is wrong.
    """
    try:
        return check(), None
    except Disagreement as error:
        return None, str(error)
    except Exception as error:
        return None, f"{type(error).__name__}: {error}"


def _schemes(
    instance: Instance, solver: str, minimum: int, time_limit: float
) -> dict[SchemeKey, Division] | None:
    """The optimal schemes, None when there are too many or time ran out."""
    options = _options("paper", 1, time_limit)
    found: dict[SchemeKey, Division] = {}
    try:
        schemes = enumerate_schemes(instance, options, solver, minimum)
        for division in islice(schemes, MOST_SCHEMES + 1):
            key = scheme_key(division)
            if key in found:
                raise Disagreement(f"{solver} lists a scheme twice")
            found[key] = division
    except (OutOfTime, TooLarge):
        return None
    return found if len(found) <= MOST_SCHEMES else None


def _options(space: SearchSpace, strands: int, time_limit: float) -> Options:
    """One worker, and a time limit that counts from now on."""
    return Options(space, strands, Deadline.after(time_limit), workers=1)


_Front = tuple[tuple[int, int], ...]
"""Color and number of the segment of each painted vertex that still has unpainted neighbors."""


def fewest_by_vertices(surface: LabelledSurface, most_states: int) -> int | None:
    """The fewest connected components of equal color over all colorings of a mesh's vertices.

    Vertices are painted one by one in their order, which should have a short front, such as row by
    row. Of all partial colorings that look alike from the unpainted ones only the cheapest is kept;
    with more of them than ``most_states`` at a time the answer is None. A coloring of the vertices
    is a division of the surface, so no lower bound for the surface may exceed this; fewer may be
    possible where the mesh is too coarse for a corridor.
    """
    neighbors: dict[int, dict[int, set[int]]] = {
        vertex: {} for vertex, colors in enumerate(surface.vertex_colors) if colors
    }
    for i, j in surface.left_of:
        shared = set(surface.vertex_colors[i]) & set(surface.vertex_colors[j])
        common = shared - surface.cracked(i, j)
        if common:
            neighbors[i][j] = neighbors[j][i] = common
    front: list[int] = []
    best: dict[_Front, int] = {(): 0}
    for vertex, near in neighbors.items():
        painted = [*front, vertex]
        following = [v for v in painted if any(other > vertex for other in neighbors[v])]
        kept = set(following)
        grown: dict[_Front, int] = {}
        for state, closed in best.items():
            for color in surface.vertex_colors[vertex]:
                joined = {
                    segment
                    for v, (own, segment) in zip(front, state, strict=True)
                    if own == color and color in near.get(v, ())
                }
                segments = [-1 if segment in joined else segment for _, segment in state] + [-1]
                colors = [own for own, _ in state] + [color]
                names: dict[int, int] = {}
                found = tuple(
                    (own, names.setdefault(segment, len(names)))
                    for v, own, segment in zip(painted, colors, segments, strict=True)
                    if v in kept
                )
                cost = closed + len(set(segments)) - len(names)
                if cost < grown.get(found, cost + 1):
                    grown[found] = cost
        if len(grown) > most_states:
            return None
        front, best = following, grown
    return best[()]
