"""The area judged: what is covered, what is rightly left out, what is gone over twice."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask, stretches
from cellcolor.data.trajectory_verdict import CoveredArea
from cellcolor.deadline import Deadline
from cellcolor.errors import TooLarge
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.setup import Motion
from cellcolor.memory import batches, check_memory
from cellcolor.trajectory_checker.contact import Contact
from cellcolor.trajectory_checker.covered import FAR, NEAR, Reached, covered_by, failing_places
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.fine_mesh import FineMesh
from cellcolor.trajectory_checker.stated import judge_left_out
from cellcolor.trajectory_checker.tolerances import Limits

_TOGETHER = 20_000  # places that have at most
_MOST = 50_000_000  # pairs; more take too long
_KEPT = 80  # and until all are counted
_PARALLEL = 0.9  # cosine of the angle up to which two passes run along each other


@dataclass(frozen=True)
class Repeated:
    """A stretch that runs along an earlier pass.

    Attributes:
        first, last: rows of the configurations in contact.
        earlier_first, earlier_last: rows of the earlier pass beside these two.
        length: m.
    """

    first: int
    last: int
    earlier_first: int
    earlier_last: int
    length: float


@dataclass(frozen=True)
class Strips:
    """Where neighboring segments overlap on purpose: beside what only one of them visits.

    Attributes:
        alone: the places that each segment visits alone, as a tree.
        width: how far from there it may visit what others do, m.
    """

    alone: dict[int, cKDTree]
    width: float

    @classmethod
    def of(cls, fine: FineMesh, visits: csr_array, width: float) -> Strips:
        """Those of visits (n, segments) of the vertices of the fine mesh."""
        once = np.flatnonzero(np.diff(visits.indptr) == 1)
        segment = visits.indices[visits.indptr[once]]
        return cls(
            {
                number: cKDTree(fine.vertices[once[segment == number]])
                for number in np.unique(segment).tolist()
            },
            width,
        )

    def near(self, points: Array, segment: Index) -> Mask:
        """Which points (k, 3) are in the strip of their segment (k,), or in what it has alone."""
        found = np.zeros(len(points), dtype=bool)
        for number, tree in self.alone.items():
            own = np.flatnonzero(segment == number)
            found[own] = tree.query(points[own], distance_upper_bound=self.width)[0] < np.inf
        return found

    def counted(self, fine: FineMesh, visits: csr_array) -> Index:
        """How often (n,) each vertex is visited, in strips by the segment that does so most."""
        total = visits.sum(axis=1)
        vertex, segment = visits.tocoo().coords
        outside = np.zeros(len(total), dtype=bool)
        outside[vertex[~self.near(fine.vertices[vertex], segment)]] = True
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


def repeated_stretches(
    contact: Contact, strip: Index, within: float, apart: float
) -> list[Repeated]:
    """The stretches that run along an earlier pass, either way.

    Args:
        strip: (c,) the segment of a row that may run along passes of others, -1 of all other rows.
        within: how near the earlier pass is, m.
        apart: so far, in m along the path, two places have to be to belong to two passes.
    """
    if len(contact) < 2:
        return []
    ways, points, normals = _ways(contact), contact.at.points, contact.at.normals
    tangents = _tangents(points, contact.stroke)
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
    return _joined(earlier, ways, apart / 2)


def _joined(earlier: Index, ways: Array, gap: float) -> list[Repeated]:
    """Stretches of places with an earlier one beside them, across gaps of up to ``gap`` (m)."""
    own = np.flatnonzero(earlier >= 0)
    if not len(own):
        return []
    cuts = np.flatnonzero(np.diff(ways[own]) > gap) + 1
    found = []
    for part in np.split(own, cuts):
        first, last = int(part[0]), int(part[-1])
        length = float(ways[last] - ways[first])
        found.append(Repeated(first, last, int(earlier[first]), int(earlier[last]), length))
    return found


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


def _tangents(points: Array, stroke: Index) -> Array:
    """Unit directions (c, 3) of the path, from the place before to the one after."""
    after = np.minimum(np.arange(len(points)) + 1, len(points) - 1)
    before = np.maximum(np.arange(len(points)) - 1, 0)
    after = np.where(stroke[after] == stroke, after, np.arange(len(points)))
    before = np.where(stroke[before] == stroke, before, np.arange(len(points)))
    along = points[after] - points[before]
    lengths = np.linalg.norm(along, axis=1, keepdims=True)
    return np.asarray(along / np.where(lengths > 0, lengths, 1.0))


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
