"""What a planted fault in a plan is, and whether the oracle catches it.

Faults planted in valid solutions at random places, each with what an oracle has to say of it.

Faults planted in valid plans at random places, each with what an oracle has to say of it.

What it has to say is worked out here from the surface's colors alone, not by the checker.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

import cellcolor
from cellcolor.data.plan import Plan
from cellcolor.data.solution import CellDivision, Division, Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError

Random = np.random.Generator


@dataclass(frozen=True)
class Case:
    """A surface that plans are broken on.

    Attributes:
        surface: it has a vertex with a color.
        other: another surface, whose plans are none of this one.
        folder: for files of plans.
    """

    surface: LabelledSurface
    other: LabelledSurface
    folder: Path

    @cached_property
    def oracle(self) -> cellcolor.Oracle:
        """Without a search: of plans that are not valid nothing has to be proved."""
        return cellcolor.Oracle(self.surface, workers=1, time_limit=20.0)

    @cached_property
    def solved(self) -> cellcolor.Result:
        """A valid solution, and the graph that it is of."""
        return cellcolor.solve(self.surface, workers=1, time_limit=20.0)

    @property
    def solution(self) -> Solution:
        """The solution alone."""
        return self.solved.solution

    @cached_property
    def other_solution(self) -> Solution:
        """A valid one of the other surface."""
        return cellcolor.solve(self.other, workers=1, time_limit=20.0).solution


@dataclass(frozen=True)
class Planted:
    """What is not valid, and how it has to be refused.

    Attributes:
        plan: in any of the forms that an oracle takes.
        said: each of these is one of the problems, or all that the error says.
        vertices: where the violations are, all of them.
    """

    plan: Any
    said: tuple[str, ...]
    vertices: tuple[int, ...] = ()


def caught(case: Case, planted: Planted) -> bool:
    """Whether the oracle refuses it with kind and place."""
    try:
        verdict = case.oracle.judge(planted.plan)
    except InputError as error:
        (said,) = planted.said
        return str(error).removeprefix(f"{planted.plan}: ") == said
    if (
        verdict.valid
        or verdict.segments is not None
        or not set(planted.said) <= {*verdict.problems}
    ):
        return False
    if verdict.violations and tuple(map(str, verdict.violations)) != verdict.problems:
        return False
    places = [tuple(case.surface.vertices[vertex].tolist()) for vertex in planted.vertices]
    return (
        tuple(violation.vertex for violation in verdict.violations) == planted.vertices
        and [violation.place for violation in verdict.violations] == places
    )


Planter = Callable[[Case, Random], Planted | None]
"""None where the surface has no place for such a fault."""


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


Colors = Sequence[int | None]


def _valid(surface: LabelledSurface, random: Random) -> list[int | None]:
    """A valid plan in patches: each vertex takes the first of its colors in a random order."""
    rank = random.permutation(len(surface.colors))
    return [min(own, key=lambda c: rank[c]) if own else None for own in surface.vertex_colors]


def _wrong(case: Case, colors: Colors) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """What is wrong at which vertices, from the colors of the surface."""
    found = {}
    for vertex, (color, own) in enumerate(zip(colors, case.surface.vertex_colors, strict=True)):
        if color is None and own:
            found[vertex] = f"null, but colors {list(own)} reach this vertex"
        elif color is not None and color not in range(len(case.surface.colors)):
            found[vertex] = f"there is no color {color}"
        elif color is not None and color not in own:
            found[vertex] = f"color {color} does not reach this vertex"
    return tuple(f"vertex_colors[{v}]: {why}" for v, why in found.items()), tuple(found)


def _formed(case: Case, colors: list[int | None], random: Random) -> Any:
    """The plan in one of the forms that can hold it."""
    numbers = [-1 if color is None else color for color in colors]
    forms: list[Callable[[], Any]] = [
        lambda: colors,
        lambda: tuple(colors),
        lambda: np.array(colors, dtype=object),
        lambda: Plan(tuple(colors)),
        lambda: _file(case, colors),
    ]
    if -1 not in colors:  # which stands for no color in arrays of integers
        forms += [lambda: np.array(numbers), lambda: np.array(numbers, dtype=np.int32)]
    named = dict(enumerate(case.surface.colors))
    if {*colors} <= {None, *named}:
        forms.append(lambda: [None if color is None else named[color] for color in colors])
    return forms[random.integers(len(forms))]()


def _file(case: Case, colors: Sequence[Any]) -> Path:
    path = case.folder / "broken.plan.json"
    document = {"format": Plan.FORMAT, "version": 1, "vertex_colors": list(colors)}
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


def _at_some_vertices(
    case: Case, random: Random, candidates: Sequence[int], wrong: Callable[[int], int | None]
) -> Planted | None:
    """A plan with a wrong color at one to three of some vertices; None if there are none."""
    if not candidates:
        return None
    colors = _valid(case.surface, random)
    count = min(len(candidates), int(random.integers(1, 4)))
    for vertex in random.choice(candidates, count, replace=False).tolist():
        colors[vertex] = wrong(vertex)
    return Planted(_formed(case, colors, random), *_wrong(case, colors))


def _vertices(surface: LabelledSurface, reachable: bool) -> list[int]:
    return [v for v, own in enumerate(surface.vertex_colors) if bool(own) == reachable]


def wrong_color(case: Case, random: Random) -> Planted | None:
    """A color of the surface that does not reach the vertex."""
    every = set(range(len(case.surface.colors)))
    lacking = [v for v in _vertices(case.surface, True) if every - {*case.surface.vertex_colors[v]}]

    def wrong(vertex: int) -> int:
        return int(random.choice(sorted(every - {*case.surface.vertex_colors[vertex]})))

    return _at_some_vertices(case, random, lacking, wrong)


def color_at_unreachable(case: Case, random: Random) -> Planted | None:
    """A color where none reaches."""
    colors = len(case.surface.colors)
    unreachable = _vertices(case.surface, False)
    return _at_some_vertices(case, random, unreachable, lambda _: int(random.integers(colors)))


def none_at_reachable(case: Case, random: Random) -> Planted | None:
    """No color where one reaches."""
    return _at_some_vertices(case, random, _vertices(case.surface, True), lambda _: None)


def out_of_range(case: Case, random: Random) -> Planted | None:
    """A number that is no color's, below and above."""
    colors = len(case.surface.colors)
    every = list(range(len(case.surface.vertices)))
    return _at_some_vertices(
        case, random, every, lambda _: int(random.choice([-2, -1, colors, colors + 1, 10**6]))
    )


