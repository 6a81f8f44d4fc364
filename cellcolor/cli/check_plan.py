"""Checking a plan: against its surface, and against what is proved of that."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from cellcolor.cli.painted_files import check_painted, write_painted
from cellcolor.data.plan_verdict import PlanImprovement, PlanVerdict, PlanViolation, SegmentRange
from cellcolor.deadline import Deadline
from cellcolor.door.subject import Subject
from cellcolor.files.writing import is_folder_or_nothing

if TYPE_CHECKING:
    from cellcolor.oracle import Improvement, Verdict

_LISTED = 100  # violations


@dataclass(frozen=True)
class PlanDemands:
    """What is wanted of a plan beyond a verdict.

    Attributes:
        seconds: the time limit, by which kept ranges that are not exact are judged.
        cache: a folder where proven ranges are kept, None for none.
        better: where a painting with fewer segments is written, None for nowhere.
        optimal: only an optimal plan is good enough.
    """

    seconds: float
    cache: Path | None
    better: Path | None
    optimal: bool

    @property
    def first_option(self) -> str | None:
        """The first of the options that was given."""
        given = (("--cache", self.cache), ("--better", self.better))
        found = [name for name, value in given if value is not None]
        return next(iter([*found, *(["--require-optimal"] if self.optimal else [])]), None)


def check_plan_file(
    subject: Subject, claim: Path, name: str, demands: PlanDemands, deadline: Deadline
) -> PlanVerdict:
    """The verdict on a plan's file; writes a better painting where one is known and asked for.

    Args:
        subject: what leads to the surface.
        claim: the file.
        name: what the verdict says that the file is.
        demands: what else is wanted.
        deadline: when to stop with what is proved by then.

    Raises:
        BeatenBound: the plan is valid and beats the lower bound; cellcolor is wrong.
        InputError: surface or plan cannot be used, or a file cannot be written.
    """
    inputs = [path for path in (subject.path, subject.surface_path, claim) if path is not None]
    if demands.better is not None:
        check_painted(demands.better, inputs)
    if demands.cache is not None:
        is_folder_or_nothing(demands.cache)

    from cellcolor.door.oracle import KeepingOracle

    oracle = KeepingOracle(subject, demands.seconds, demands.cache)
    verdict = oracle.judge(claim, deadline=deadline)
    if demands.better is not None and verdict.improvement is not None:
        write_painted(verdict.improvement.better.painted, demands.better, inputs)
    return _described(name, verdict)


def _described(name: str, verdict: Verdict) -> PlanVerdict:
    bounds, on_mesh, segments = verdict.bounds, verdict.on_mesh, verdict.segments
    return PlanVerdict(
        file=name,
        valid=verdict.valid,
        text=str(verdict),
        problems=verdict.problems,
        violation_count=len(verdict.violations),
        violations=tuple(
            PlanViolation(found.vertex, found.color, found.place, found.reason)
            for found in verdict.violations[:_LISTED]
        ),
        segments=segments,
        lift_offs=verdict.lift_offs,
        lower_bound=None if bounds is None else bounds.lower,
        upper_bound=None if bounds is None else bounds.upper,
        optimal=verdict.optimal,
        beatable_by=verdict.beatable_by,
        gap=None if bounds is None or segments is None else segments - bounds.lower,
        on_mesh=None if on_mesh is None else SegmentRange(on_mesh.lower, on_mesh.upper),
        improvement=_improved(verdict.improvement, segments),
        why=verdict.why,
        kept_lower_bound=verdict.kept_lower,
    )


def _improved(found: Improvement | None, segments: int | None) -> PlanImprovement | None:
    if found is None or segments is None:
        return None
    fewer = found.segments_on_mesh < segments
    return PlanImprovement(
        joined=found.joined,
        places=found.places,
        segments=found.segments,
        segments_on_mesh=found.segments_on_mesh,
        vertex_colors=found.better.on_mesh.vertex_colors if fewer else None,
    )
