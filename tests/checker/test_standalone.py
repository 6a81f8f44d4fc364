"""The stand-alone checker against the package's, which shares no code with it."""

from __future__ import annotations

import json
import subprocess
import sys
from copy import deepcopy
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES

from cellcolor.checker.division import check_solution
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from cellcolor.lab.families.registry import SMALL
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options
from examples import examples

FILE = INSTANCES / "check_solution.py"
Random = np.random.Generator


@cache
def standalone() -> ModuleType:
    """The stand-alone checker as a module."""
    module = ModuleType("check_solution")
    exec(compile(FILE.read_text("utf-8"), str(FILE), "exec"), module.__dict__)
    return module


@cache
def solved(family: str, seed: int, space: str) -> tuple[Instance, str]:
    made = SMALL[family](seed)
    instance = made if isinstance(made, Instance) else decompose(made)
    solution = solve(instance, Options(space))  # type: ignore[arg-type]
    bare = tuple(replace(bound, certificate=None) for bound in solution.bounds or ())
    return instance, replace(solution, bounds=bare).to_json()


def any_of(rng: Random, things: list[Any]) -> Any:
    return things[int(rng.integers(len(things)))]


def changed(document: dict[str, Any], instance: Instance, rng: Random) -> None:
    """Change something about a solution; it may stay right by that."""
    cells = document["cells"]
    cell = any_of(rng, cells)
    sub = any_of(rng, cell["subcells"])
    everywhere = [own for each in cells for own in each["subcells"]]
    match int(rng.integers(11)):
        case 0:
            sub["color"] = int(rng.integers(len(instance.colors)))
        case 1:  # a joined edge is cut, on both sides or on one
            if sub["darts"]:
                dart = any_of(rng, sub["darts"])
                other = -dart if isinstance(dart, int) else [-dart[0], dart[1]]
                for own in everywhere if rng.random() < 0.7 else [sub]:
                    own["darts"] = [d for d in own["darts"] if d not in (dart, other)]
        case 2:  # a dart moves to another sub-cell
            if sub["darts"]:
                dart = sub["darts"].pop()
                any_of(rng, cell["subcells"])["darts"].append(dart)
        case 3:  # a sub-cell becomes two
            if len(sub["darts"]) > 1:
                cut = int(rng.integers(1, len(sub["darts"])))
                cell["subcells"].append({**sub, "darts": sub["darts"][cut:]})
                sub["darts"] = sub["darts"][:cut]
        case 4:  # two sub-cells become one
            if len(cell["subcells"]) > 1:
                gone = cell["subcells"].pop()
                cell["subcells"][0]["darts"] += gone["darts"]
        case 5:
            sub["segment"] = int(rng.integers(document["segments"] + 1))
        case 6:
            name = any_of(rng, ["segments", "lift_offs", "lower_bound", "surface_lower_bound"])
            document[name] += int(rng.integers(-1, 2))
        case 7:
            document["status"] = any_of(rng, ["optimal", "feasible", "unknown"])
        case 8:
            document["proved_for_surface"] = not document["proved_for_surface"]
        case 9:  # an edge is joined that was not
            edge = any_of(rng, list(instance.edges) or [None])
            if edge is not None:
                for dart in (edge.id, -edge.id):
                    at = instance.across(-dart)
                    if at >= 0:
                        any_of(rng, cells[at]["subcells"])["darts"].append(dart)
        case 10:
            if document["seams"]:
                seam = any_of(rng, document["seams"])
                seam["strands"] = max(0, seam["strands"] + int(rng.integers(-1, 2)))


def renumbered(document: dict[str, Any]) -> None:
    """Number the segments of a division anew, so that not every change is a wrong number."""
    check = standalone()
    label = {
        (cell["id"], place): sub
        for cell in document["cells"]
        for place, sub in enumerate(cell["subcells"])
    }
    holder = {check.dart_of(d): node for node, sub in label.items() for d in sub["darts"]}
    pairs = [(at, holder[check.twin(d)]) for d, at in holder.items() if check.twin(d) in holder]
    root = check.roots(label, pairs)
    numbers: dict[Any, int] = {}
    for node, sub in label.items():
        sub["segment"] = numbers.setdefault(root[node], len(numbers))
    document |= {"segments": len(numbers), "lift_offs": max(0, len(numbers) - 1)}
    bounds = document["surface_lower_bound"], document["lower_bound"]
    document["proved_for_surface"] = len(numbers) == bounds[0]
    proved = len(numbers) == bounds[document["search_space"] == "paper"]
    document["status"] = "optimal" if proved else "feasible"


def verdicts(instance: Instance, document: dict[str, Any]) -> tuple[bool, bool]:
    """What the package and the stand-alone checker say."""
    try:
        ours = check_solution(instance, Solution.from_document(document)).valid
    except InputError:
        ours = False
    try:
        standalone().check(json.loads(instance.to_json()), document)
        theirs = True
    except (standalone().Wrong, KeyError, TypeError, IndexError, AttributeError):
        theirs = False
    return ours, theirs


@examples(150)
@given(
    family=st.sampled_from(sorted(SMALL)),
    graph=st.integers(0, 15),
    space=st.sampled_from(["paper", "surface"]),
    changes=st.integers(0, 2),
    seed=st.integers(0, 10**6),
    numbered=st.booleans(),
)
def test_both_checkers_agree(
    family: str, graph: int, space: str, changes: int, seed: int, numbered: bool
) -> None:
    instance, text = solved(family, graph, space)
    document = deepcopy(json.loads(text))
    rng = np.random.default_rng(seed)
    for _ in range(changes):
        changed(document, instance, rng)
    if numbered:
        renumbered(document)
    ours, theirs = verdicts(instance, document)
    assert ours == theirs
    assert ours or changes


def test_it_needs_python_alone(tmp_path: Path) -> None:
    """In an empty folder, isolated from everything that is installed."""
    instance, text = solved(min(SMALL), 0, "paper")
    for name, content in (("g.json", instance.to_json()), ("s.json", text)):
        (tmp_path / name).write_text(content, encoding="utf-8")
    (tmp_path / "check.py").write_bytes(FILE.read_bytes())
    command = [sys.executable, "-I", "-S", "check.py", "g.json", "s.json"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == f"valid: {json.loads(text)['segments']} segments\n"
    (tmp_path / "s.json").write_text("no JSON", encoding="utf-8")
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2


@pytest.mark.parametrize("member", ["cells", "bounds", "segments", "status"])
def test_a_member_that_is_no_such_thing_is_said(member: str) -> None:
    instance, text = solved(min(SMALL), 0, "paper")
    document = json.loads(text) | {member: {"no": "such thing"}}
    with pytest.raises((standalone().Wrong, KeyError, TypeError, AttributeError)):
        standalone().check(json.loads(instance.to_json()), document)
