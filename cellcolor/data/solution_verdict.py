"""Verdicts on solutions, as ``cellcolor check`` prints them for programs in any language."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, TypeAdapter

from cellcolor.files.documents import about_a_file, take_body, validate
from cellcolor.files.validation import settle

FORMAT = "cellcolor/solution-verdict"

_STRICT = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)
_Count = Annotated[int, Field(ge=0)]


@dataclass(frozen=True, slots=True)
class CheckedBound:
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

    __pydantic_config__ = _STRICT

    kind: str
    value: _Count
    holds_for: Literal["surface", "strands"]
    outcome: Literal["verified", "refused", "budget exceeded", "no certificate"]
    reason: str
    tried: _Count
    budget: _Count


@dataclass(frozen=True, slots=True)
class SolutionVerdict:
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

    __pydantic_config__ = _STRICT

    file: str
    valid: bool
    problems: tuple[str, ...]
    segments: _Count | None
    lift_offs: _Count | None
    status: str
    solver: str
    bounds: tuple[CheckedBound, ...]
    bounds_by_solver: _Count
    claimed: dict[str, Any]
    schemes: _Count | None

    def __post_init__(self) -> None:
        settle(self)

    def to_document(self) -> dict[str, Any]:
        """The JSON object, the file's name first."""
        return about_a_file(self, FORMAT)

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> SolutionVerdict:
        """A verdict from a parsed JSON object.

        Raises:
            InputError: a member is missing, unknown or of the wrong type.
        """
        return validate(_ADAPTER, take_body(document, FORMAT))


_ADAPTER = TypeAdapter(SolutionVerdict)
