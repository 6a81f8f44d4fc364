"""The area judged: what is covered, what is rightly left out, what is gone over twice."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.data.trajectory_verdict import CoveredArea
from cellcolor.deadline import Deadline
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.setup import Motion
from cellcolor.trajectory_checker.contact import Contact
from cellcolor.trajectory_checker.covered import FAR, NEAR, Reached, covered_by, failing_places
from cellcolor.trajectory_checker.fault_list import FaultList, stretches
from cellcolor.trajectory_checker.fine_mesh import FineMesh
from cellcolor.trajectory_checker.repeated import Repeated, Strips, passes, repeated_stretches
from cellcolor.trajectory_checker.stated import judge_left_out
from cellcolor.trajectory_checker.tolerances import Limits

_VISIT = 0.5  # spacings; a pass this close to a point is a visit of it
_ALONG = 0.25  # spacings; a pass this close to an earlier one runs along it
_BESIDE = 1.25  # spacings; by so much more than the overlap both sides visit the same places
_APART = 2.0  # spacings of path between two places that belong to two passes
_THINNED = 0.1  # spacings of path between two places of contact that are measured with


def judge_area(
    built: BuildResult,
    contact: Contact,
    fine: FineMesh,
    motion: Motion,
    limits: Limits,
    faults: FaultList,
    deadline: Deadline,
) -> CoveredArea:
    """Measure what is covered, and note what is not, and what is gone over too often.

    Args:
        contact: where the tip is on the surface; nothing else covers anything.
        limits: what has to be covered, and what may be repeated.
    """
    trajectory, spacing = faults.trajectory, motion.spacing_m
    length = contact.length()
    contact = contact.take(_thinned(contact, spacing))
    if limits.silent:
        stated = set(trajectory.segment[trajectory.contact].tolist())
    else:
        stated = {part.segment for part in trajectory.left_out}
    reached = covered_by(built, contact, fine, spacing, stated, deadline)
    failing = failing_places(built.prepared, trajectory, contact, fine, deadline)
    judge_left_out(trajectory, reached, failing, faults)
    _note_uncovered(reached, limits, faults)
    contact = replace(contact, segment=np.unique(contact.segment, return_inverse=True)[1])
    by_segment = passes(contact, fine, _VISIT * spacing)
    visits, strip = by_segment.sum(axis=1), np.full(len(contact), -1)
    if motion.overlap_m:
        strips = Strips.of(fine, by_segment, motion.overlap_m + _BESIDE * spacing)
        visits = strips.counted(fine, by_segment)
        strip = np.where(strips.near(contact.at.points, contact.segment), contact.segment, -1)
    visited = (visits > 0) & (reached.areas > 0)

    def mean(of: Array) -> float:
        weights = reached.areas[visited]
        return float(np.average(of[visited], weights=weights)) if len(weights) else 0.0

    mean_visits = mean(visits)
    if mean_visits > limits.most_mean_visits:
        most = f"{limits.most_mean_visits:g}"
        text = f"a place is visited {mean_visits:.3f} times on average, allowed: {most}"
        faults.add("repeated", text)
    twice = repeated_stretches(contact, strip, _ALONG * spacing, _APART * spacing)
    stated_m = _note_repeated(contact, twice, limits.longest_repeated_spacings * spacing, faults)
    total = reached.total
    return CoveredArea(
        reachable_m2=total,
        spacing_m=spacing,
        covered_share=reached.share(reached.near),
        closely_covered_share=reached.share(reached.distance <= NEAR * spacing),
        left_out_share=reached.share(reached.right),
        uncovered_m2=float(reached.areas[reached.uncovered].sum()),
        mean_visits=mean_visits,
        most_visits=int(visits[visited].max(initial=0)),
        visited_again_share=mean(visits > 1),
        repeated_m=sum(stretch.length for stretch in twice),
        stated_repeated_m=stated_m,
        length_m=length,
        length_times_spacing_per_area=length * spacing / total if total else 0.0,
    )


def _thinned(contact: Contact, spacing: float) -> Mask:
    """Which places of contact (c,) to measure with: those some way after the one before."""
    number = np.floor(np.append(0.0, np.cumsum(contact.steps)) / (_THINNED * spacing))
    kept = np.ones(len(contact), dtype=bool)
    kept[1:] = ~contact.together | (np.diff(number) > 0)
    kept[:-1] |= ~contact.together
    kept[-1:] = True
    return kept


def _note_uncovered(reached: Reached, limits: Limits, faults: FaultList) -> None:
    """Note parts as large as a footprint that no pass comes near, and shares that are too low."""
    spacing, uncovered = reached.spacing, reached.uncovered
    for area, place in reached.patches(uncovered):
        if area > np.pi * spacing**2:
            text = f"{area:.6f} m² are farther than {FAR * spacing:.4g} m from every pass"
            faults.add("uncovered", text, place=place)
    for mask, factor, least in (
        (uncovered, FAR, limits.least_covered_share),
        (reached.missed & ~reached.right, NEAR, limits.least_closely_covered_share),
    ):
        share = 1 - reached.share(mask)
        if share < least:
            text = (
                f"{share:.3%} of the reachable area is within {factor * spacing:.4g} m of a pass "
                f"or out of the arm's reach as announced, at least {least:.3%} has to be"
            )
            faults.add("uncovered", text, place=reached.patches(mask)[0][1])


def _note_repeated(
    contact: Contact, twice: list[Repeated], most: float, faults: FaultList
) -> float:
    """Note stretches along an earlier pass that are not stated; the length of those that are, m."""
    sample, stated = contact.sample, np.zeros(len(contact), dtype=bool)
    for known in faults.trajectory.repeated:
        stated |= (sample >= known.sample) & (sample <= known.last_sample)
    for stretch, first, last in _parts(twice, ~stated):
        length = contact.length(first, last)
        if length <= most:
            continue
        begin, end = sample[[stretch.earlier_first, stretch.earlier_last]].tolist()
        text = (
            f"runs for {length:.4f} m along an earlier pass, samples {begin} to {end}, allowed: "
            f"{most:.4f} m unless the trajectory announces them"
        )
        place = contact.tips[first]
        faults.add("repeated", text, int(sample[first]), int(sample[last]), place=place)
    return sum(contact.length(first, last) for _, first, last in _parts(twice, stated))


def _parts(twice: list[Repeated], of: Mask) -> list[tuple[Repeated, int, int]]:
    """The first and the last row of each part of a repeated stretch in which something holds."""
    return [
        (stretch, stretch.first + begin, stretch.first + after - 1)
        for stretch in twice
        for begin, after in stretches(of[stretch.first : stretch.last + 1])
    ]
