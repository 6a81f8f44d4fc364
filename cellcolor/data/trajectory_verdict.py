"""Verdicts on trajectories: what is wrong with one, where and when, and what it covers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cellcolor.data.value import AboutAFile, Count, Value
from cellcolor.data.wording import count
from cellcolor.errors import InputError
from cellcolor.files.validation import settle

FaultKind = Literal[
    "time",
    "jump",
    "joint limit",
    "velocity",
    "acceleration",
    "jerk",
    "pose",
    "off surface",
    "dragged",
    "tilted",
    "turned",
    "invalid",
    "branch",
    "crack",
    "unplanned",
    "claim",
    "lift-offs",
    "uncovered",
    "repeated",
    "feed",
]
"""What can be wrong; docs/judging-trajectories.md says what each one means."""


@dataclass(frozen=True, slots=True)
class Fault(Value):
    """Something that is wrong with a trajectory.

    Attributes:
        kind: what sort of fault.
        text: a sentence with the measure and what is allowed.
        sample: the first sample at fault, or the one before it where the fault lies between two;
            None where no sample is at fault, as with area that none comes near.
        last_sample: the last sample of the same stretch; equal to ``sample`` for a single one.
        time: of ``sample``, s; None without it, and where the trajectory has no times.
        joint: the joint's name, None where the fault is no single joint's.
        reason: the test that fails, of the kind ``invalid``.
        place: where the tool's tip is, or the area, in the world, m.
    """

    kind: FaultKind
    text: str
    sample: int | None = None
    last_sample: int | None = None
    time: float | None = None
    joint: str | None = None
    reason: str | None = None
    place: tuple[float, float, float] | None = None

    def __str__(self) -> str:
        where = "" if self.sample is None else f"sample {self.sample}"
        if self.last_sample is not None and self.last_sample != self.sample:
            where = f"samples {self.sample} to {self.last_sample}"
        if self.time is not None:
            where += f" at {self.time:.3f} s"
        if self.place is not None:
            x, y, z = self.place
            where += f"{' ' if where else ''}({x:.3f}, {y:.3f}, {z:.3f}) m"
        return f"{self.kind}: {where}{': ' if where else ''}{self.text}"


@dataclass(frozen=True, slots=True)
class CoveredArea(Value):
    """What the tool goes over, of the area that the labelled surface has a color for.

    Distances are along the surface. A visit of a point is a pass within half the spacing.

    Attributes:
        reachable_m2: the area that has a color.
        spacing_m: the wanted distance between neighboring passes, from the setup.
        covered_share: share of it within 1.5 times the spacing of a pass.
        closely_covered_share: share of it within 0.75 times the spacing of a pass.
        left_out_share: share of it that the trajectory states to leave out, that is not closely
            covered, and where the segment's configuration is indeed not valid.
        uncovered_m2: the area farther than 1.5 times the spacing from any pass and not so excused.
        mean_visits: of the area visited at all.
        most_visits: of any place.
        visited_again_share: share of the area visited at all that is visited more than once.
        repeated_m: length of the passes that run along an earlier one.
        stated_repeated_m: the part of that length that the trajectory itself states.
        length_m: of all that is done in contact.
        length_times_spacing_per_area: 1 if passes lie side by side at just the spacing.
    """

    reachable_m2: float
    spacing_m: float
    covered_share: float
    closely_covered_share: float
    left_out_share: float
    uncovered_m2: float
    mean_visits: float
    most_visits: int
    visited_again_share: float
    repeated_m: float
    stated_repeated_m: float
    length_m: float
    length_times_spacing_per_area: float

    def __str__(self) -> str:
        again = f"{self.repeated_m:.3f} of {self.length_m:.2f} m along earlier passes"
        again += f", {self.stated_repeated_m:.3f} m of it announced by the trajectory"
        far, near = (f"{1e3 * factor * self.spacing_m:g} mm" for factor in (1.5, 0.75))
        return (
            f"within {far} of a pass {self.covered_share:.2%}, within {near} "
            f"{self.closely_covered_share:.2%}, left out because the arm cannot reach it "
            f"{self.left_out_share:.2%} of the {self.reachable_m2:.4f} m² with a color; "
            f"visits {self.mean_visits:.2f} on average, {self.most_visits} at most, again "
            f"on {self.visited_again_share:.1%}; {again}"
        )


@dataclass(frozen=True, slots=True)
class StrokeFeed(Value):
    """How steadily the tool moves along a stroke.

    Attributes:
        segment: of the painting.
        time: when the stroke begins, s.
        seconds: how long it takes.
        asked_m_per_s: the setup's ``speed_m_per_s``.
        mean_m_per_s: length by time. This and what follows is without the first and the last
            stretch of ``window_m``, in which the tool comes from rest and goes to rest.
        lowest_m_per_s: the lowest mean over a stretch of ``window_m``.
        window_m: the tool's footprint, m.
        slow_share: share of the time in which the tool is slower than 90 % of what is asked.
        joint: that slows it down for the longest time; None if no joint is near a limit.
        limited_by: which limit of that joint, ``velocity`` or ``acceleration``.
    """

    segment: int
    time: float
    seconds: float
    asked_m_per_s: float
    mean_m_per_s: float
    lowest_m_per_s: float
    window_m: float
    slow_share: float
    joint: str | None
    limited_by: Literal["velocity", "acceleration"] | None

    @property
    def why(self) -> str:
        """What slows the stroke down, as the end of a sentence."""
        if self.slow_share < 0.005:  # said as 0 %
            return ""
        if self.joint is None:
            return ", no joint is near a limit"
        return f", because of the {self.limited_by} of {self.joint}"

    def __str__(self) -> str:
        return (
            f"mean feed {self.mean_m_per_s:.3g} m/s of {self.asked_m_per_s:.3g}, lowest "
            f"{self.lowest_m_per_s:.3g} over {1e3 * self.window_m:g} mm, "
            f"{self.slow_share:.0%} of the time below 90 %{self.why}"
        )


@dataclass(frozen=True, slots=True, repr=False)
class TrajectoryVerdict(AboutAFile):
    """What an independent judge finds in a trajectory.

    Attributes:
        valid: whether there is no fault.
        name: the trajectory's.
        samples: how many it has.
        tested: configurations tested, those between distant samples included.
        timed: whether it has times; without them velocities and accelerations are not judged.
        seconds: from the first sample to the last, s; None without times.
        strokes: stretches in contact.
        lift_offs: how often the tool is lifted off between two of them.
        claimed_extra: extra lift-offs that the trajectory itself states, with a reason each.
        minimum_lift_offs: the proven minimum that it is compared with, None if none was given.
        unclaimed_extra: lift-offs beyond the minimum that the trajectory does not state; None
            without a minimum.
        fault_counts: how many faults of each kind there are.
        faults: the first of each kind, at most a hundred of a kind.
        covered: what it covers; None where that is not judged.
        notes: what was not judged, and why, a sentence each.
        feeds: of each stroke; empty without times, or where the setup asks for no feed.
        file: the trajectory as it was named to cellcolor check; in no stored file.
    """

    FORMAT = "cellcolor/trajectory-verdict"
    LINES = ("faults",)

    valid: bool
    name: str
    samples: Count
    tested: Count
    timed: bool
    seconds: float | None
    strokes: Count
    lift_offs: Count
    claimed_extra: Count
    minimum_lift_offs: int | None
    unclaimed_extra: int | None
    fault_counts: dict[FaultKind, int]
    faults: tuple[Fault, ...]
    covered: CoveredArea | None
    notes: tuple[str, ...]
    feeds: tuple[StrokeFeed, ...] = ()
    file: str | None = None

    def __post_init__(self) -> None:
        settle(self)
        if self.valid is bool(self.fault_counts):
            raise InputError(None, "valid", "says something else than fault_counts")

    @property
    def feed_lines(self) -> tuple[str, ...]:
        """What is said of the feed of each stroke."""
        return tuple(f"stroke {number}: {feed}" for number, feed in enumerate(self.feeds))

    def of_kind(self, kind: FaultKind) -> tuple[Fault, ...]:
        """The faults of one kind."""
        return tuple(fault for fault in self.faults if fault.kind == kind)

    def __str__(self) -> str:
        faults = count(sum(self.fault_counts.values()), "fault")
        said = "valid" if self.valid else f"not valid, {faults}"
        return f"{self.name}: {said}, {count(self.lift_offs, 'lift-off')}"
