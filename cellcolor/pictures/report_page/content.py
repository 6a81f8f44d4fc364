"""What the page tells of."""

from __future__ import annotations

from dataclasses import dataclass

from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.decomposition import Decomposition
from cellcolor.frontend import BuildResult
from cellcolor.painting.paint import Painted
from cellcolor.questions.answers import Explanation, Front
from cellcolor.questions.placements import Placements
from cellcolor.questions.set_ups import SetUpPlan


@dataclass(frozen=True)
class Card:
    """A short section of the page.

    Attributes:
        title: its heading.
        paragraphs: whole sentences.
        rows: of a table, the first one its head; none for no table.
        good: whether this is as it should be, None where that is not asked.
        modes: for each row after the head the way to fill the part that it shows, by name.
        times: for each row after the head the moment that it leads to, s, None for none.
    """

    title: str
    paragraphs: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    good: bool | None = None
    modes: tuple[str, ...] = ()
    times: tuple[float | None, ...] = ()


Answers = Front | Explanation | Placements | SetUpPlan
"""What a page can tell besides the plan."""


@dataclass(frozen=True)
class AnsweredScene:
    """Answers, and what they are about.

    Attributes:
        surface: of the scene, nothing left out.
        decomposition: its graph.
        answers: on it.
    """

    surface: LabelledSurface
    decomposition: Decomposition
    answers: tuple[Answers, ...]


@dataclass(frozen=True)
class MotionReport:
    """A planned motion, and all that led to it, or as much of that as there is.

    Attributes:
        built: which colors reach each point.
        decomposition: the graph that was solved, on the surface.
        solution: its solution, None before the search.
        painted: the solution on the surface; None if it was not painted.
        trajectory: how the arm moves; None if that was not planned or not judged.
        verdict: an independent judge's; None without a trajectory.
        paths: the tool paths, which are drawn if there is no trajectory.
        missing: what of this there is not, and why, as a sentence; empty for a whole plan.
        answered: what was asked besides.
        programs: the names of those for the arm's controller.
        lacking: what was asked for or is usual and is not there, a line each with the reason.
    """

    built: BuildResult
    decomposition: Decomposition
    solution: Solution | None
    painted: Painted | None
    trajectory: Trajectory | None
    verdict: TrajectoryVerdict | None
    paths: ToolPaths | None = None
    missing: str = ""
    answered: AnsweredScene | None = None
    programs: tuple[str, ...] = ()
    lacking: tuple[str, ...] = ()