def wrong_length(case: Case, random: Random) -> Planted:
    """Entries too few or too many."""
    colors = _valid(case.surface, random)
    more = int(random.integers(1, 4))
    colors = colors[:-more] if random.random() < 0.5 else colors + colors[:more]
    said = f"vertex_colors: {len(colors)} entries for {len(case.surface.vertices)} vertices"
    return Planted(_formed(case, colors, random), (said,))


def no_integer(case: Case, random: Random) -> Planted:
    """Something at one vertex that is not a number of a color: NaN, a fraction, True, a list."""
    colors: list[Any] = [*_valid(case.surface, random)]
    vertex = int(random.integers(len(colors)))
    wrong = [(float("nan"), ", is NaN"), (0.5, ", is 0.5"), (0.0, ", is 0.0"), (True, ", is true")]
    colors[vertex], shown = [*wrong, ([0], ""), ({}, "")][random.integers(6)]
    plan = colors if random.random() < 0.5 else np.array(colors, dtype=object)
    return Planted(plan, (f"vertex_colors[{vertex}]: Input should be a valid integer{shown}",))


def wrong_dtype(case: Case, random: Random) -> Planted:
    """An array that is not of integers, as one with NaN for none is."""
    colors = np.array([np.nan if c is None else c for c in _valid(case.surface, random)])
    kind = str(random.choice(["float32", "float64", "complex128", "bool", "datetime64[s]"]))
    if kind[0] in "bd":  # which cannot hold NaN, or only as another value
        colors = np.nan_to_num(colors).astype(np.int64)
    said = f"vertex_colors: must be color numbers (-1 for none) or names, is an array of {kind}"
    return Planted(colors.astype(kind), (said,))


def shuffled(case: Case, random: Random) -> Planted | None:
    """The entries in another order; None if every order is valid that was tried."""
    valid = _valid(case.surface, random)
    for _ in range(10):
        colors = [valid[k] for k in random.permutation(len(valid))]
        said, vertices = _wrong(case, colors)
        if said:
            return Planted(_formed(case, colors, random), said, vertices)
    return None


def two_exchanged(case: Case, random: Random) -> Planted | None:
    """Two vertices with each other's color; None if every pair is valid that was tried."""
    colors = _valid(case.surface, random)
    for _ in range(50):
        i, j = random.choice(len(colors), 2, replace=False).tolist()
        exchanged = list(colors)
        exchanged[i], exchanged[j] = colors[j], colors[i]
        said, vertices = _wrong(case, exchanged)
        if said:
            return Planted(_formed(case, exchanged, random), said, vertices)
    return None


def color_renamed(case: Case, random: Random) -> Planted:
    """One color has another name than on the surface, wherever it stands."""
    colors = _valid(case.surface, random)
    used = sorted({color for color in colors if color is not None})
    renamed = int(random.choice(used))
    names = {color: case.surface.colors[color] for color in used}
    names[renamed] += str(random.choice([" ", "_", "2"]))
    plan = [None if color is None else names[color] for color in colors]
    said = f"vertex_colors[{colors.index(renamed)}]: the surface has no color {names[renamed]!r}"
    return Planted(plan, (said,))


def other_surface(case: Case, random: Random) -> Planted | None:
    """A valid plan of another surface; None if it is one of this surface, too."""
    colors = _valid(case.other, random)
    if len(colors) != len(case.surface.vertices):
        said = f"vertex_colors: {len(colors)} entries for {len(case.surface.vertices)} vertices"
        return Planted(Plan(tuple(colors)), (said,))
    said, *vertices = _wrong(case, colors)
    return Planted(Plan(tuple(colors)), said, *vertices) if said else None


PLANTERS: dict[str, Planter] = {
    "wrong color": wrong_color,
    "color at an unreachable vertex": color_at_unreachable,
    "none at a reachable vertex": none_at_reachable,
    "color number out of range": out_of_range,
    "wrong length": wrong_length,
    "NaN, fraction or truth value": no_integer,
    "array of a wrong type": wrong_dtype,
    "vertices shuffled": shuffled,
    "two vertices exchanged": two_exchanged,
    "color renamed": color_renamed,
    "plan of another surface": other_surface,
    **SOLUTION_PLANTERS,
}
