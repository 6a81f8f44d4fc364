"""Verdicts on solutions, as ``cellcolor check`` prints them for programs in any language."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from cellcolor.data.value import AboutAFile, Count, Value


@dataclass(frozen=True, slots=True)
class CheckedBound(Value):
    """The outcome of verifying a solution's bound.

    Attributes:
        kind: how the bound was proved.
        value: there are no fewer segments.
        holds_for: any division of the surface, or those with the solution's strands.
        outcome: verified, refused, or taken on trust: budget exceeded, or no certificate.
        reason: why it was refused, a sentence; empty otherwise.
        tried: how many choices were tried.
        budget: how many could have been tried.
    """

    kind: str
    value: Count
    holds_for: Literal["surface", "strands"]
    outcome: Literal["verified", "refused", "budget exceeded", "no certificate"]
    reason: str
    tried: Count
    budget: Count


@dataclass(frozen=True, slots=True)
class SolutionVerdict(AboutAFile):
    """The verdict on a solution.

    Attributes:
        file: the solution as the command named it; ``-`` for standard input.
        valid: nothing is wrong with its division, its numbers and its schemes.
        problems: what is wrong, each naming its element; empty when it is valid.
        segments: counted in its division; null when that is not legal.
        lift_offs: max(0, segments - 1); null when the division is not legal.
        status: the solution's own.
        solver: what has found it.
        bounds: what came of verifying each of its bounds by its certificate.
        bounds_by_solver: how many of them rest on the solver.
        claimed: the members that nothing has verified, with what they say.
        schemes: how many follow the solution in its file; null for none.
    """

    FORMAT = "cellcolor/solution-verdict"

    file: str
    valid: bool
    problems: tuple[str, ...]
    segments: Count | None
    lift_offs: Count | None
    status: str
    solver: str
    bounds: tuple[CheckedBound, ...]
    bounds_by_solver: Count
    claimed: dict[str, Any]
    schemes: Count | None
