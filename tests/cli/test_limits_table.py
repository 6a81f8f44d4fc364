"""What ``benchmarks/limits.py`` calls wrong, lost and late, and a run of it."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from library import INSTANCES

import cellcolor
from cellcolor.data.surface import LabelledSurface

sys.path.append(str(INSTANCES.parent / "benchmarks"))
import limits
import limits_answers

VALID = json.dumps({"valid": True})


def answer(**changes: Any) -> str:
    """What ``solve --json`` prints of the ring."""
    solution = cellcolor.solve(ring(), workers=1).solution
    return json.dumps({"file": "ring.surface.json"} | solution.to_document() | changes)


def ring() -> LabelledSurface:
    (file,) = INSTANCES.rglob("ring.surface.json")
    return LabelledSurface.read(file)


@pytest.mark.parametrize(
    ("said", "wrong"),
    [
        (answer(), ""),
        ('{"status": "unknown", "error": "the time limit came first"}', ""),
        (answer(error="the library says 1"), "the library says 1"),
        (answer(segments=1, lift_offs=0), "segments"),
        ("Trace", "no answer"),
        ("", "no answer"),
        ('{"valid": true, "lower_bound": 2, "segments": 2}', ""),
        ('{"valid": true, "lower_bound": 3, "segments": 2}', "at least 3, with 2"),
    ],
)
def test_what_is_wrong_in_an_answer(said: str, wrong: str) -> None:
    found = limits_answers.wrong_in_answer(said, ring())
    assert wrong in found if wrong else not found


def test_a_solution_of_something_else_is_wrong() -> None:
    recolored = replace(ring(), vertex_colors=tuple(own[:1] for own in ring().vertex_colors))
    assert limits_answers.wrong_in_answer(answer(), recolored)


@pytest.mark.parametrize(
    ("code", "files", "wrong"),
    [
        (3, {}, ""),
        (3, {"solution.json": "{}", "report.html": "<html></html>"}, ""),
        (3, {"trajectory.json": "{}", "verdict.json": VALID}, ""),
        (0, {"trajectory.json": "{}", "verdict.json": VALID}, "done, with 2 files"),
        (2, {}, "exit code 2"),
        (3, {"solution.json": '{"cells": ['}, "solution.json is not whole"),
        (3, {"report.html": "<html>"}, "report.html is not whole"),
        (3, {"instance.reasons.npz": "PK"}, "instance.reasons.npz is not whole"),
        (3, {"tmp1234": "{}"}, "left behind: tmp1234"),
        (3, {"trajectory.json": "{}"}, "a motion without its verdict"),
        (3, {"joints.csv": "time", "verdict.json": '{"valid": false}'}, "a motion that is not"),
    ],
)
def test_what_is_wrong_in_a_folder(
    code: int, files: dict[str, str], wrong: str, tmp_path: Path
) -> None:
    for name, content in files.items():
        (tmp_path / name).write_text(content)
    found = limits_answers.wrong_in_plan(code, tmp_path)
    assert found.startswith(wrong) if wrong else not found


def run(**changes: Any) -> limits.Run:
    given: dict[str, Any] = {"kind": "disc", "seed": 0, "variant": "paper", "status": "optimal"}
    given |= {"seconds": 2.0, "cpu": 1.0, "over": -0.1, "waited": 0.0, "megabytes": 99.0}
    return limits.Run(**given | {"end": "itself", "exit_code": 0} | changes)


def test_the_table_counts_wrong_lost_and_late() -> None:
    runs = [
        run(),
        run(over=0.5, waited=0.6),
        run(over=0.5, waited=0.4),
        run(wrong="two segments are one"),
        run(status=None, exit_code=2, error="Traceback: KeyError: 1"),
        run(kind="plan", variant="plan", status=None, exit_code=3),
        run(kind="plan", variant="plan", status=None, exit_code=2, error="Traceback: KeyError: 1"),
    ]
    table = list(limits.table(runs))[:5]
    rows = {line.split(" | ")[0]: line.split(" | ")[1:6] for line in table}
    assert rows["| disc"] == ["5", "1", "1", "1", "1"]
    assert rows["| plan"] == ["2", "0", "1", "0", "1"]
    assert rows["| all"] == ["7", "1", "2", "1", "2"]


def test_the_oracle_on_a_ring(tmp_path: Path) -> None:
    found = limits.drawn("rings", 10, tmp_path, [5.0])
    assert (found.variant, found.exit_code, found.wrong, found.lost) == ("check", 0, "", False)
    assert found.bound is not None and list(tmp_path.iterdir()) == []
