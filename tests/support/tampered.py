"""What somebody may have done to the file in which a proof is kept, and what it may do then."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr, redirect_stdout
from copy import deepcopy
from dataclasses import dataclass
from functools import cached_property
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest.mock import patch

import numpy as np
from commands import run
from planners import any_colors, contradictions, segments_counted

import cellcolor.door.oracle as door
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.door.oracle import KeepingOracle
from cellcolor.oracle import Proof, prove

Random = np.random.Generator
Text = str | bytes
LIMIT = 20.0  # seconds


@dataclass(frozen=True)
class Kept:
    """A surface, the file that an honest proof leaves, and that of another surface.

    Attributes:
        surface: its minimum is proved.
        other: another one.
    """

    surface: LabelledSurface
    other: LabelledSurface

    @cached_property
    def honest(self) -> tuple[int, str, str]:
        """The minimum, and name and content of the file."""
        with TemporaryDirectory() as folder:
            oracle = KeepingOracle(self.surface, LIMIT, Path(folder))
            assert oracle.bounds.exact
            (file,) = Path(folder).iterdir()
            return oracle.bounds.upper, file.name, file.read_text(encoding="utf-8")

    @property
    def fewest(self) -> int:
        """The minimum."""
        return self.honest[0]

    @cached_property
    def others(self) -> str:
        """What is kept of the other surface."""
        return Kept(self.other, self.surface).honest[2]

    @cached_property
    def best(self) -> list[int | None]:
        """The plan that the best painting leaves on the mesh."""
        best = door.Oracle(self.surface, time_limit=LIMIT).best
        assert best is not None
        return list(best.on_mesh.vertex_colors)

    def document(self) -> dict[str, Any]:
        """What is kept, to be changed."""
        return dict(json.loads(self.honest[2]))


Tamperer = Callable[[Kept, Random], Text]
"""The file's new content."""


def _each(change: Callable[[dict[str, Any], Kept, Random], object]) -> Tamperer:
    """All kept solutions are changed, in place."""

    def tamper(kept: Kept, random: Random) -> str:
        document = kept.document()
        for solution in document["solutions"]:
            change(solution, kept, random)
        return json.dumps(document)

    return tamper


def _stated(**members: Any) -> Tamperer:
    return lambda kept, _: json.dumps(kept.document() | members)


def _raise(solution: dict[str, Any], kept: Kept, random: Random) -> None:
    """A bound above the minimum, in all places where it stands."""
    higher = kept.fewest + int(random.integers(1, 4))
    solution |= {"lower_bound": higher, "surface_lower_bound": higher, "status": "feasible"}
    for bound in solution["bounds"]:
        bound["value"] = higher


def _raise_alone(solution: dict[str, Any], kept: Kept, random: Random) -> None:
    """The same, and no division that is in its way."""
    _raise(solution, kept, random)
    solution |= {"cells": None, "segments": None, "lift_offs": None, "coverage": None}
    solution |= {"status": "unknown", "seams": [], "proved_for_surface": False}


def _more_segments(solution: dict[str, Any], kept: Kept, random: Random) -> None:
    """A bound above the minimum, and a division that says to have as many segments."""
    _raise(solution, kept, random)
    claimed = solution["lower_bound"]
    solution |= {"segments": claimed, "lift_offs": claimed - 1, "status": "optimal"}
    solution["proved_for_surface"] = True


def _fewer_segments(solution: dict[str, Any], kept: Kept, random: Random) -> None:  # noqa: ARG001
    """Two segments have one number."""
    subcells = [sub for cell in solution["cells"] for sub in cell["subcells"]]
    last = max(sub["segment"] for sub in subcells)
    for sub in subcells:
        if sub["segment"] == last:
            sub["segment"] = int(random.integers(max(1, last)))
    solution |= {"segments": max(1, last), "lift_offs": max(0, last - 1)}
    _lowered(solution, max(1, last))


def _lowered(solution: dict[str, Any], most: int) -> None:
    for name in ("lower_bound", "surface_lower_bound"):
        solution[name] = min(solution[name], most)
    for bound in solution["bounds"]:
        bound["value"] = min(bound["value"], most)


