"""What ``cellcolor check`` prints about solutions and plans, for programs in any language."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from cellcolor.data.value import AboutAFile, Count, Value
from cellcolor.data.wording import count
from cellcolor.errors import InputError
from cellcolor.files.validation import settle


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


@dataclass(frozen=True, slots=True)
class PlanViolation(Value):
    """Why a plan is not valid at a vertex.

    Attributes:
        vertex: the vertex.
        color: the color that the plan has there, null for none.
        place: where the vertex is, m.
        reason: what is wrong, a clause.
    """

    vertex: Count
    color: int | None
    place: tuple[float, float, float]
    reason: str

    def __str__(self) -> str:
        return f"vertex_colors[{self.vertex}]: {self.reason}"


@dataclass(frozen=True, slots=True)
class ProvenRange(Value):
    """The range that the fewest segments of a surface lie in, both ends included.

    Attributes:
        lower: there cannot be fewer.
        upper: this many are known to be enough.

    Raises:
        InputError: the two are no range of whole numbers from 0 on.
    """

    lower: Count
    upper: Count

    def __post_init__(self) -> None:
        settle(self)
        if self.lower > self.upper:
            message = f"must be 0 or more and at most upper, {self.upper}; is {self.lower}"
            raise InputError(None, "lower", message)

    @property
    def exact(self) -> bool:
        """The minimum is known."""
        return self.lower == self.upper

    def __str__(self) -> str:
        if self.exact:
            return f"exactly {count(self.lower, 'segment')}"
        return f"between {self.lower} and {count(self.upper, 'segment')}"


@dataclass(frozen=True, slots=True)
class PlanImprovement(Value):
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

    joined: tuple[int, int]
    places: tuple[int, int]
    segments: Count
    segments_on_mesh: Count
    vertex_colors: tuple[int | None, ...] | None


@dataclass(frozen=True, slots=True)
class PlanVerdict(AboutAFile):
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
        upper_bound: a division of the surface with this many segments exists; null when nothing was
            proved.
        optimal: true or false where that is proved, null where it is open or the plan not valid.
        beatable_by: how many segments fewer are proved to be enough; 0 only where it is proved that
            no fewer are, null where that is open or the plan not valid.
        gap: how many segments more than lower_bound, which is the most that can be saved; null
            when the plan is not valid.
        on_mesh: the range of the fewest segments of plans on this mesh, as far as it is known.
        improvement: how it can have fewer segments; null where no such painting is known.
        why: of an optimal plan why there cannot be fewer segments, a clause; null where nothing
            needs a reason or none is known.
        kept_lower_bound: a greater lower bound that was kept without a certificate: it is not
            verified, and nothing else here rests on it; null if there is none.
    """

    FORMAT = "cellcolor/plan-verdict"

    file: str
    valid: bool
    text: str
    problems: tuple[str, ...]
    violation_count: Count
    violations: tuple[PlanViolation, ...]
    segments: Count | None
    lift_offs: Count | None
    lower_bound: Count | None
    upper_bound: Count | None
    optimal: bool | None
    beatable_by: Count | None
    gap: Count | None
    on_mesh: ProvenRange | None
    improvement: PlanImprovement | None
    why: str | None
    kept_lower_bound: Count | None = None


@dataclass(frozen=True, slots=True)
class CheckError(AboutAFile):
    """Why nothing can be said about a solution, a plan or a trajectory.

    Attributes:
        file: what was to be checked, as the command named it; ``-`` for standard input.
        valid: null, as it is not known.
        error: what is wrong, one line that names file and member.
        at_file: the file at fault, null if no single one is.
        at_field: the member at fault, such as ``vertex_colors[3]``, or null.
        exit_code: the command's: 2 for bad input, 3 where the time limit came first.
    """

    FORMAT = "cellcolor/check-error"

    file: str
    valid: None
    error: str
    at_file: str | None
    at_field: str | None
    exit_code: Literal[2, 3]
