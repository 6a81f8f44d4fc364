"""A surface that plans are tested on: assertions that say what is wrong, with a picture."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import OutOfTime
from cellcolor.door.drawing import show
from cellcolor.door.oracle import AnyPlan, Oracle
from cellcolor.door.subject import Solvable
from cellcolor.errors import CellcolorError, InputError
from cellcolor.oracle import ProvenRange, Verdict
from cellcolor.testing import PICTURES

_SHOWN = 3  # problems of a plan that is not valid


class SurfaceUnderTest:
    """What is proved of one surface, and assertions about plans on it.

    Attributes:
        surface: the labelled surface.
    """

    def __init__(
        self,
        source: Solvable,
        time_limit: float,
        folder: Path | None,
        record: Callable[[str, str], None],
    ) -> None:
        """Open the surface; nothing is proved yet. Errors show nothing of our own code.

        Args:
            source: a labelled surface, a scene, or an instance that names its surface.
            time_limit: seconds for the proof.
            folder: where proofs and pictures are kept; None keeps neither.
            record: takes the name of a surface and a verdict on it, in one line.

        Raises:
            InputError: the source cannot be used, or has no surface.
            OutOfTime: a scene was not built in time.
        """
        __tracebackhide__ = True
        try:
            self._oracle = Oracle(source, time_limit=time_limit, cache=folder)
        except InputError as error:
            raise error.with_traceback(None) from None
        except OutOfTime:
            message = f"the scene was not built in {time_limit:g} s (--cellcolor-time-limit)"
            raise OutOfTime(message) from None
        self._folder, self._record = folder, record
        self.surface: LabelledSurface = self._oracle.surface

    @property
    def bounds(self) -> ProvenRange:
        """The range of the fewest segments; from the cache where it is known there."""
        return self._oracle.bounds

    def judge(self, plan: AnyPlan) -> Verdict:
        """The verdict on a plan; of one that can be beaten it says where.

        Args:
            plan: see :meth:`cellcolor.Oracle.judge <cellcolor.door.oracle.Oracle.judge>`.

        Raises:
            BeatenBound: the plan is valid and beats the lower bound; cellcolor is wrong.
            InputError: the plan cannot be used.
        """
        __tracebackhide__ = True
        try:
            verdict = self._oracle.judge(plan)
        except InputError as error:
            raise error.with_traceback(None) from None
        self._record(self.surface.name, str(verdict))
        return verdict

    def assert_valid(self, plan: AnyPlan) -> Verdict:
        """Fail unless every reachable vertex has one of its colors, and no other vertex has one.

        Raises:
            AssertionError: says which vertices are wrong, and where the picture is.
        """
        __tracebackhide__ = True
        verdict = self.judge(plan)
        return self._insist(verdict.valid, verdict, "is not valid")

    def assert_not_beatable(self, plan: AnyPlan) -> Verdict:
        """Fail if the plan is not valid, or is proved to have more segments than needed.

        A plan passes if it is not known whether it needs as many.

        Raises:
            AssertionError: says where it can be beaten, and where pictures of it and of a better
                plan are.
        """
        __tracebackhide__ = True
        verdict = self.assert_valid(plan)
        return self._insist(not verdict.beatable_by, verdict, "can be beaten")

    def assert_optimal(self, plan: AnyPlan) -> Verdict:
        """Fail unless the plan is valid and proved to have the fewest segments.

        Raises:
            AssertionError: says where it can be beaten, or that the proof is open, and where the
                picture is.
        """
        __tracebackhide__ = True
        verdict = self.assert_not_beatable(plan)
        return self._insist(verdict.optimal is True, verdict, "is not proved to be optimal")

    def _insist(self, holds: bool, verdict: Verdict, what: str) -> Verdict:
        __tracebackhide__ = True
        if holds:
            return verdict
        if verdict.problems:
            lines = [f"the plan on {self.surface.name!r}: {verdict}"]
            first = map(str, verdict.problems[:_SHOWN])
            lines += [problem for problem in first if problem not in lines[0]]
        else:
            lines = [f"the plan on {self.surface.name!r} {what}: {verdict}"]
        error = AssertionError("\n".join(lines))
        # The plugin calls it once the test has failed; Hypothesis may have raised hundreds before.
        vars(error)[PICTURES] = partial(self._pictures, verdict)
        raise error

    def _pictures(self, verdict: Verdict, test: str) -> list[str]:
        """Draw the plan, and a better one; where they are, or why not, a line each."""
        if self._folder is None:
            return ["no picture: pytest's cache is switched off (--cellcolor-cache DIR keeps it)"]
        if verdict.plan is None:
            return ["no picture: a solution was judged"]
        folder = self._folder / "pictures"
        folder.mkdir(exist_ok=True)
        file = folder / f"{re.sub('[^A-Za-z0-9]+', '-', test).strip('-')[-120:]}.html"
        try:
            verdict.plot(file)
            if verdict.improvement is None:
                return [f"picture: {file}"]
            better = file.with_name(f"{file.stem}-better.html")
            painted, places = verdict.improvement.better.painted, verdict.improvement.places
            show(painted.surface, better, plan=painted.plan, marked=places)
        except CellcolorError as error:
            return [f"no picture: {error}"]
        return [f"picture: {file}", f"better: {better}"]
