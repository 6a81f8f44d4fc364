"""What the page tells of."""

from __future__ import annotations

from dataclasses import dataclass

from cellcolor.data.solution import Solution
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.decomposition import Decomposition
from cellcolor.frontend import BuildResult
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.painting.paint import Painted
from cellcolor.tool_paths.measures import PathMeasures

__all__ = ["Card", "MotionReport"]


@dataclass(frozen=True)
class Card:
    """A short section of the page.

    Attributes:
        title: its heading.
        paragraphs: whole sentences.
        rows: of a table, the first one its head; none for no table.
        good: whether this is as it should be, None where that is not asked.
    """

    title: str
    paragraphs: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    good: bool | None = None


@dataclass(frozen=True)
class MotionReport:
    """A planned motion, and all that led to it.

    Attributes:
        prepared: the scene, in place.
        built: which colors reach each point.
        decomposition: the graph that was solved, on the surface.
        solution: its solution.
        witness: cells no two of which can share a segment, as many as segments; or none.
        painted: the solution on the surface.
        trajectory: how the arm moves.
        measures: of each tool path that it follows.
        verdict: an independent judge's.
    """

    prepared: PreparedScene
    built: BuildResult
    decomposition: Decomposition
    solution: Solution
    witness: tuple[int, ...]
    painted: Painted
    trajectory: Trajectory
    measures: tuple[PathMeasures, ...]
    verdict: TrajectoryVerdict
