"""The area judged: what is covered, what is rightly left out, what is gone over twice."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask, stretches, unit
from cellcolor.data.trajectory_verdict import CoveredArea
from cellcolor.deadline import Deadline
from cellcolor.errors import TooLarge
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.setup import Motion
from cellcolor.memory import batches, check_memory
from cellcolor.trajectory_checker.contact import Contact
from cellcolor.trajectory_checker.covered import (
    FAR,
    NEAR,
    Reached,
    covered_by,
    judge_left_out,
)
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.fine_mesh import FineMesh

_TOGETHER = 20_000  # places that have at most
_MOST = 50_000_000  # pairs; more take too long
_KEPT = 80  # and until all are counted
_PARALLEL = 0.9  # cosine of the angle up to which two passes run along each other


InStrip = Callable[[Array, Index], Mask]
"""Which points (k, 3) their segment (k,) may visit although others do."""


def in_strips(fine: FineMesh, visits: csr_array, width: float) -> InStrip:
    """Where neighboring segments overlap on purpose: beside what only one of them visits.

    Args:
        visits: (n, segments) of the vertices of the fine mesh.
        width: how far from what it has alone a segment may visit what others do, m.
    """
    once = np.flatnonzero(np.diff(visits.indptr) == 1)
    owner = visits.indices[visits.indptr[once]]
    alone = {
        number: cKDTree(fine.vertices[once[owner == number]])
        for number in np.unique(owner).tolist()
    }

    def near(points: Array, segment: Index) -> Mask:
        found = np.zeros(len(points), dtype=bool)
        for number, tree in alone.items():
            own = np.flatnonzero(segment == number)
            found[own] = tree.query(points[own], distance_upper_bound=width)[0] < np.inf
        return found

    return near


def counted(fine: FineMesh, visits: csr_array, in_strip: InStrip) -> Index:
    """How often (n,) each vertex is visited, in strips by the segment that does so most."""
    total = visits.sum(axis=1)
    vertex, segment = visits.tocoo().coords
    outside = np.zeros(len(total), dtype=bool)
    outside[vertex[~in_strip(fine.vertices[vertex], segment)]] = True
    return np.asarray(np.where(outside, total, visits.max(axis=1).toarray().ravel()))


def passes(contact: Contact, fine: FineMesh, within: float) -> csr_array:
    """How often each segment's tool comes within a distance (m) of the vertices of the fine mesh.

    Coming back after less than that distance is the same pass. What faces another way, as the back
    of a sheet does, is not come by.

    Returns:
        (n, segments), without entries where a segment does not come.
    """
    ways, at, segment = _ways(contact), contact.at, contact.segment
    found = [np.zeros((2, 0), dtype=np.int64)]
    for vertex, place in _near(cKDTree(fine.vertices), at.points, within):
        facing = np.einsum("ij,ij->i", fine.normals[vertex], at.normals[place]) > 0
        found.append(np.stack([vertex[facing], place[facing]]))
    vertex, place = np.concatenate(found, axis=1)
    order = np.lexsort((place, vertex))
    vertex, place = vertex[order], place[order]
    begins = np.ones(len(vertex), dtype=bool)
    begins[1:] = (vertex[1:] != vertex[:-1]) | (ways[place[1:]] - ways[place[:-1]] > within)
    size = len(fine.vertices), int(segment.max(initial=0)) + 1
    once = np.ones(int(begins.sum()), dtype=np.int64)
    return coo_array((once, (vertex[begins], segment[place[begins]])), shape=size).tocsr()


def repeated_stretches(contact: Contact, strip: Index, within: float, apart: float) -> Index:
    """The stretches that run along an earlier pass, either way.

    Args:
        strip: (c,) the segment of a row that may run along passes of others, -1 of all other rows.
        within: how near the earlier pass is, m.
        apart: so far, in m along the path, two places have to be to belong to two passes.

    Returns:
        (s, 4) of each the first and the last row, and the rows of the earlier pass beside these.
    """
    ways, points, normals = _ways(contact), contact.at.points, contact.at.normals
    tangents = _tangents(contact)
    earlier = np.full(len(contact), -1)
    for one, other in _near(cKDTree(points), points, within):
        close = (
            (one < other)
            & (ways[other] - ways[one] > apart)
            & (np.einsum("ij,ij->i", normals[one], normals[other]) > 0)
        )
        along = np.abs(np.einsum("ij,ij->i", tangents[one], tangents[other])) >= _PARALLEL
        overlap = (strip[one] >= 0) & (strip[other] >= 0) & (strip[one] != strip[other])
        kept = close & along & ~overlap
        np.maximum.at(earlier, other[kept], one[kept])
    own = np.flatnonzero(earlier >= 0)
    gaps = np.diff(ways[own]) > apart / 2
    first, last = own[np.insert(gaps, 0, True)[: len(own)]], own[np.append(gaps, True)[: len(own)]]
    return np.column_stack([first, last, earlier[first], earlier[last]])


def _near(tree: cKDTree, points: Array, within: float) -> Iterator[tuple[Index, Index]]:
    """Pairs of a point of the tree and one of the given points that are near each other.

    Raises:
        TooLarge: they are too many, as where the tool stays in one place for hours.
    """
    counts = tree.query_ball_point(points, within, return_length=True)
    blocks = (
        np.add.reduceat(counts, np.arange(0, len(counts), _TOGETHER)) if len(counts) else counts
    )
    if blocks.max(initial=0) > _MOST:
        raise TooLarge("the trajectory passes the same place too often to be measured")
    pairs = int(counts.sum())
    what = f"the trajectory passes the same place too often: {pairs:,} pairs of places"
    check_memory(pairs * _KEPT, what)
    for part in batches(np.maximum(counts // 32, 1)):
        near = tree.query_ball_point(points[part], within, return_sorted=False)
        lists = [np.zeros(0, dtype=np.int64), *(np.asarray(own, dtype=np.int64) for own in near)]
        yield np.concatenate(lists), np.repeat(np.arange(part.start, part.stop), counts[part])


def _ways(contact: Contact) -> Array:
    """How far (c,) the tool has come in contact, m; far apart from stroke to stroke."""
    far = 1.0 + float(contact.steps.sum())
    return np.append(0.0, np.cumsum(np.where(contact.together, contact.steps, far)))


def _tangents(contact: Contact) -> Array:
    """Unit directions (c, 3) of the path, from the place before to the one after."""
    row, points = np.arange(len(contact)), contact.at.points
    after = row + np.append(contact.together, False)[: len(row)]
    before = row - np.insert(contact.together, 0, False)[: len(row)]
    return unit(points[after] - points[before])


_VISIT = 0.5  # spacings; a pass this close to a point is a visit of it
_ALONG = 0.25  # spacings; a pass this close to an earlier one runs along it
_BESIDE = 1.25  # spacings; by so much more than the overlap both sides visit the same places
_APART = 2.0  # spacings of path between two places that belong to two passes
_THINNED = 0.1  # spacings of path between two places of contact that are measured with

# Shares of the reachable area that are within 1.5 spacings of a pass, and within 0.75, at least;
# what is rightly left out counts as well.
_LEAST_COVERED, _LEAST_CLOSELY_COVERED = 0.99, 0.97
_MOST_MEAN_VISITS = 1.3
_LONGEST_REPEATED = 3.0  # spacings that a stretch may run along an earlier pass


def judge_area(
    built: BuildResult,
    contact: Contact,
    fine: FineMesh,
    motion: Motion,
    silent: bool,
    faults: FaultList,
    deadline: Deadline,
) -> CoveredArea:
    """Measure what is covered, and note what is not, and what is gone over too often.

    Args:
        contact: where the tip is on the surface; nothing else covers anything.
        silent: whether the trajectory cannot say what it leaves out, as a table cannot; then it may
            leave out whatever no branch reaches.
    """
    trajectory, spacing = faults.trajectory, motion.spacing_m
    length = contact.length()
    contact = contact.take(_thinned(contact, spacing))
    stated = {part.segment for part in trajectory.left_out}
    if silent:
        stated = set(trajectory.segment[trajectory.contact].tolist())
    reached = covered_by(built, contact, fine, spacing, stated, deadline)
    judge_left_out(built.prepared, contact, reached, faults, deadline)
    _note_uncovered(reached, faults)
    contact = replace(contact, segment=np.unique(contact.segment, return_inverse=True)[1])
    by_segment = passes(contact, fine, _VISIT * spacing)
    visits, strip = by_segment.sum(axis=1), np.full(len(contact), -1)
    if motion.overlap_m:
        in_strip = in_strips(fine, by_segment, motion.overlap_m + _BESIDE * spacing)
        visits = counted(fine, by_segment, in_strip)
        strip = np.where(in_strip(contact.at.points, contact.segment), contact.segment, -1)
    visited = (visits > 0) & (reached.areas > 0)

    def mean(of: Array) -> float:
        weights = reached.areas[visited]
        return float(np.average(of[visited], weights=weights)) if len(weights) else 0.0

    mean_visits = mean(visits)
    if mean_visits > _MOST_MEAN_VISITS:
        text = (
            f"a place is visited {mean_visits:.3f} times on average, allowed: {_MOST_MEAN_VISITS:g}"
        )
        faults.add("repeated", text)
    twice = repeated_stretches(contact, strip, _ALONG * spacing, _APART * spacing)
    stated_m = _note_repeated(contact, twice, _LONGEST_REPEATED * spacing, faults)
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
        repeated_m=sum(contact.length(first, last) for first, last, *_ in twice.tolist()),
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


def _note_uncovered(reached: Reached, faults: FaultList) -> None:
    """Note parts as large as a footprint that no pass comes near, and shares that are too low."""
    spacing, uncovered = reached.spacing, reached.uncovered
    for area, place in reached.patches(uncovered):
        if area > np.pi * spacing**2:
            text = f"{area:.6f} m² are farther than {FAR * spacing:.4g} m from every pass"
            faults.add("uncovered", text, place=place)
    for mask, factor, least in (
        (uncovered, FAR, _LEAST_COVERED),
        (reached.missed & ~reached.right, NEAR, _LEAST_CLOSELY_COVERED),
    ):
        share = 1 - reached.share(mask)
        if share < least:
            text = (
                f"{share:.3%} of the reachable area is within {factor * spacing:.4g} m of a pass "
                f"or out of the arm's reach as announced, at least {least:.3%} has to be"
            )
            faults.add("uncovered", text, place=reached.patches(mask)[0][1])


def _note_repeated(contact: Contact, twice: Index, most: float, faults: FaultList) -> float:
    """Note stretches along an earlier pass that are not stated; the length of those that are, m."""
    sample, stated, stated_m = contact.sample, np.zeros(len(contact), dtype=bool), 0.0
    for known in faults.trajectory.repeated:
        stated |= (sample >= known.sample) & (sample <= known.last_sample)
    for first, last, *earlier in twice.tolist():
        own = stated[first : last + 1]
        stated_m += sum(contact.length(first + a, first + b - 1) for a, b in stretches(own))
        for begin, after in stretches(~own):
            one, other = first + begin, first + after - 1
            length = contact.length(one, other)
            if length <= most:
                continue
            begun, ended = sample[earlier].tolist()
            text = (
                f"runs for {length:.4f} m along an earlier pass, samples {begun} to {ended}, "
                f"allowed: {most:.4f} m unless the trajectory announces them"
            )
            place = contact.tips[one]
            faults.add("repeated", text, int(sample[one]), int(sample[other]), place=place)
    return stated_m
