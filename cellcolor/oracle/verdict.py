"""What is said of a plan or a tool path: is it valid, how many segments, can it be beaten?"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from os import PathLike
from typing import TYPE_CHECKING

from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.verdicts import PlanViolation, ProvenRange
from cellcolor.data.wording import count, lift_offs_of, segments_and_lift_offs
from cellcolor.errors import InputError
from cellcolor.oracle.improvement import Improvement

if TYPE_CHECKING:
    import cellcolor

_SHOWN = 3  # vertices that a sentence names


@dataclass(frozen=True, slots=True, repr=False)
class Verdict:
    """The verdict on a plan.

    Attributes:
        problems: why the plan is not valid, each naming its vertex; none when it is.
        segments: of the plan; None when it is not valid.
        bounds: the proven range for any division of the surface; None when the plan is not valid
            and nothing was proved.
        violations: those of the problems that are about a vertex, with its place.
        improvement: a plan with fewer segments, and what it joins; None where none is known.
        why: of an optimal plan why there cannot be fewer segments, a clause, if that is known.
        late: whether the time limit came before it was known which segments can be joined.
        kept_lower: a lower bound that was kept on disk without a certificate, greater than that in
            ``bounds``: nothing has verified it, and nothing here rests on it.
        plan: what was judged, of a plan in joint angles the colors that it comes to, -1 where a
            configuration has none; None for a solution.
    """

    problems: tuple[str, ...]
    segments: int | None
    bounds: ProvenRange | None
    violations: tuple[PlanViolation, ...] = field(default=(), compare=False)
    improvement: Improvement | None = field(default=None, compare=False)
    why: str | None = field(default=None, compare=False)
    late: bool = field(default=False, compare=False)
    kept_lower: int | None = field(default=None, compare=False)
    surface: LabelledSurface | None = field(default=None, compare=False)
    plan: Plan | None = field(default=None, compare=False)

    @property
    def valid(self) -> bool:
        """Every reachable vertex has one of its colors, and no other vertex has one."""
        return not self.problems

    @property
    def lift_offs(self) -> int | None:
        """``max(0, segments - 1)``; None when the plan is not valid."""
        return None if self.segments is None else lift_offs_of(self.segments)

    @property
    def optimal(self) -> bool | None:
        """True: proved to be. False: proved not to be. None: neither, or the plan is not valid."""
        return None if self.beatable_by is None else self.beatable_by == 0

    @property
    def beatable_by(self) -> int | None:
        """How many segments fewer are proved to be enough.

        0 only if it is proved that no division of the surface has fewer; None where neither is
        proved, or when the plan is not valid. The division that proves it cuts the surface itself:
        :attr:`on_mesh` has the range for plans on the mesh, which may be too coarse for it.
        """
        if self.segments is None or self.bounds is None:
            return None
        if self.segments > self.bounds.upper:
            return self.segments - self.bounds.upper
        return 0 if self.segments == self.bounds.lower else None

    @property
    def on_mesh(self) -> ProvenRange | None:
        """The range of the fewest segments of plans on this mesh, as far as it is known.

        None when the plan is not valid or nothing was proved.
        """
        if self.segments is None or self.bounds is None:
            return None
        best = self.segments
        if self.improvement is not None:
            best = min(best, self.improvement.segments_on_mesh)
        return ProvenRange(self.bounds.lower, best)

    def plot(self, path: str | PathLike[str] | None = None) -> cellcolor.Drawing:
        """Draw the plan by segment, or where it is not valid.

        Of a plan that can be beaten the two segments that can be joined are marked.

        Args:
            path: a file .html, .png or .svg; None draws without writing, for notebooks.

        Raises:
            InputError: a solution was judged, which is drawn by its result; the extra ``viz`` is
                not installed, or the file cannot be written.
        """
        if self.surface is None or self.plan is None:
            raise InputError(None, "plan", "is a solution; cellcolor.show draws it")
        import cellcolor  # the whole package's face, which only somebody who looks at it needs

        joined = None if self.improvement is None else self.improvement.places
        return cellcolor.show(self.surface, path, plan=self.plan, marked=joined)

    def __str__(self) -> str:
        if self.segments is None:
            more = len(self.problems) - 1
            rest = f" (and {count(more, 'other problem')})" if more > 0 else ""
            return f"not valid: {self.problems[0]}{rest}"
        found = segments_and_lift_offs(self.segments)
        if self.bounds is None:
            return found
        if self.optimal:
            because = "" if self.why is None else f", because {self.why}"
            return f"{found}, optimal: no division of the surface has fewer{because}"
        if self.beatable_by:
            where = "; the time limit came before an example was found" if self.late else ""
            if self.improvement is not None:
                where = f"; {self.improvement}"
            fewer = count(self.beatable_by, "fewer is", "fewer are")
            return f"{found}, {fewer} proved to be enough{where}"
        text = f"{found}, not known to be optimal; the fewest are {self.bounds}"
        kept = self.kept_lower
        return text if kept is None else f"{text}; kept, not verified: at least {kept}"

    def __repr__(self) -> str:
        # What pytest prints of ``assert verdict.optimal, verdict``.
        return f"<{type(self).__name__}: {self}>"


@dataclass(frozen=True, slots=True)
class JointViolation(PlanViolation):
    """Why a configuration, or the lack of one, is wrong at a vertex.

    Attributes:
        joints: the configuration, rad, but in m for those that are ``prismatic``.
    """

    joints: tuple[float, ...] | None = None
    prismatic: tuple[int, ...] = ()

    def __str__(self) -> str:
        place = ", ".join(f"{part:.3f}" for part in self.place)
        text = f"vertex {self.vertex} at ({place}) m: {self.reason}"
        if self.joints is None:
            return text
        joints = ", ".join(
            f"{value:.4f}" + (" m" if joint in self.prismatic else "")
            for joint, value in enumerate(self.joints)
        )
        return f"{text}; joints ({joints}) rad"


@dataclass(frozen=True, slots=True, repr=False)
class PathVerdict(Verdict):
    """What is to be said about a tool path.

    A path is compared with the proven minimum if every vertex with colors gets a contact in one of
    them; then it is called valid. ``segments`` and ``lift_offs`` are those of the plan that gives
    each vertex the color of its first contact, ``plan``. ``strokes`` and ``path_lift_offs`` are the
    path's own. docs/semantics.md, section 9, says which of them can be less than which.

    Attributes:
        strokes: stretches of the path in contact.
        color_changes: how often the color changes in contact, from one vertex to the next; colors
            are not continuous with each other, so the arm would have to lift off there.
        runs: into how many stretches the path falls that stay in one segment each by going from
            neighbor to neighbor; never fewer than ``segments``. None if it is not compared.
        reachable: how many vertices have colors.
        untouched: how many of them get no contact in one of their colors.
    """

    strokes: int = 0
    color_changes: int = 0
    runs: int | None = None
    reachable: int = 0
    untouched: int = 0

    @property
    def path_lift_offs(self) -> int:
        """``max(0, strokes - 1)``: how often the path says that it lifts the tool off."""
        return max(0, self.strokes - 1)

    @property
    def needed(self) -> int | None:
        """What is compared with the fewest segments; None if the path is not compared.

        It is the greater one of the strokes, cut where the color changes in contact, and the
        segments of the plan.
        """
        if self.segments is None:
            return None
        return max(self.strokes + self.color_changes, self.segments)

    @property
    def beatable_by(self) -> int | None:
        """As for a plan: how many segments fewer than :attr:`needed` are proved to be enough."""
        return Verdict(self.problems, self.needed, self.bounds).beatable_by

    @property
    def of_colors(self) -> Verdict:
        """The verdict on the plan that the path makes, whatever its strokes."""
        return Verdict(*(getattr(self, member.name) for member in fields(Verdict)))

    def __str__(self) -> str:
        strokes = count(self.strokes, "stroke")
        path = f"path: {strokes}, {count(self.path_lift_offs, 'lift-off')} between them"
        if self.color_changes:
            path += f", {count(self.color_changes, 'change')} of color in contact"
        if self.segments is None:
            return f"{path}\nnot comparable: {self._why_not}"
        lines = [path, f"its colors: {self.of_colors}"]
        more = self.strokes + self.color_changes - self.segments
        if more > 0:
            lines.append(f"its colors need {count(more, 'lift-off')} fewer than the path has")
        elif more < 0:
            lines.append(
                "its strokes are fewer than these segments: it jumps between vertices that are not "
                "neighbors, or crosses what it covered in another color"
            )
        return "\n".join(lines)

    @property
    def _why_not(self) -> str:
        """What keeps the path from being compared, with the first vertices or samples."""
        shown = "; ".join(self.problems[:_SHOWN])
        shown += ", …" if len(self.problems) > _SHOWN else ""
        if not self.untouched:
            return shown
        vertices = count(self.reachable, "reachable vertex", "reachable vertices")
        return f"{self.untouched} of {vertices} get no contact in one of their colors: {shown}"
