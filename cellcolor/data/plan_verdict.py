"""Verdicts on plans, as ``cellcolor check`` prints them for programs in any language."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import ConfigDict, Field, TypeAdapter

from cellcolor.files.documents import about_a_file, take_body, validate
from cellcolor.files.validation import settle

FORMAT = "cellcolor/plan-verdict"

_STRICT = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)
_Count = Annotated[int, Field(ge=0)]


@dataclass(frozen=True, slots=True)
class PlanViolation:
    """Why a plan is not valid at a vertex.

    Attributes:
        vertex: the vertex.
        color: the color that the plan has there, null for none.
        place: where the vertex is, m.
        reason: what is wrong, a clause.
    """

    __pydantic_config__ = _STRICT

    vertex: _Count
    color: int | None
    place: tuple[float, float, float]
    reason: str


@dataclass(frozen=True, slots=True)
class SegmentRange:
    """The range of a number of segments, both ends included.

    Attributes:
        lower: there cannot be fewer.
        upper: this many are known to be enough.
    """

    __pydantic_config__ = _STRICT

    lower: _Count
    upper: _Count


@dataclass(frozen=True, slots=True)
class PlanImprovement:
    """How a plan can have fewer segments.

    Attributes:
        joined: two segments of the plan that can be one, numbered by their first vertices, 0 being
            that of the first vertex with a color.
        places: a vertex of each, well inside what can be joined.
        segments: of a better painting, on the surface refined where necessary.
        segments_on_mesh: of that painting as far as the unrefined mesh can show it.
        vertex_colors: the better plan on the mesh as it is; null where the mesh is too coarse for
            it to have fewer segments than the plan that was judged.
    """

    __pydantic_config__ = _STRICT

    joined: tuple[int, int]
    places: tuple[int, int]
    segments: _Count
    segments_on_mesh: _Count
    vertex_colors: tuple[int | None, ...] | None


@dataclass(frozen=True, slots=True)
class PlanVerdict:
    """The verdict on a plan.

    Attributes:
        file: the plan as the command named it; ``-`` for standard input.
        valid: every reachable vertex has one of its colors, and no other vertex has one.
        text: the verdict in a sentence.
        problems: why the plan is not valid, each naming its vertex; empty when it is.
        violation_count: how many vertices are wrong.
        violations: the first hundred of them.
        segments: of the plan; null when it is not valid.
        lift_offs: max(0, segments - 1); null when the plan is not valid.
        lower_bound: no division of the surface has fewer segments; null when nothing was proved.
        upper_bound: a division of the surface with so many segments exists; null when nothing was
            proved.
        optimal: true or false where that is proved, null where it is open or the plan not valid.
        beatable_by: how many segments fewer are proved to be enough; 0 only where it is proved that
            no fewer are, null where that is open or the plan not valid.
        gap: how many segments more than lower_bound, which is the most that can be saved; null
            when the plan is not valid.
        on_mesh: between what the fewest segments of plans on this mesh lie, as far as is known.
        improvement: how it can have fewer segments; null where no such painting is known.
        why: of an optimal plan why there cannot be fewer segments, a clause; null where nothing
            needs a reason or none is known.
        kept_lower_bound: a greater lower bound that was kept without a certificate: it is not
            verified, and nothing else here rests on it; null if there is none.
    """

    __pydantic_config__ = _STRICT

    file: str
    valid: bool
    text: str
    problems: tuple[str, ...]
    violation_count: _Count
    violations: tuple[PlanViolation, ...]
    segments: _Count | None
    lift_offs: _Count | None
    lower_bound: _Count | None
    upper_bound: _Count | None
    optimal: bool | None
    beatable_by: _Count | None
    gap: _Count | None
    on_mesh: SegmentRange | None
    improvement: PlanImprovement | None
    why: str | None
    kept_lower_bound: _Count | None = None

    def __post_init__(self) -> None:
        settle(self)

    def to_document(self) -> dict[str, Any]:
        """The JSON object, the file's name first."""
        return about_a_file(self, FORMAT)

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> PlanVerdict:
        """A verdict from a parsed JSON object.

        Raises:
            InputError: a member is missing, unknown or of the wrong type.
        """
        return validate(_ADAPTER, take_body(document, FORMAT))


_ADAPTER = TypeAdapter(PlanVerdict)