def _fewer_counted(solution: dict[str, Any], kept: Kept, random: Random) -> None:  # noqa: ARG001
    solution["segments"] = max(0, kept.fewest - 1)
    solution["lift_offs"] = max(0, kept.fewest - 2)
    _lowered(solution, max(0, kept.fewest - 1))


def _no_certificates(solution: dict[str, Any], kept: Kept, random: Random) -> None:  # noqa: ARG001
    for bound in solution["bounds"]:
        bound.pop("certificate", None)


def _no_bounds(solution: dict[str, Any], kept: Kept, random: Random) -> None:  # noqa: ARG001
    solution["bounds"] = []


def _forge_certificates(solution: dict[str, Any], kept: Kept, random: Random) -> None:  # noqa: ARG001
    """One number of each is another one."""
    for bound in solution["bounds"]:
        places = [place for place in leaves(bound.get("certificate")) if type(place[2]) is int]
        if places:
            holder, key, old = places[int(random.integers(len(places)))]
            holder[key] = old + int(random.choice([-7, -2, -1, 1, 2, 7, 10**9, 10**30]))
            bound["value"] += int(random.integers(2))
    top = max((bound["value"] for bound in solution["bounds"]), default=0)
    solution |= {"lower_bound": top, "surface_lower_bound": top, "status": "feasible"}


def _longer_certificates(solution: dict[str, Any], kept: Kept, random: Random) -> None:
    """All lists in them twice as long, and the bounds twice as high."""
    _raise(solution, kept, random)
    for bound in solution["bounds"]:
        for holder, key, old in list(containers(bound.get("certificate"))):
            if isinstance(old, list):
                holder[key] = old + deepcopy(old)


def _for_surface(solution: dict[str, Any], kept: Kept, random: Random) -> None:  # noqa: ARG001
    for bound in solution["bounds"]:
        bound["holds_for"] = "surface"
        bound["value"] += 1
    solution["lower_bound"] = solution["surface_lower_bound"] = kept.fewest + 1


def _others_bounds(solution: dict[str, Any], kept: Kept, random: Random) -> None:  # noqa: ARG001
    given = json.loads(kept.others)["solutions"][-1]
    for name in ("bounds", "lower_bound", "surface_lower_bound"):
        solution[name] = given[name]


def _others_cells(solution: dict[str, Any], kept: Kept, random: Random) -> None:  # noqa: ARG001
    given = json.loads(kept.others)["solutions"][-1]
    for name in ("cells", "segments", "lift_offs", "seams", "coverage"):
        solution[name] = given[name]


def _renamed(solution: dict[str, Any], kept: Kept, random: Random) -> None:  # noqa: ARG001
    """The other's solution, as one of this instance."""
    given = json.loads(kept.others)["solutions"][-1]
    given["instance"] = solution["instance"]
    solution.clear()
    solution |= given


def _repainted(solution: dict[str, Any], kept: Kept, random: Random) -> None:
    cell = _one(solution["cells"], random)
    sub = _one(cell["subcells"], random)
    sub["color"] = int(random.integers(len(kept.surface.colors) + 1))


def _dropped(solution: dict[str, Any], kept: Kept, random: Random) -> None:  # noqa: ARG001
    cells = solution["cells"]
    if random.integers(2):
        cells = _one(cells, random)["subcells"]
    del cells[int(random.integers(len(cells)))]


def _hash(solution: dict[str, Any], kept: Kept, random: Random) -> None:  # noqa: ARG001
    old = solution["instance"]["sha256"]
    at = int(random.integers(len(old)))
    solution["instance"]["sha256"] = old[:at] + ("0" if old[at] != "0" else "1") + old[at + 1 :]


def _version(solution: dict[str, Any], kept: Kept, random: Random) -> None:  # noqa: ARG001
    solution["version"] = _one([1, 4, 0, "3", None, 3.0, True], random)


def _one(of: list[Any], random: Random) -> Any:
    return of[int(random.integers(len(of)))]


def leaves(document: Any) -> Iterator[tuple[Any, Any, Any]]:
    """Numbers, strings and the like in a document, each with what holds it."""
    for holder, key, value in containers(document):
        if not isinstance(value, (dict, list)):
            yield holder, key, value


def containers(document: Any) -> Iterator[tuple[Any, Any, Any]]:
    """All values in a document, each with what holds it."""
    if not isinstance(document, (dict, list)):
        return
    for key, value in list(document.items() if isinstance(document, dict) else enumerate(document)):
        yield document, key, value
        yield from containers(value)


