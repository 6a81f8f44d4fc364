"""Verdicts on plans in joint angles: what is wrong at a vertex, and what is said of a path."""

from __future__ import annotations

from dataclasses import dataclass

from cellcolor.checker.vertex_plan import Violation
from cellcolor.data.wording import count
from cellcolor.oracle.verdict import Verdict

_SHOWN = 3  # vertices that a sentence names


@dataclass(frozen=True, slots=True)
class JointViolation(Violation):
    """Why a configuration, or the lack of one, is wrong at a vertex.

    Attributes:
        joints: the configuration, rad; None if there is none.
        prismatic: the joints whose positions are in m.
    """

    joints: tuple[float, ...] | None = None
    prismatic: tuple[int, ...] = ()

    def __str__(self) -> str:
        place = ", ".join(f"{part:.3f}" for part in self.place)
        if self.joints is None:
            return f"vertex {self.vertex} at ({place}) m: {self.reason}"
        joints = ", ".join(
            f"{value:.4f}" + (" m" if joint in self.prismatic else "")
            for joint, value in enumerate(self.joints)
        )
        return f"vertex {self.vertex} at ({place}) m: {self.reason}; joints ({joints}) rad"


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
        """What is compared with the fewest segments: of two numbers the greater one.

        They are the strokes, cut where the color changes in contact, and the segments of the
        plan. None if the path is not compared.
        """
        if self.segments is None:
            return None
        return max(self.strokes + self.color_changes, self.segments)

    @property
    def optimal(self) -> bool | None:
        """True: proved that no division has fewer segments than :attr:`needed`. False: one has.

        None: neither is proved, or the path is not compared.
        """
        return self._compared.optimal

    @property
    def beatable_by(self) -> int | None:
        """How many segments fewer than :attr:`needed` are proved to be enough, as for a plan."""
        return self._compared.beatable_by

    @property
    def of_colors(self) -> Verdict:
        """The verdict on the plan that the path makes, whatever its strokes."""
        return Verdict(
            self.problems,
            self.segments,
            self.bounds,
            self.violations,
            self.improvement,
            self.why,
            self.late,
            self.kept_lower,
            self.surface,
            self.plan,
        )

    @property
    def _compared(self) -> Verdict:
        return Verdict(self.problems, self.needed, self.bounds)

    def __str__(self) -> str:
        strokes = count(self.strokes, "stroke")
        path = f"path: {strokes}, {count(self.path_lift_offs, 'lift-off')} between them"
        if self.color_changes:
            path += f", {count(self.color_changes, 'change')} of color in contact"
        if self.segments is None:
            return f"{path}\nnot comparable: {self._why_not}"
        lines = [path, f"its colors: {self.of_colors}"]
        if self.strokes + self.color_changes > self.segments:
            more = self.strokes + self.color_changes - self.segments
            lines.append(f"its colors need {count(more, 'lift-off')} fewer than the path has")
        elif self.strokes + self.color_changes < self.segments:
            lines.append(
                "its strokes are fewer than these segments: it jumps between vertices that are not "
                "neighbors, or crosses what it covered in another color"
            )
        return "\n".join(lines)

    @property
    def _why_not(self) -> str:
        """What keeps the path from being compared, with the first vertices or samples."""
        shown = "; ".join(self.problems[:_SHOWN])
        rest = ", …" if len(self.problems) > _SHOWN else ""
        if not self.untouched:
            return f"{shown}{rest}"
        vertices = count(self.reachable, "reachable vertex", "reachable vertices")
        lacking = f"{self.untouched} of {vertices} get no contact in one of their colors"
        return f"{lacking}: {shown}{rest}"
