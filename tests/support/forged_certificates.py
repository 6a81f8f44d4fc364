"""Certificates of true bounds, forged in one place.

A forged claim on a large instance is one segment more than a division that exists, so it is false.
On a small mesh it may be true as well: ``forged_truth`` asks all colorings of its vertices.
"""

from __future__ import annotations

import copy
import json
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from library import INSTANCES
from meshes import drawn

import cellcolor
from cellcolor.data.bounds import Bound
from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.lab.families import LARGE, MEDIUM, blobs
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

Certificate = dict[str, Any]


MOST_COLORINGS = 2_000
SECONDS = 5
SHAPES: tuple[tuple[str, dict[str, list[int]]], ...] = (
    ("RRBBM", {"R": [0], "B": [1], "M": [0, 1]}),
    ("RRBBGM", {"R": [0], "B": [1], "G": [2], "M": [0, 1, 2]}),
    ("ABCR", {"A": [0, 1], "B": [1, 2], "C": [0, 2], "R": [0]}),
)
"""Letters that small meshes are drawn with, and the colors that each stands for."""
LARGE_FILES = (
    "paper/annulus.json",
    "paper/figeasycell4.json",
    "parts/machined-part.json",
)


@dataclass(frozen=True, eq=False)
class Original:
    """A true bound that a certificate proves.

    Attributes:
        name: what it is of.
        instance: the topological graph.
        bound: as many segments as a division has that exists; its certificate always has parts.
        surface: the mesh, if it is small enough for all of its colorings to be tried.
    """

    name: str
    instance: Instance
    bound: Bound
    surface: LabelledSurface | None = None


def small(seed: int) -> Iterator[Original]:
    """The bounds of a random mesh with few colorings; none if it has too many."""
    chance = random.Random(seed)
    letters, labels = SHAPES[seed % len(SHAPES)]
    rows = ["".join(chance.choices(letters, k=4)) for _ in range(chance.randint(3, 4))]
    surface = drawn(" ".join(rows), labels)
    colorings = 1
    for own in surface.vertex_colors:
        colorings *= max(1, len(own))
    if colorings <= MOST_COLORINGS:
        yield from _originals(f"mesh {seed}", cellcolor.decompose(surface), surface)


def large() -> Iterator[Original]:
    """The bounds of stored instances, scenes, blobs, tori and thin bands, one by one."""
    for name in LARGE_FILES:
        yield from _originals(name, Instance.read(INSTANCES / name))
    for file in sorted((INSTANCES / "scenes" / "feasibility").glob("*.surface.json")):
        yield from _originals(file.name, cellcolor.decompose(file))
    for seed in range(6):
        yield from _originals(f"blobs {seed}", cellcolor.decompose(blobs(seed)))
    yield from _originals("cells without loops", cells_without_loops())
    for seed in (0, 1, 2, 10):
        yield from _originals(f"torus {seed}", _graph(LARGE["torus"](seed)))
    for seed in (5, 22):
        thin = cellcolor.decompose(blobs(seed, size=20, thin=True))
        yield from _originals(f"thin bands {seed}", thin)
    yield from _originals("rim 1", cellcolor.decompose(MEDIUM["rim"](1)))


def _graph(made: Instance | LabelledSurface) -> Instance:
    """The graph of what a family made."""
    return made if isinstance(made, Instance) else cellcolor.decompose(made)


def cells_without_loops() -> Instance:
    """Closed surfaces of one cell each, beside two cells that share an edge."""
    alone = tuple(Cell(n, (n % 2, 2), ()) for n in range(6))
    pair = Cell(6, (0, 1), ((1,),)), Cell(7, (1, 2), ((-1,),))
    return Instance("cells without loops", ("a", "b", "c"), (*alone, *pair), (Edge(1, 6, 7),))


def _originals(
    name: str, instance: Instance, surface: LabelledSurface | None = None
) -> Iterator[Original]:
    """The bounds of an instance that meet its minimum, with parts in their certificates."""
    solution = solve(instance, Options(workers=1, deadline=Deadline.after(SECONDS)))
    for bound in solution.bounds or ():
        certificate = bound.certificate
        if certificate is None or bound.value != solution.segments:
            continue
        if bound.kind == "cover":
            part = {"value": bound.value, "cells": certificate["cells"], "conflicts": []}
            certificate = {"parts": [part]}
        certificate = {"left_out": [], **json.loads(json.dumps(certificate))}
        for part in certificate["parts"]:
            part.setdefault("conflicts", [])
        proved = Bound("conflicts", bound.value, "surface", certificate)
        yield Original(name, instance, proved, surface)


# --- one thing changed ----------------------------------------------------------------------------


def _swapped_cell(chance: random.Random, original: Original, forged: Certificate) -> int:
    """Another cell in the place of one that has to be touched."""
    cells = chance.choice([part for part in forged["parts"] if part["cells"]])["cells"]
    cells[chance.randrange(len(cells))] = chance.randrange(len(original.instance.cells))
    return 0


def _shortened_list(chance: random.Random, _: Original, forged: Certificate) -> int:
    """A cell, a conflict, or the cells of an area are missing."""
    part = chance.choice([part for part in forged["parts"] if part["cells"]])
    name = chance.choice(["cells", "conflicts"]) if part["conflicts"] else "cells"
    part[name].pop(chance.randrange(len(part[name])))
    return 0