_ODD: tuple[Any, ...] = (
    None, True, False, 0, 1, -1, 2, 10**30, 0.5, -0.0, 1e300, "", "a", "\ud800", "\0", [], {}, [[]],
    [None], {"": None}, [1, 2, 3],
)  # fmt: skip


def _any_value(kept: Kept, random: Random) -> str:
    """One to three values of any depth are others."""
    document = kept.document()
    for _ in range(int(random.integers(1, 4))):
        holder, key, _ = _one(list(containers(document)), random)
        holder[key] = deepcopy(_one(list(_ODD), random))
    return json.dumps(document)


def _members(kept: Kept, random: Random) -> str:
    """A member is gone, or there is one more."""
    document = kept.document()
    objects = [document, *(v for _, _, v in containers(document) if isinstance(v, dict))]
    chosen = _one(objects, random)
    if chosen and random.integers(2):
        del chosen[_one(list(chosen), random)]
    else:
        chosen["lower"] = kept.fewest + 1
    return json.dumps(document)


def _twice(kept: Kept, random: Random) -> str:  # noqa: ARG001
    """A member appears twice in one object, with other content."""
    return kept.honest[2].replace('"status"', '"status": "optimal", "status"', 1)


def _truncated(kept: Kept, random: Random) -> str:
    return kept.honest[2][: int(random.integers(len(kept.honest[2])))]


def _flipped(kept: Kept, random: Random) -> bytes:
    content = bytearray(kept.honest[2].encode())
    for _ in range(int(random.integers(1, 4))):
        content[int(random.integers(len(content)))] ^= 1 << int(random.integers(8))
    return bytes(content)


def _digit(kept: Kept, random: Random) -> str:
    """One digit of the text is another one."""
    text = kept.honest[2]
    at = _one([k for k, sign in enumerate(text) if sign.isdigit()], random)
    return text[:at] + str(int(random.integers(10))) + text[at + 1 :]


def _deep(kept: Kept, random: Random) -> str:
    """Lists in lists, somewhere."""
    document, depth = kept.document(), int(random.choice([300, 900, 5000, 200_000]))
    holder, key, _ = _one(list(containers(document)), random)
    holder[key] = "HERE"
    nested = (
        '{"a":' * depth + "1" + "}" * depth if random.integers(2) else "[" * depth + "]" * depth
    )
    return json.dumps(document).replace('"HERE"', nested)


def _digits(kept: Kept, random: Random) -> str:
    document = kept.document()
    holder, key, _ = _one(list(leaves(document)), random)
    holder[key] = "HERE"
    return json.dumps(document).replace('"HERE"', _one(["9" * 5000, "NaN", "1e999"], random))


def _no_text(kept: Kept, random: Random) -> bytes:
    text = kept.honest[2]
    forms = [b"", b"\0" * 100, text.encode("utf-16"), b"\xef\xbb\xbf" + text.encode(), b"null"]
    return bytes(_one([*forms, b"[]", b"\xff" + text.encode(), text.encode() * 2], random))


def _seconds(kept: Kept, random: Random) -> str:
    had = _one([1e300, -1.0, 0.0, True, "20", None, [], 20, 10**400], random)
    document = kept.document() | {"seconds": had}
    for solution in document["solutions"]:
        _no_certificates(solution, kept, random)
    return json.dumps(document)


def _no_solutions(kept: Kept, random: Random) -> str:
    return json.dumps(kept.document() | {"solutions": _one([[], None, {}, [[]], [None]], random)})


def _swapped(kept: Kept, random: Random) -> str:  # noqa: ARG001
    return kept.others


def _both(kept: Kept, random: Random) -> str:
    """The other's solutions beside the own ones."""
    document = kept.document()
    document["solutions"] += json.loads(kept.others)["solutions"]
    random.shuffle(document["solutions"])
    return json.dumps(document)


