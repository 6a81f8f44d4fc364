"""A kind of bound is one thing: what it says, and a verifier beside it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations

import pytest
from meshes import drawn

import cellcolor
from cellcolor.checker.certificates import VERIFIERS
from cellcolor.checker.proof import Proof, Refused
from cellcolor.data.bounds import KINDS, Bound, BoundKind, Certificate, certificate_of
from cellcolor.data.solution import Solution

SURFACE = drawn("AABB AABB", {"A": [0], "B": [1]})


@dataclass(frozen=True, slots=True)
class Apart(Certificate):
    """Cells that have no color in common."""

    lonely: tuple[int, ...]


def verify_apart(proof: Proof, certificate: Apart, value: int) -> None:
    colors = [{color for color, _ in proof.regions_of(cell)} for cell in certificate.lonely]
    for one, other in combinations(colors, 2):
        proof.count()
        if one & other:
            raise Refused("two of the cells share a color")
    if len(colors) < value:
        raise Refused("there are fewer cells")


@pytest.fixture
def toy(monkeypatch: pytest.MonkeyPatch) -> BoundKind:
    """The kind ``apart``; this is all that a new kind needs."""
    kind = BoundKind(
        "each cell has colors of its own", "It holds for what it holds.", certificate=Apart
    )
    monkeypatch.setitem(KINDS, "apart", kind)
    monkeypatch.setitem(VERIFIERS, "apart", verify_apart)
    return kind


def solved(*cells: int) -> Solution:
    """Two segments, proved by the toy."""
    bound = Bound("apart", 2, "surface", {"lonely": cells})
    return replace(cellcolor.solve(SURFACE).solution, bounds=(bound,))


def test_what_has_a_certificate_has_a_verifier() -> None:
    assert {name for name, kind in KINDS.items() if kind.certificate is not None} == set(VERIFIERS)


@pytest.mark.usefixtures("toy")
def test_a_new_kind_is_told_and_verified() -> None:
    solution = solved(0, 1)
    assert str(solution).endswith(", because each cell has colors of its own")
    (verdict,) = cellcolor.check(SURFACE, solution).bounds
    assert (verdict.outcome, verdict.tried, verdict.trusted) == ("verified", 1, False)
    for cells, reason in (
        ((0, 0), "two of the cells share a color"),
        ((0,), "there are fewer cells"),
        ((0, 7), "there is no cell 7"),
    ):
        report = cellcolor.check(SURFACE, solved(*cells))
        assert report.problems == (f"bounds[0].certificate: {reason}",)
    (bound,) = solution.bounds or ()
    assert certificate_of(bound) == Apart((0, 1))
    assert Apart((0, 1)).to_document() == {"lonely": [0, 1]}


def test_without_kind_or_verifier_it_is_a_claim(monkeypatch: pytest.MonkeyPatch) -> None:
    for table in ({}, {"apart": BoundKind("nobody can verify it", certificate=Apart)}):
        for name, kind in table.items():
            monkeypatch.setitem(KINDS, name, kind)
        (verdict,) = cellcolor.check(SURFACE, solved(0, 0)).bounds
        assert verdict.outcome == "no certificate"


def test_a_new_kind_is_on_the_page(toy: BoundKind) -> None:
    from stand_in import stand_in

    from cellcolor.pictures.report_page.cards import cards_of
    from cellcolor.pictures.report_page.content import MotionReport

    made = stand_in()
    segments = made.solution.surface_lower_bound
    bounds = (Bound("apart", segments, "surface"),)
    solution = replace(made.solution, bounds=bounds)
    decomposition = made.result.subject.decomposition
    report = MotionReport(made.built, decomposition, solution, None, None, None)
    (card,) = [card for card in cards_of(report) if card.title.startswith("Why not fewer")]
    assert card.rows[1:] == (
        (str(segments), "apart", f"Each cell has colors of its own. {toy.objective}"),
    )
    assert toy.because in card.paragraphs[0]
