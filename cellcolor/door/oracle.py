"""What is proved about one surface, and what follows for plans: ``cellcolor.Oracle``.

Test suites and ``cellcolor check`` use an oracle that keeps its proofs on disk.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import fields, replace
from os import PathLike
from typing import Any, TypeAlias, Unpack, overload

from numpy.typing import NDArray

from cellcolor.checker.division import check_solution
from cellcolor.checker.vertex_plan import PlanReport, check_plan
from cellcolor.data.plan import ContactPath, JointPlan, Plan
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.trajectory import Trajectory, TrajectoryTable
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.door.asked import Search, options_of
from cellcolor.door.joint_plans import AnyPath, colors_of_joints, path_verdict
from cellcolor.door.reading import color_numbers, read_claim
from cellcolor.door.subject import Result, Solvable, open_subject
from cellcolor.errors import BeatenBound, InputError, TooLarge, naming
from cellcolor.files.writing import path_of
from cellcolor.oracle import BetterPainting, PathVerdict, Proof, ProvenRange, Verdict, prove
from cellcolor.oracle.improvement import better_painting, improvement_of
from cellcolor.oracle.ranges import ProofCache
from cellcolor.painting.paint import paint

SECONDS = 60.0  # of a proof, unless somebody says otherwise

AnyPlan: TypeAlias = (
    Plan
    | Solution
    | Result
    | JointPlan
    | AnyPath
    | Sequence[int | str | None]
    | NDArray[Any]
    | str
    | PathLike[str]
)
"""One color per vertex, a plan, a solution, a plan in joint angles, or the file of one of these."""


class Oracle:
    """Whether plans on one surface are valid, and whether fewer lift-offs are possible.

    The surface is proved once, when the proof is first needed, and the proof serves all plans.
    A planner's test suite keeps one oracle for each surface::

        oracle = cellcolor.Oracle("part.surface.json")
        verdict = oracle.judge(colors)  # one color per vertex, None where it has none
        assert verdict.optimal, verdict

    Attributes:
        surface: the labelled surface.
    """

    def __init__(
        self,
        source: Solvable,
        *,
        bounds: ProvenRange | None = None,
        cache: str | PathLike[str] | None = None,
        **search: Unpack[Search],
    ) -> None:
        """Open the surface; nothing is proved yet.

        Args:
            source: a labelled surface, a scene, or an instance that names its surface: its file,
                its shipped name, the value.
            bounds: this surface's proven range, if it is known already: then nothing is proved,
                and no better plan is looked for.
            cache: a folder where the proof is kept for later processes, and looked for first.
            **search: :class:`~cellcolor.door.asked.Search`: of the proof. The time limit, 60 s if
                it is left out, is one for building a scene as well.

        Raises:
            InputError: the source cannot be used, or has no surface.
            OutOfTime: the time limit came before there was a surface.
        """
        if bounds is not None and not isinstance(bounds, ProvenRange):
            message = f"must be what cellcolor.proven_range returns, is {bounds!r:.100}"
            raise InputError(None, "bounds", message)
        limit = self._time_limit = search.get("time_limit", SECONDS)
        options = options_of(search, Search)
        self._subject = open_subject(source, Deadline.of(self._time_limit))
        self._options: dict[str, Any] = {"workers": options.workers, "seed": options.seed}
        self._cache: ProofCache | None = None
        if cache is not None:
            seconds = float(limit) if isinstance(limit, (int, float)) else Deadline.of(limit).left
            self._cache = ProofCache(path_of(cache), seconds)
        self._known = bounds
        self._proof = None if bounds is None else Proof(bounds)
        self._best: BetterPainting | None = None
        self._painted_in = 0.0
        """Seconds that a painting was not finished in; infinity once no other try is needed."""
        self.surface: LabelledSurface = self._subject.surface

    @property
    def bounds(self) -> ProvenRange:
        """The proven range of the fewest segments; computed when first used.

        Raises:
            InputError: a cell of the surface is not planar, or an option is out of its range.
        """
        return self._prove(Deadline.of(self._time_limit)).bounds

    @property
    def best(self) -> BetterPainting | None:
        """A painting with the fewest segments found; None without time or memory for one."""
        return self._paint(Deadline.of(self._time_limit))

    @overload
    def judge(self, plan: AnyPath, *, deadline: Deadline | None = None) -> PathVerdict: ...

    @overload
    def judge(self, plan: AnyPlan, *, deadline: Deadline | None = None) -> Verdict: ...

    def judge(self, plan: AnyPlan, *, deadline: Deadline | None = None) -> Verdict:
        """The verdict on a plan: is it valid, how many segments has it, can it be beaten and where?

        A plan in joint angles is identified by its type, because a bare array could have one row
        per vertex or one row per sample of a path. It needs a scene.

        Args:
            plan: one color per vertex, its number or its name, None exactly where the vertex has
                none; in an array of integers, which cannot hold None, -1. Or a plan, a solution of
                the surface, or the file of one. Or a configuration per vertex
                (:class:`cellcolor.JointPlan <cellcolor.data.plan.JointPlan>`). Or a tool
                path with its joints
                (:class:`cellcolor.ContactPath <cellcolor.data.plan.ContactPath>`), a
                trajectory, or the file of one, JSON or CSV.
            deadline: for all of it; None for the time limit. Where it comes before a better
                painting is finished, the verdict has no ``improvement``.

        Returns:
            For a tool path a
            :class:`PathVerdict <cellcolor.oracle.verdict.PathVerdict>`.

        Raises:
            BeatenBound: the plan is valid and beats the lower bound; cellcolor is wrong.
            InputError: the plan or the surface cannot be used; a plan in joint angles goes with a
                scene.
            OutOfTime: the deadline came before the colors of a plan in joint angles were known.
        """
        file = str(plan) if isinstance(plan, (str, PathLike)) else None
        if isinstance(plan, (str, PathLike)):
            plan = read_claim(plan)
        deadline = deadline or Deadline.of(self._time_limit)
        if isinstance(plan, (ContactPath, Trajectory, TrajectoryTable)):
            with naming(file):
                path = path_verdict(self._subject, plan, deadline)
            if path.problems:
                return replace(path, bounds=self._known)
            of_colors = self._of_colors(path.plan, deadline)
            own = {member.name: getattr(of_colors, member.name) for member in fields(Verdict)}
            return replace(path, **own)
        if isinstance(plan, JointPlan):
            colors, violations = colors_of_joints(self._subject, plan, deadline)
            if violations:
                problems = tuple(map(str, violations))
                about: dict[str, Any] = {"surface": self.surface, "plan": colors}
                return Verdict(problems, None, self._known, violations, **about)
            plan = colors
        return self._of_colors(plan, deadline)

    def _of_colors(self, plan: Any, deadline: Deadline) -> Verdict:
        """The verdict on a plan in colors, or on a solution."""
        if isinstance(plan, Result):
            plan = plan.solution
        if isinstance(plan, Solution):
            self._subject.check_graph(deadline)
            report = check_solution(self._subject.graph(), plan)
            problems = report.problems
            if not problems and report.segments is None:
                problems = ("cells: null, no division to judge",)
            segments = None if problems else report.segments
            found, given = PlanReport(problems, segments), None
        else:
            given = plan if isinstance(plan, Plan) else Plan(color_numbers(self.surface, plan))
            found = check_plan(self.surface, given)
        about: dict[str, Any] = {"surface": self.surface, "plan": given}
        segments = found.segments
        if segments is None:
            return Verdict(found.problems, None, self._known, found.violations, **about)
        proof = self._prove(deadline)
        bounds = proof.bounds
        if segments < bounds.lower:
            raise BeatenBound(self.surface.name, segments, bounds.lower)
        # The plan shows that as many are enough, however little was proved in time.
        bounds = ProvenRange(bounds.lower, min(bounds.upper, segments))
        if segments == bounds.lower:
            return Verdict((), segments, bounds, why=proof.why_not_fewer, **about)
        improvement, best = None, None if given is None else self._paint(deadline)
        if best is not None:
            improvement = improvement_of(self.surface, found.segment_of, best)
        about["kept_lower"] = proof.kept_lower
        late = best is None and given is not None and math.isfinite(self._painted_in)
        return Verdict((), segments, bounds, improvement=improvement, late=late, **about)

    def _prove(self, deadline: Deadline) -> Proof:
        """The proof about the surface, made once, with what is proved by the deadline."""
        if self._proof is None:
            kept = None if self._cache is None else self._cache.get(self.surface, deadline)
            if kept is None or kept.kept_lower is not None:
                kept = self._proved(kept, deadline)
            self._proof = kept
        return self._proof

    def _proved(self, kept: Proof | None, deadline: Deadline) -> Proof:
        """A new proof, which is kept if it shows as much as the one that was kept.

        Otherwise there was no time to reach the unverified bound of that one. ``kept_lower`` tells
        of it, and the range is what both proofs show.
        """
        with naming(self._subject.path):
            proved = prove(self.surface, deadline, **self._options)
        if kept is None or proved.bounds.lower >= (kept.kept_lower or 0):
            if self._cache is not None:
                self._cache.put(self.surface, proved)
            return proved
        if proved.solution is None or proved.bounds.upper > kept.bounds.upper:
            return kept
        lower = max(kept.bounds.lower, proved.bounds.lower)
        bounds = ProvenRange(lower, proved.bounds.upper)
        return replace(proved, bounds=bounds, kept_lower=kept.kept_lower)

    def _paint(self, deadline: Deadline) -> BetterPainting | None:
        """The painting, made once; an attempt that ran out of time is repeated with twice that.

        So a suite of plans does not pay the time limit again for every one of them.
        """
        proof, seconds = self._prove(deadline), deadline.left
        if seconds > 2 * self._painted_in:
            self._painted_in = math.inf
            if proof.decomposition is not None and proof.solution is not None:
                try:
                    painted = paint(self.surface, proof.decomposition, proof.solution, deadline)
                    self._best = better_painting(self.surface, painted)
                except OutOfTime:
                    self._painted_in = seconds
                except TooLarge:
                    pass
        return self._best

    def __repr__(self) -> str:
        proved = "" if self._proof is None else f", {self._proof.bounds}"
        return f"<{type(self).__name__} of {self.surface.name!r}{proved}>"
