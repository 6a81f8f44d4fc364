"""``check --cache``: proofs kept for later processes, and what is believed of them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commands import run
from documents import Document
from meshes import drawn
from piped import BEST, BLUE, RED, WORSE, Capture, Pipe, printed, text

import cellcolor.door.oracle
from cellcolor.data.plan import Plan
from cellcolor.data.verdicts import PlanVerdict
from cellcolor.oracle import Proof, ProvenRange


def test_the_proof_is_kept_for_the_next_process(
    row: Path, pipe: Pipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    """Proving fails from the second plan on; even where a plan can be beaten is known."""
    cache = tmp_path / "made" / "proofs"
    pipe(text(BEST))
    assert run("check", row, "-", "--json", "--cache", cache) == 0
    first = printed(capsys)
    assert len(list(cache.iterdir())) == 1
    monkeypatch.setattr(cellcolor.door.oracle, "prove", None)
    pipe(text(BEST))
    assert run("check", row, "-", "--json", "--cache", cache) == 0
    assert printed(capsys) == first
    pipe(text(WORSE))
    assert run("check", row, "-", "--json", "--cache", cache) == 0
    assert printed(capsys)["improvement"]["segments"] == 1


def test_a_cache_that_is_no_folder(row: Path, pipe: Pipe, capsys: Capture) -> None:
    pipe(text(BEST))
    assert run("check", row, "-", "--cache", row) == 2
    assert capsys.readouterr().err == f"cellcolor: {row}: must be a folder\n"


# Two arms in red and two in blue at a bar in both: two segments if the bar is divided, else three.
BAR = drawn(
    "AA.AA AA.AA MMMMM MMMMM BB.BB BB.BB", {"A": [RED], "M": [RED, BLUE], "B": [BLUE], ".": []}
)
BAR_RED = [*[RED, RED, None, RED, RED] * 2, *[RED] * 10, *[BLUE, BLUE, None, BLUE, BLUE] * 2]


def whole_cells_of_the_bar(solution: Document) -> Document:
    """The bar in red as a whole, which is legal, and a bound that says that it is the best."""
    forged: Document = json.loads(json.dumps(solution))
    for cell in forged["cells"]:
        cell["subcells"] = (
            cell["subcells"][:1]
            if len(cell["subcells"]) == 1
            else [sub for sub in cell["subcells"] if sub["color"] == RED]
        )
        if cell["subcells"][0]["color"] == BLUE:
            cell["subcells"][0]["darts"] = []
    numbers: dict[object, int] = {}
    for cell in forged["cells"]:
        (sub,) = cell["subcells"]
        own = "red" if sub["color"] == RED else cell["id"]
        sub["segment"] = numbers.setdefault(own, len(numbers))
    forged |= {"segments": 3, "lift_offs": 2, "lower_bound": 3, "surface_lower_bound": 3}
    forged["bounds"] = [{"kind": "search", "value": 3, "holds_for": "surface"}]
    return forged


def test_a_kept_bound_without_certificate_makes_nothing_optimal(
    tmp_path: Path, pipe: Pipe, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    bar = tmp_path / "bar.surface.json"
    bar.write_text(BAR.to_json(), encoding="utf-8")
    plan = Plan(tuple(BAR_RED)).to_json()
    asked = ("check", bar, "-", "--cache", tmp_path / "c", "--json", "--require-optimal")
    pipe(plan)
    assert run(*asked) == 1
    assert printed(capsys)["lower_bound"] == 2
    (kept,) = (tmp_path / "c").iterdir()
    document = json.loads(kept.read_text(encoding="utf-8"))
    forged = whole_cells_of_the_bar(document["solutions"][0])
    kept.write_text(json.dumps(document | {"solutions": [forged]}), encoding="utf-8")
    # Without time to prove it anew the bound is told, and nothing rests on it.
    with monkeypatch.context() as hurried:
        nothing = Proof(ProvenRange(1, 26))
        hurried.setattr(cellcolor.door.oracle, "prove", lambda *_, **__: nothing)
        pipe(plan)
        assert run(*asked) == 3
    verdict = PlanVerdict.from_document(printed(capsys))
    assert verdict.optimal is None and verdict.lower_bound == 1
    assert verdict.kept_lower_bound == 3 and "kept, not verified: at least 3" in verdict.text
    # With time it is refuted, and the verdict is the first one again.
    pipe(plan)
    assert run(*asked) == 1
    verdict = PlanVerdict.from_document(printed(capsys))
    assert verdict.upper_bound == 2 and verdict.optimal is False
