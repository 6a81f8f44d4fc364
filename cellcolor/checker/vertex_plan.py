"""The checker of plans: whether a plan is legal on its labelled surface, and its segments."""

from __future__ import annotations

from dataclasses import dataclass

from cellcolor.checker.groups import Groups
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.verdicts import PlanViolation


@dataclass(frozen=True, slots=True)
class PlanReport:
    """The verdict on a plan.

    Attributes:
        problems: what is wrong, each naming its vertex; none when the plan is valid.
        segments: how many were counted, None when the plan is not valid.
        segment_of: the segment of each vertex, -1 where it has no color; numbered in the order of
            their first vertices. Empty when the plan is not valid.
        violations: those of the problems that are about a vertex.
    """

    problems: tuple[str, ...]
    segments: int | None
    segment_of: tuple[int, ...] = ()
    violations: tuple[PlanViolation, ...] = ()

    @property
    def valid(self) -> bool:
        """Every reachable vertex has one of its colors, and no other vertex has one."""
        return not self.problems


def check_plan(surface: LabelledSurface, plan: Plan) -> PlanReport:
    """Check a plan, one color for each vertex, against its surface and count its segments.

    Two vertices of one color are in the same segment if mesh edges without a crack for that color
    lead from one to the other through vertices of that color (docs/formats.md). This looks at the
    mesh alone, never at the topological graph.
    """
    count, given = len(surface.vertices), len(plan.vertex_colors)
    if given != count:
        return PlanReport((f"vertex_colors: {given} entries for {count} vertices",), None)
    violations = []
    for vertex, (color, available) in enumerate(
        zip(plan.vertex_colors, surface.vertex_colors, strict=True)
    ):
        if color is None and available:
            reason = f"null, but colors {list(available)} reach this vertex"
        elif color is not None and not 0 <= color < len(surface.colors):
            reason = f"there is no color {color}"
        elif color is not None and color not in available:
            reason = f"color {color} does not reach this vertex"
        else:
            continue
        x, y, z = surface.vertices[vertex].tolist()
        violations.append(PlanViolation(vertex, color, (x, y, z), reason))
    if violations:
        return PlanReport(tuple(map(str, violations)), None, violations=tuple(violations))
    segments = Groups(v for v, color in enumerate(plan.vertex_colors) if color is not None)
    for a, b in surface.left_of:
        color = plan.vertex_colors[a]
        same = color is not None and color == plan.vertex_colors[b]
        if same and color not in surface.cracked(a, b):
            segments.join(a, b)
    found = segments.sets()  # in the order of their first vertices
    number_of = {vertex: number for number, own in enumerate(found) for vertex in own}
    return PlanReport((), len(found), tuple(number_of.get(v, -1) for v in range(count)))
