"""Faults planted in valid solutions at random places, each with what an oracle has to say of it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from planting import Case, Planted, Planter, Random

from cellcolor.data.solution import CellDivision, Division


def wrong_number(case: Case, random: Random) -> Planted:
    """A solution that claims more or fewer segments or lift-offs than its division has."""
    solution = case.solution
    segments, lift_offs = solution.segments, solution.lift_offs
    assert segments is not None and lift_offs is not None
    if random.random() < 0.5:
        claim = int(random.choice([n for n in range(segments + 3) if n != segments]))
        said = f"segments: says {claim}, the division has {segments}"
        return Planted(replace(solution, segments=claim), (said,))
    claim = int(random.choice([n for n in range(lift_offs + 3) if n != lift_offs]))
    said = f"lift_offs: says {claim}, must be {lift_offs}"
    return Planted(replace(solution, lift_offs=claim), (said,))


def wrong_bound(case: Case, random: Random) -> Planted:
    """A solution that claims that more segments are needed than it has."""
    solution, more = case.solution, int(random.integers(1, 4))
    assert solution.segments is not None
    name = str(random.choice(["lower_bound", "surface_lower_bound"]))
    claim = solution.segments + more
    segments = f"{solution.segments} segment{'' if solution.segments == 1 else 's'}"
    changes: dict[str, Any] = {name: claim}
    return Planted(
        replace(solution, **changes), (f"{name}: {claim} cannot be above the {segments} found",)
    )


def segment_renumbered(case: Case, random: Random) -> Planted:
    """A solution with one sub-cell numbered as a segment of its own, which it is not."""
    cells, segments = case.solution.cells, case.solution.segments
    assert cells is not None and segments is not None
    parts = [(c, s) for c, cell in enumerate(cells) for s in range(len(cell.subcells))]
    c, s = parts[random.integers(len(parts))]
    number = cells[c].subcells[s].segment
    own = [(i, j) for i, j in parts if cells[i].subcells[j].segment == number]
    changed = _with_subcell(cells, c, s, segment=segments)
    if len(own) > 1:
        i, j = own[0]
        said = f"cells[{i}].subcells[{j}].segment: one segment has numbers [{number}, {segments}]"
    else:
        said = f"segment numbers must be 0 to {segments - 1}"
    return Planted(replace(case.solution, cells=changed), (said,))


def subcell_recolored(case: Case, random: Random) -> Planted | None:
    """A solution with one sub-cell in a color that its cell does not have."""
    cells = case.solution.cells
    assert cells is not None
    graph = case.solved.instance
    c = int(random.integers(len(cells)))
    s = int(random.integers(len(cells[c].subcells)))
    own = graph.cells[c].colors
    color = int(random.choice([n for n in range(-1, len(graph.colors) + 1) if n not in own]))
    changed = _with_subcell(cells, c, s, color=color)
    said = f"cells[{c}].subcells[{s}].color: cell {c} cannot be painted in color {color}"
    return Planted(replace(case.solution, cells=changed), (said,))


def another_surface_solved(case: Case, random: Random) -> Planted:  # noqa: ARG001
    """The solution of another surface."""
    name = case.solved.instance.name
    said = f"instance.sha256: the solution is not for {name!r} as it is here"
    return Planted(case.other_solution, (said,))


def no_division(case: Case, random: Random) -> Planted:  # noqa: ARG001
    """A solution that found no division."""
    plan = replace(
        case.solution, status="unknown", segments=None, lift_offs=None, cells=None, seams=(),
        proved_for_surface=False, cutting_paths=None,
    )  # fmt: skip
    return Planted(plan, ("cells: null, no division to judge",))


def _with_subcell(cells: Division, c: int, s: int, **changes: Any) -> Division:
    subcells = list(cells[c].subcells)
    subcells[s] = replace(subcells[s], **changes)
    return (*cells[:c], CellDivision(cells[c].id, tuple(subcells)), *cells[c + 1 :])


SOLUTION_PLANTERS: dict[str, Planter] = {
    "solution: wrong number of segments": wrong_number,
    "solution: bound too high": wrong_bound,
    "solution: segment renumbered": segment_renumbered,
    "solution: sub-cell in a wrong color": subcell_recolored,
    "solution of another surface": another_surface_solved,
    "solution without a division": no_division,
}
