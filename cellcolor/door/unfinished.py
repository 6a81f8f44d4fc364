"""Plans that stop before a motion: what is ready, and why there is no more."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING

from cellcolor.deadline import OutOfTime
from cellcolor.errors import InputError
from cellcolor.files.paths import path_of

if TYPE_CHECKING:
    from cellcolor.data.instance import Instance
    from cellcolor.data.solution import Solution
    from cellcolor.data.tool_paths import ToolPaths
    from cellcolor.door.result import Result
    from cellcolor.door.subject import Subject
    from cellcolor.frontend import BuildReport, BuildResult
    from cellcolor.painting.paint import Painted
    from cellcolor.tool_paths.measures import PathMeasures


@dataclass(frozen=True, repr=False, eq=False)
class UnfinishedPlan:
    """A scene on its way to a motion, as far as it got within the time limit.

    A trajectory is not part of it: none leaves the program without having been judged.

    Attributes:
        subject: the scene, built and decomposed.
        result: the fewest segments that were found, and what is proved; None before the search.
        painted: the segments on the surface, if they were painted.
        paths: where the tool goes, if that was laid out.
        measures: of each of these paths.
    """

    subject: Subject
    result: Result | None = None
    painted: Painted | None = None
    paths: ToolPaths | None = None
    measures: tuple[PathMeasures, ...] = ()

    @property
    def built(self) -> BuildResult:
        """Which colors reach each point."""
        return self.subject.build()

    @property
    def instance(self) -> Instance:
        """The topological graph."""
        return self.subject.graph()

    @property
    def solution(self) -> Solution | None:
        """The solver's answer, which the checker has passed."""
        return None if self.result is None else self.result.solution

    @property
    def missing(self) -> str:
        """What the time limit cut off, as a sentence."""
        if self.result is None or self.result.solution.cells is None:
            cut = "before any division into segments was found"
        elif self.painted is None:
            cut = "before the segments were painted on the surface"
        elif self.paths is None:
            cut = "before the tool paths were laid out"
        else:
            cut = "before the arm's motion on the tool paths was planned and judged"
        return f"The time limit came {cut}."

    def page(self) -> bytes:
        """``report.html``: what there is, and what is missing."""
        from cellcolor.pictures.report_page.content import MotionReport
        from cellcolor.pictures.report_page.page import render_page

        return render_page(
            MotionReport(
                self.built,
                self.subject.decomposition,
                self.solution,
                self.painted,
                None,
                self.measures,
                None,
                self.paths,
                self.missing,
            )
        )

    def save(self, folder: str | PathLike[str]) -> tuple[str, ...]:
        """Write what is ready to a folder, under the file names of a whole plan.

        Raises:
            InputError: a whole plan is there, which is better; or something else that is not
                overwritten; or it cannot be written.
        """
        from cellcolor.door.plan_files import files_so_far, save

        files = files_so_far(self.subject, self.solution, self.painted, self.paths)
        return save(path_of(folder), files | {"report.html": self.page()})

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.missing}>"


class PlanOutOfTime(OutOfTime):
    """The time limit came before a motion was planned and judged.

    Attributes:
        unfinished: what there is.
    """

    def __init__(self, unfinished: UnfinishedPlan) -> None:
        self.unfinished = unfinished
        super().__init__(unfinished.missing)

    def __reduce__(self) -> tuple[type[PlanOutOfTime], tuple[UnfinishedPlan]]:
        # Python would hand the text to __init__, which takes the plan.
        return type(self), (self.unfinished,)


class NothingCovered(InputError):
    """No point of the object can be covered.

    Attributes:
        report: what the build found, reachability by reason among it.
    """

    def __init__(self, report: BuildReport, file: str | None) -> None:
        self.report = report
        super().__init__(file, None, report.nothing_covered or "there is nothing to cover")

    def __reduce__(self) -> tuple[type[NothingCovered], tuple[BuildReport, str | None]]:
        # As in InputError.
        return type(self), (self.report, self.file)
