"""Faults planted in valid plans and solutions at random places, and whether an oracle catches them.

What it has to say of each is worked out here from the surface's colors alone, not by the checker.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
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
Colors = Sequence[int | None]


@dataclass(frozen=True)
class Case:
    """A surface with a color, that plans are broken on.

    Attributes:
        other: another surface, whose plans are none of this one.
        folder: for files of plans.
    """

    surface: LabelledSurface
    other: LabelledSurface
    folder: Path

    @cached_property
    def oracle(self) -> cellcolor.Oracle:
        return cellcolor.Oracle(self.surface, workers=1, time_limit=20.0)

    @cached_property
    def solved(self) -> cellcolor.Result:
        """A valid solution, and the graph that it is of."""
        return cellcolor.solve(self.surface, workers=1, time_limit=20.0)

    @property
    def solution(self) -> Solution:
        return self.solved.solution


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


Planter = Callable[[Case, Random], Planted | None]
"""None where the surface has no place for such a fault."""


def caught(case: Case, planted: Planted) -> bool:
    """Whether the oracle refuses it with kind and place."""
    try:
        verdict = case.oracle.judge(planted.plan)
    except InputError as error:
        (said,) = planted.said
        return str(error).removeprefix(f"{planted.plan}: ") == said
    places = [tuple(case.surface.vertices[vertex].tolist()) for vertex in planted.vertices]
    return (
        not verdict.valid
        and verdict.segments is None
        and set(planted.said) <= {*verdict.problems}
        and (not verdict.violations or tuple(map(str, verdict.violations)) == verdict.problems)
        and tuple(violation.vertex for violation in verdict.violations) == planted.vertices
        and [violation.place for violation in verdict.violations] == places
    )


# --- solutions ------------------------------------------------------------------------------------


def wrong_number(case: Case, random: Random) -> Planted:
    """More or fewer segments or lift-offs than the division has."""
    name = str(random.choice(["segments", "lift_offs"]))
    true = getattr(case.solution, name)
    claim = int(random.choice([n for n in range(true + 3) if n != true]))
    ends = {"segments": f"the division has {true}", "lift_offs": f"must be {true}"}
    said = f"{name}: says {claim}, {ends[name]}"
    return Planted(replace(case.solution, **{name: claim}), (said,))


def wrong_bound(case: Case, random: Random) -> Planted:
    """More segments are claimed to be needed than there are."""
    segments = case.solution.segments
    assert segments is not None
    name, claim = str(random.choice(["lower_bound", "surface_lower_bound"])), segments + 1
    found = f"{segments} segment{'' if segments == 1 else 's'} found"
    changes: dict[str, Any] = {name: claim}
    return Planted(
        replace(case.solution, **changes), (f"{name}: {claim} cannot be above the {found}",)
    )


def segment_renumbered(case: Case, random: Random) -> Planted:
    """One sub-cell numbered as a segment of its own, which it is not."""
    cells, segments = case.solution.cells, case.solution.segments
    assert cells is not None and segments is not None
    parts = [(c, s) for c, cell in enumerate(cells) for s in range(len(cell.subcells))]
    c, s = parts[random.integers(len(parts))]
    number = cells[c].subcells[s].segment
    (i, j), *more = [at for at in parts if cells[at[0]].subcells[at[1]].segment == number]
    said = f"segment numbers must be 0 to {segments - 1}"
    if more:
        said = f"cells[{i}].subcells[{j}].segment: one segment has numbers [{number}, {segments}]"
    changed = _with_subcell(cells, c, s, segment=segments)
    return Planted(replace(case.solution, cells=changed), (said,))


def subcell_recolored(case: Case, random: Random) -> Planted:
    """One sub-cell in a color that its cell does not have."""
    cells, graph = case.solution.cells, case.solved.instance
    assert cells is not None
    c = int(random.integers(len(cells)))
    s = int(random.integers(len(cells[c].subcells)))
    lacking = [n for n in range(-1, len(graph.colors) + 1) if n not in graph.cells[c].colors]
    color = int(random.choice(lacking))
    said = f"cells[{c}].subcells[{s}].color: cell {c} cannot be painted in color {color}"
    changed = _with_subcell(cells, c, s, color=color)
    return Planted(replace(case.solution, cells=changed), (said,))


def another_surface_solved(case: Case, _: Random) -> Planted:
    said = f"instance.sha256: the solution is not for {case.solved.instance.name!r} as it is here"
    return Planted(cellcolor.solve(case.other, workers=1, time_limit=20.0).solution, (said,))


def no_division(case: Case, _: Random) -> Planted:
    plan = replace(
        case.solution, status="unknown", segments=None, lift_offs=None, cells=None, seams=(),
        proved_for_surface=False, cutting_paths=None,
    )  # fmt: skip
    return Planted(plan, ("cells: null, no division to judge",))


def _with_subcell(cells: Division, c: int, s: int, **changes: Any) -> Division:
    subcells = list(cells[c].subcells)
    subcells[s] = replace(subcells[s], **changes)
    return (*cells[:c], CellDivision(cells[c].id, tuple(subcells)), *cells[c + 1 :])


# --- plans ----------------------------------------------------------------------------------------


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
    forms: list[Callable[[], Any]] = [
        lambda: colors,
        lambda: tuple(colors),
        lambda: np.array(colors, dtype=object),
        lambda: Plan(tuple(colors)),
        lambda: _file(case, colors),
    ]
    if not {-1, None} & {*colors}:  # -1 stands for no color in arrays of integers
        forms += [lambda: np.array(colors), lambda: np.array(colors, dtype=np.int32)]
    named = dict(enumerate(case.surface.colors))
    if {*colors} <= {None, *named}:
        forms.append(lambda: [None if color is None else named[color] for color in colors])
    return forms[random.integers(len(forms))]()


def _file(case: Case, colors: Sequence[Any]) -> Path:
    path = case.folder / "broken.plan.json"
    document = {"format": Plan.FORMAT, "version": 1, "vertex_colors": list(colors)}
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


def at_some_vertices(wrong: Callable[[int, tuple[int, ...]], Sequence[int | None]]) -> Planter:
    """One to three vertices with one of the entries that are wrong there.

    Args:
        wrong: these, of the number of colors of the surface and the colors of a vertex.
    """

    def plant(case: Case, random: Random) -> Planted | None:
        every = [wrong(len(case.surface.colors), own) for own in case.surface.vertex_colors]
        candidates = [vertex for vertex, entries in enumerate(every) if entries]
        if not candidates:
            return None
        colors = _valid(case.surface, random)
        count = min(len(candidates), int(random.integers(1, 4)))
        for vertex in random.choice(candidates, count, replace=False).tolist():
            colors[vertex] = every[vertex][random.integers(len(every[vertex]))]
        return Planted(_formed(case, colors, random), *_wrong(case, colors))

    return plant


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


def _first_wrong(case: Case, tried: Iterable[list[int | None]], random: Random) -> Planted | None:
    for colors in tried:
        said, vertices = _wrong(case, colors)
        if said:
            return Planted(_formed(case, colors, random), said, vertices)
    return None


def shuffled(case: Case, random: Random) -> Planted | None:
    """The entries in another order; None if every order is valid that was tried."""
    valid = _valid(case.surface, random)
    orders = (random.permutation(len(valid)) for _ in range(10))
    return _first_wrong(case, ([valid[k] for k in order] for order in orders), random)


def two_exchanged(case: Case, random: Random) -> Planted | None:
    """Two vertices with each other's color; None if every pair is valid that was tried."""
    valid = _valid(case.surface, random)
    pairs = (random.choice(len(valid), 2, replace=False).tolist() for _ in range(50))
    orders = ({i: j, j: i} for i, j in pairs)
    tried = ([valid[to.get(k, k)] for k in range(len(valid))] for to in orders)
    return _first_wrong(case, tried, random)


