"""The depth-first searches, their divisions seen by the checker."""

from __future__ import annotations

from cellcolor.checker.division import check_division
from cellcolor.data.instance import Instance
from cellcolor.solvers.dfs import CoverReferenceSolver, ReferenceSolver
from cellcolor.solvers.interface import Answer, Options

SOLVER = ReferenceSolver()
COVERED = CoverReferenceSolver()
SURFACE = Options(search_space="surface", strands=2)


def segments(instance: Instance, answer: Answer, strands: int = 1) -> int:
    """The segments of an answer that the checker passes."""
    assert answer.division is not None
    report = check_division(instance, answer.division, answer.seams, strands)
    assert report.valid and report.segments is not None, report.problems
    return report.segments
