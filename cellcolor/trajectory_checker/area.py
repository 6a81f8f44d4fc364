"""The area judged: what is covered, what is rightly left out, what is gone over twice."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import CoveredArea
from cellcolor.deadline import Deadline
from cellcolor.frontend.build import BuildResult
from cellcolor.trajectory_checker.claims import judge_left_out
from cellcolor.trajectory_checker.covered import (
    excused,
    failing_places,
    patches,
    reach,
    reachable_areas,
)
from cellcolor.trajectory_checker.dense import Dense
from cellcolor.trajectory_checker.fault_list import FaultList, stretches
from cellcolor.trajectory_checker.fine_mesh import FineMesh, Located
from cellcolor.trajectory_checker.repeated import Repeated, Strips, passes, repeated_stretches
from cellcolor.trajectory_checker.tolerances import Limits

FAR, NEAR = 1.5, 0.75  # spacings; from a pass to what counts as covered, as closely covered
_VISIT = 0.5  # spacings; a pass this close to a point is a visit of it
_ALONG = 0.25  # spacings; a pass this close to an earlier one runs along it
_BESIDE = 1.25  # spacings; by so much more than the overlap both sides visit the same places
_APART = 2.0  # spacings of path between two places that belong to two passes
_THINNED = 0.1  # spacings of path between two places of contact that are measured with


def thinned(dense: Dense, rows: Index, spacing: float) -> Mask:
    """Which places of contact (c,) to measure with: those some way after the one before."""
    steps = np.linalg.norm(np.diff(dense.tips[rows], axis=0), axis=1)
    begins = dense.stroke[rows[1:]] != dense.stroke[rows[:-1]]
    number = np.floor(np.concatenate([[0.0], np.cumsum(steps)]) / (_THINNED * spacing))
    kept = np.ones(len(rows), dtype=bool)
    kept[1:] = begins | (np.diff(number) > 0)
    kept[:-1] |= begins
    kept[-1:] = True
    return kept


def judge_area(
    built: BuildResult,
    trajectory: Trajectory,
    dense: Dense,
    rows: Index,
    located: Located,
    branches: Index,
    touching: Mask,
    fine: FineMesh,
    spacing: float,
    overlap: float,
    limits: Limits,
    tells: bool,
    faults: FaultList,
    deadline: Deadline,
) -> CoveredArea:
    """Measure what is covered, and note what is not, and what is gone over too often.

    Args:
        rows: (c,) those of ``dense`` in contact, with their places and branches.
        overlap: of neighboring segments, m; places in it are not visited too often.
        tells: whether the trajectory can say what it leaves out.
        touching: (c,) whether the tip is on the surface there; nothing else covers anything.
    """
    rows, branches = rows[touching], branches[touching]
    located = located.take(touching)
    kept = thinned(dense, rows, spacing)
    length = _length(dense, rows)
    rows, branches = rows[kept], branches[kept]
    located = located.take(kept)
    areas = reachable_areas(built, fine)
    total = float(areas.sum())
    reached = reach(fine, located, FAR * spacing)
    missed = (areas > 0) & (reached.distance > NEAR * spacing)
    segments = (
        {part.segment for part in trajectory.left_out}
        if tells
        else set(trajectory.segment[trajectory.contact].tolist())
    )
    segment = trajectory.segment[dense.sample[rows]]
    right = excused(
        built.prepared, sorted(segments), segment, branches, fine, reached, missed, deadline
    )
    near = reached.distance <= FAR * spacing
    uncovered = missed & ~right & ~near
    number = np.unique(segment, return_inverse=True)[1]
    by_segment = passes(dense, rows, number, located, fine, _VISIT * spacing)
    visits, strip = by_segment.sum(axis=1), np.full(len(rows), -1)
    if overlap:
        strips = Strips.of(fine, by_segment, overlap + _BESIDE * spacing)
        visits = strips.counted(fine, by_segment)
        strip = np.where(strips.near(located.points, number), number, -1)
    visited = (visits > 0) & (areas > 0)
    twice = repeated_stretches(dense, rows, located, strip, _ALONG * spacing, _APART * spacing)
    stated = np.zeros(len(rows), dtype=bool)
    sample = dense.sample[rows]
    for stretch in trajectory.repeated:
        stated |= (sample >= stretch.sample) & (sample <= stretch.last_sample)

    def share(of: Mask) -> float:
        return float(areas[of].sum() / total) if total else 0.0

    def mean(of: Array | Mask | Index, where: Mask) -> float:
        return float(np.average(of[where], weights=areas[where])) if where.any() else 0.0

    covered = CoveredArea(
        reachable_m2=total,
        spacing_m=spacing,
        covered_share=share(near),
        closely_covered_share=share(reached.distance <= NEAR * spacing),
        left_out_share=share(right),
        uncovered_m2=float(areas[uncovered].sum()),
        mean_visits=mean(visits, visited),
        most_visits=int(visits[visited].max(initial=0)),
        visited_again_share=mean(visits > 1, visited),
        repeated_m=sum(stretch.length for stretch in twice),
        stated_repeated_m=sum(_length(dense, rows[part]) for _, part in _parts(twice, stated)),
        length_m=length,
        length_times_spacing_per_area=length * spacing / total if total else 0.0,
    )
    failing = failing_places(built.prepared, trajectory, segment, branches, fine, deadline)
    judge_left_out(trajectory, fine, areas, near, right, missed, failing, spacing, faults)
    _note_uncovered(fine, areas, uncovered, missed & ~right, total, spacing, limits, faults)
    if covered.mean_visits > limits.most_mean_visits:
        text = (
            f"a place is visited {covered.mean_visits:.3f} times on average, allowed: "
            f"{limits.most_mean_visits:g}"
        )
        faults.add("repeated", text)
    _note_repeated(dense, rows, twice, stated, limits.longest_repeated_spacings * spacing, faults)
    return covered


def _note_uncovered(
    fine: FineMesh,
    areas: Array,
    uncovered: Mask,
    loosely: Mask,
    total: float,
    spacing: float,
    limits: Limits,
    faults: FaultList,
) -> None:
    """Note parts as large as a footprint that no pass comes near, and shares that are too low."""
    for area, place in patches(fine, areas, uncovered):
        if area > np.pi * spacing**2:
            text = f"{area:.6f} m² are farther than {FAR * spacing:.4g} m from every pass"
            faults.add("uncovered", text, place=place)
    for mask, factor, least in (
        (uncovered, FAR, limits.least_covered_share),
        (loosely, NEAR, limits.least_closely_covered_share),
    ):
        share = 1 - float(areas[mask].sum()) / total if total else 1.0
        if share < least:
            text = (
                f"{share:.3%} of the reachable area is within {factor * spacing:.4g} m of a pass "
                f"or rightly left out, at least {least:.3%} has to be"
            )
            largest = patches(fine, areas, mask)[0]
            faults.add("uncovered", text, place=largest[1])


def _note_repeated(
    dense: Dense, rows: Index, twice: list[Repeated], stated: Mask, most: float, faults: FaultList
) -> None:
    """Note stretches along an earlier pass, without what the trajectory states of them."""
    for stretch, part in _parts(twice, ~stated):
        length = _length(dense, rows[part])
        if length <= most:
            continue
        first, last, begin, end = (
            int(dense.sample[rows[row]])
            for row in (part[0], part[-1], stretch.earlier_first, stretch.earlier_last)
        )
        text = (
            f"runs for {length:.4f} m along an earlier pass, samples {begin} to {end}, allowed: "
            f"{most:.4f} m unless they are stated"
        )
        faults.add("repeated", text, first, last, place=dense.tips[rows[part[0]]])


def _parts(twice: list[Repeated], of: Mask) -> list[tuple[Repeated, Index]]:
    """The rows of each part of a repeated stretch in which something holds all along."""
    return [
        (stretch, np.arange(stretch.first + begin, stretch.first + after))
        for stretch in twice
        for begin, after in stretches(of[stretch.first : stretch.last + 1])
    ]


def _length(dense: Dense, rows: Index) -> float:
    steps = np.linalg.norm(np.diff(dense.tips[rows], axis=0), axis=1)
    return float(steps[dense.stroke[rows[1:]] == dense.stroke[rows[:-1]]].sum())
