"""A surface that plans are tested on: assertions that say what is wrong, with a picture."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cached_property
from pathlib import Path

from cellcolor.data.surface import LabelledSurface
from cellcolor.door.oracle import AnyPlan, Oracle
from cellcolor.door.subject import Solvable
from cellcolor.errors import CellcolorError
from cellcolor.oracle import ProvenRange, Verdict
from cellcolor.testing.range_cache import RangeCache

__all__ = ["SurfaceUnderTest", "surfaces_under_test"]


def surfaces_under_test(
    time_limit: float, folder: Path | None, test: str
) -> Callable[[Solvable], SurfaceUnderTest]:
    """What opens surfaces for one test.

    Args:
        time_limit: seconds for each proof.
        folder: where ranges and pictures are kept; None keeps neither.
        test: its name, which pictures are named after.
    """
    return lambda source: SurfaceUnderTest(source, time_limit, folder, test)


class SurfaceUnderTest:
    """What is proved of one surface, and assertions about plans on it.

    Attributes:
        surface: the labelled surface.
    """

    def __init__(self, source: Solvable, time_limit: float, folder: Path | None, test: str) -> None:
        """Open the surface; nothing is proved yet.

        Args:
            source: a labelled surface, a scene, or an instance that names its surface.
            time_limit: seconds for the proof.
            folder: where ranges and pictures are kept; None keeps neither.
            test: name of the test that asks.

        Raises:
            InputError: the source cannot be used, or has no surface.
        """
        self._oracle = Oracle(source, time_limit=time_limit)
        self._time_limit, self._folder, self._test = time_limit, folder, test
        self._cache = None if folder is None else RangeCache(folder)
        self.surface: LabelledSurface = self._oracle.surface

    @cached_property
    def bounds(self) -> ProvenRange:
        """Between what the fewest segments lie; from the cache where it is known there."""
        if self._cache is None:
            return self._oracle.bounds
        found = self._cache.get(self.surface, self._time_limit)
        if found is None:
            found = self._oracle.bounds
            self._cache.put(self.surface, self._time_limit, found)
        return found

    def judge(self, plan: AnyPlan) -> Verdict:
        """The verdict on a plan; of one that can be beaten it says where.

        Args:
            plan: see :meth:`cellcolor.Oracle.judge <cellcolor.door.oracle.Oracle.judge>`.

        Raises:
            BeatenBound: the plan is valid and beats the lower bound; cellcolor is wrong.
            InputError: the plan cannot be used.
        """
        verdict = Oracle(self.surface, bounds=self.bounds).judge(plan)
        return self._oracle.judge(plan) if verdict.beatable_by else verdict

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

        A plan of which that is open passes.

        Raises:
            AssertionError: says where it can be beaten, and where the picture is.
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
        shown = [str(problem) for problem in verdict.problems[:3]]
        lines = [
            f"the plan on {self.surface.name!r} {what}: {verdict}",
            *shown,
            self._picture(verdict),
        ]
        raise AssertionError("\n".join(lines))

    def _picture(self, verdict: Verdict) -> str:
        """Draw the plan; a sentence saying where, or why not."""
        if self._folder is None or verdict.plan is None:
            return "no picture: there is no folder for it, or no plan in vertices"
        folder = self._folder / "pictures"
        folder.mkdir(exist_ok=True)
        file = folder / f"{re.sub('[^A-Za-z0-9]+', '-', self._test).strip('-')[-120:]}.png"
        try:
            verdict.plot(file)
        except CellcolorError as error:
            return f"no picture: {error}"
        return f"picture: {file}"