def color_renamed(case: Case, random: Random) -> Planted:
    """One color has another name than on the surface, wherever it stands."""
    colors = _valid(case.surface, random)
    renamed = int(random.choice(sorted({color for color in colors if color is not None})))
    names = dict(enumerate(case.surface.colors))
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
    return _first_wrong(case, [colors], random)


PLANTERS: dict[str, Planter] = {
    "wrong color": at_some_vertices(lambda n, own: [c for c in range(n) if own and c not in own]),
    "color at an unreachable vertex": at_some_vertices(lambda n, own: () if own else range(n)),
    "none at a reachable vertex": at_some_vertices(lambda _, own: [None] if own else ()),
    "color number out of range": at_some_vertices(lambda n, _: (-2, -1, n, n + 1, 10**6)),
    "wrong length": wrong_length,
    "NaN, fraction or truth value": no_integer,
    "array of a wrong type": wrong_dtype,
    "vertices shuffled": shuffled,
    "two vertices exchanged": two_exchanged,
    "color renamed": color_renamed,
    "plan of another surface": other_surface,
    "solution: wrong number of segments": wrong_number,
    "solution: bound too high": wrong_bound,
    "solution: segment renumbered": segment_renumbered,
    "solution: sub-cell in a wrong color": subcell_recolored,
    "solution of another surface": another_surface_solved,
    "solution without a division": no_division,
}