def _no_conflict(chance: random.Random, original: Original, forged: Certificate) -> int:
    """A conflict that is none: an area lies elsewhere in the segment's color region."""
    part = chance.choice(forged["parts"])
    if part["conflicts"]:
        conflict = copy.deepcopy(chance.choice(part["conflicts"]))
    else:
        colors = [chance.randrange(len(original.instance.colors)) for _ in range(2)]
        conflict = {"colors": colors, "one": [[], []], "other": [[], []]}
    for side, color in zip(("one", "other"), conflict["colors"], strict=True):
        for end in (0, 1):
            if not conflict[side][end] or chance.random() < 0.4:
                own = [c.id for c in original.instance.cells if color in c.colors]
                conflict[side][end] = [chance.choice(own or [0])]
    part["conflicts"].append(conflict)
    return 0


def _not_minimal(_: random.Random, original: Original, forged: Certificate) -> int:
    """All cells are named for one segment more, as if the cover were not minimal."""
    forged["parts"] = [
        {
            "value": original.bound.value + 1,
            "cells": [cell.id for cell in original.instance.cells],
            "conflicts": [c for part in forged["parts"] for c in part["conflicts"]],
        }
    ]
    return 1


def _wrong_number(chance: random.Random, _: Original, forged: Certificate) -> int:
    """A part, or the bound alone, says more."""
    more = chance.randint(1, 3)
    chance.choice(forged["parts"])["value"] += chance.choice([0, more])
    return more


def _left_out_wrongly(chance: random.Random, original: Original, forged: Certificate) -> int:
    """A color region is left out for which another color cannot stand in."""
    cell = chance.choice(original.instance.cells)
    step = [chance.choice(cell.colors), cell.id, chance.randrange(len(original.instance.colors))]
    forged["left_out"] = [*forged["left_out"], step]
    return 0


def _long_list(chance: random.Random, original: Original, forged: Certificate) -> int:
    """One cell, conflict or step is there thousands of times, or every cell is named."""
    part = chance.choice(forged["parts"])
    name = chance.choice(["cells", "conflicts", "left_out"])
    listed = forged["left_out"] if name == "left_out" else part[name]
    if name == "cells":
        part["cells"] = [cell.id for cell in original.instance.cells] * 40
    else:
        listed.extend(listed[:1] * 3_000)
    part["value"] += 1
    return 1


def _many_parts(_: random.Random, original: Original, forged: Certificate) -> int:
    """A part for every cell, as if no color region lay in two."""
    cells = original.instance.cells
    forged["parts"] = [{"value": 1, "cells": [cell.id], "conflicts": []} for cell in cells]
    return 1 + original.bound.value


def _wrong_type(chance: random.Random, _: Original, forged: Certificate) -> int:
    """Something that no certificate has, at any place of it."""
    nonsense = [None, True, 1.5, "0", [], {}, [[]], -1, 10**30, {"cells": [0]}]
    places = list(_places(forged))
    holder, key = chance.choice(places)
    holder[key] = copy.deepcopy(chance.choice(nonsense))
    return 1


def _wrong_member(chance: random.Random, _: Original, forged: Certificate) -> int:
    """A member is missing, is one too many, or has another name."""
    holder = chance.choice([forged, *forged["parts"]])
    member = chance.choice(sorted(holder))
    content = holder.pop(member)
    if chance.random() < 0.5:
        holder[chance.choice(["Cells", "", "of", "value "])] = content
    return 1


def _wrong_id(chance: random.Random, original: Original, forged: Certificate) -> int:
    """A cell or color that does not exist."""
    size = len(original.instance.cells)
    wrong = chance.choice([-1, -size, size, size + 1, 2**31, 2**63, -(2**64)])
    places = [(holder, key) for holder, key in _places(forged) if type(holder[key]) is int]
    holder, key = chance.choice([place for place in places if place[1] != "value"] or places)
    holder[key] = wrong
    return 1


def _duplicates(chance: random.Random, _: Original, forged: Certificate) -> int:
    """A part twice, or its cells and conflicts twice in another one."""
    part = copy.deepcopy(chance.choice(forged["parts"]))
    kind = chance.randrange(2)
    if kind == 1:
        part["cells"] = part["cells"] * 2
        part["conflicts"] = part["conflicts"] * 2
    forged["parts"].append(part)
    return max(1, part["value"]) if kind == 0 else 1


def _places(holder: Any) -> Iterator[tuple[Any, Any]]:
    """Every place in some nested lists and objects: what holds it, and the key or index there."""
    todo = [holder]
    while todo:
        inner = todo.pop()
        keys = sorted(inner) if isinstance(inner, dict) else range(len(inner))
        for key in keys:
            yield inner, key
            if isinstance(inner[key], (dict, list)):
                todo.append(inner[key])


FORGERIES: dict[str, Callable[[random.Random, Original, Certificate], int]] = {
    "a swapped cell": _swapped_cell,
    "a shortened list": _shortened_list,
    "a conflict that is none": _no_conflict,
    "a cover that is not minimal": _not_minimal,
    "a wrong number": _wrong_number,
    "a color left out wrongly": _left_out_wrongly,
    "a long list": _long_list,
    "a part for every cell": _many_parts,
    "a wrong type": _wrong_type,
    "a wrong member": _wrong_member,
    "a cell that is not there": _wrong_id,
    "something twice": _duplicates,
}
"""Each changes a certificate and says how many segments more the bound claims."""


def forge(kind: str, seed: int, original: Original) -> Bound:
    """A forged bound; on a large instance it claims one segment more than exists, at least."""
    chance = random.Random(f"{kind} {seed}")
    certificate = copy.deepcopy(original.bound.certificate)
    assert certificate is not None
    more = FORGERIES[kind](chance, original, certificate)
    if original.surface is None and more == 0:
        chance.choice(certificate["parts"])["value"] += 1
        more = 1
    return Bound("conflicts", original.bound.value + more, "surface", certificate)