# With each whether nothing that is left in the file proves anything.
TAMPERERS: dict[str, tuple[Tamperer, bool]] = {
    "a bound above the minimum": (_each(_raise), False),
    "the same without a division": (_each(_raise_alone), False),
    "the same, and as many segments stated": (_each(_more_segments), False),
    "two segments with one number": (_each(_fewer_segments), False),
    "fewer segments stated": (_each(_fewer_counted), False),
    "lower and upper stated": (_stated(lower=7, upper=7), False),
    "lower and upper instead of solutions": (
        lambda kept, _: json.dumps({"seconds": 20.0, "lower": kept.fewest, "upper": kept.fewest}),
        True,
    ),
    "no certificates": (_each(_no_certificates), True),
    "no bounds": (_each(_no_bounds), True),
    "certificates with another number": (_each(_forge_certificates), False),
    "certificates twice as long": (_each(_longer_certificates), False),
    "bounds of the paper's space for any division": (_each(_for_surface), False),
    "bounds of another surface": (_each(_others_bounds), False),
    "division of another surface": (_each(_others_cells), False),
    "solution of another surface under this one's name": (_each(_renamed), False),
    "the file of another surface": (_swapped, True),
    "solutions of another surface as well": (_both, False),
    "a sub-cell in another color": (_each(_repainted), False),
    "a cell or sub-cell less": (_each(_dropped), False),
    "another hash of the instance": (_each(_hash), False),
    "another version": (_each(_version), False),
    "other seconds, no certificates": (_seconds, True),
    "no solutions": (_no_solutions, True),
    "any values": (_any_value, False),
    "a member more or less": (_members, False),
    "a member twice": (_twice, False),
    "truncated": (_truncated, False),
    "bits flipped": (_flipped, False),
    "one digit": (_digit, False),
    "nested deeply": (_deep, False),
    "numbers that are none": (_digits, False),
    "no JSON object": (_no_text, True),
}


def what_is_wrong(kept: Kept, content: Text, proves_nothing: bool, random: Random) -> list[str]:
    """What an oracle believes that it must not, where the file of a kept proof has some content.

    One oracle has time for a proof of its own, one has nothing but the file, and the command is
    asked as well; each has to judge a good plan and one by chance as they are.
    """
    name, data = kept.honest[1], _encoded(content)
    plans = [kept.best, any_colors(kept.surface, random)]
    wrong = []
    for alone in (False, True):
        with TemporaryDirectory() as folder, patch.object(door, "prove", _late if alone else prove):
            (Path(folder) / name).write_bytes(data)
            try:
                oracle = KeepingOracle(kept.surface, LIMIT, Path(folder))
                found = oracle.bounds
                if not found.lower <= kept.fewest <= found.upper:
                    wrong.append(f"{found}, {kept.fewest} is the minimum")
                if alone and proves_nothing and found.lower > 1:
                    wrong.append(f"{found}, and nothing proves it")
                if not alone and not found.exact:
                    wrong.append(f"{found}, though there was time")
                for plan in plans:
                    verdict = oracle.judge(plan)
                    wrong += contradictions(oracle, plan, verdict, kept.fewest)
            except Exception as error:
                wrong.append(f"{type(error).__name__}: {error}")
    with TemporaryDirectory() as folder:
        surface, claim = Path(folder) / "a.surface.json", Path(folder) / "a.plan.json"
        surface.write_text(kept.surface.to_json(), encoding="utf-8")
        claim.write_text(Plan(tuple(plans[0])).to_json(), encoding="utf-8")
        cache = Path(folder) / "kept"
        cache.mkdir()
        (cache / name).write_bytes(data)
        with redirect_stdout(StringIO()), redirect_stderr(StringIO()) as said:
            code = run("check", surface, claim, "--cache", cache, "--require-optimal")
        # On a mesh that is too coarse for the best painting no plan is optimal.
        least = segments_counted(kept.surface, plans[0])
        if code != (0 if least == kept.fewest else 1) or said.getvalue():
            wrong.append(f"the command ends with {code}: {said.getvalue()}")
    return wrong


def is_honest(kept: Kept, content: Text) -> bool:
    """Whether the file says what it said before."""
    try:
        return bool(json.loads(_encoded(content)) == kept.document())
    except (ValueError, RecursionError):
        return False


def _encoded(content: Text) -> bytes:
    return content if isinstance(content, bytes) else content.encode("utf-8", "surrogatepass")


def _late(surface: LabelledSurface, deadline: Deadline, **options: Any) -> Proof:
    """A proof that there was no time for."""
    del deadline
    return prove(surface, Deadline.after(-1.0), **options)
