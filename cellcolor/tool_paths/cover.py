"""Covers every segment of a painted surface with tool paths."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Index
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import LeftOut
from cellcolor.data.wording import in_meters, looks_like_millimeters
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.tool_paths.measures import PathMeasures, in_all, measure
from cellcolor.tool_paths.refused import Refusals, without_refused
from cellcolor.tool_paths.region import Overlap, Region, Segments, clipped, owned, regions_of
from cellcolor.tool_paths.registry import DEFAULT_PATTERN, Laid, Pattern, find_pattern
from cellcolor.tool_paths.rounding import Line, rounded
from cellcolor.tool_paths.spurs import with_spurs
from cellcolor.tool_paths.triangles import Triangles

_TRIANGLES = 24  # about so many for each square of the spacing
_MOST_TRIANGLES = 4_000_000
_REFUSED = 0.25  # spacings: sides of triangles at the border of what is refused
_LEAST_AREA = 0.25  # spacings squared: smaller parts have no path
_OFTEN = 1.15  # visits in the mean: with more than that by the pattern, a single line is tried
_NARROW = 2.0  # spacings: but only on a part that is narrower than this in the mean
_MIDDLE = 0.15  # spacings: how near that line is to the middle of the part
_COVERED = 0.98  # share of the area that it has to cover, or as much as the pattern if that is less


@dataclass(frozen=True, repr=False, eq=False)
class Covered:
    """Tool paths, with their measures and what they leave uncovered.

    Attributes:
        paths: one path for every connected part of a segment that is large enough.
        measures: of each path, in the same order.
        in_all: of all together.
        uncovered: what no path comes near to, and why, the largest first.
        along_border: of each path, its points near a border; where a chord cuts a corner there, it
            may lie beyond the border.
    """

    paths: ToolPaths
    measures: tuple[PathMeasures, ...]
    in_all: PathMeasures
    uncovered: tuple[LeftOut, ...]
    along_border: tuple[Index, ...] = ()

    def __str__(self) -> str:
        visits = f"{self.in_all.mean_visits:.2f} visits"
        return f"{self.paths}, {100 * self.in_all.covered:.2f} % covered, {visits}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self}>"


def cover(
    segments: Segments,
    *,
    pattern: str = DEFAULT_PATTERN,
    spacing_m: float,
    tool_radius_m: float,
    walls: Collection[tuple[int, int]] = (),
    refusals: Refusals | None = None,
    overlap: Overlap | None = None,
    deadline: Deadline = NEVER,
    progress: Callable[[str], None] | None = None,
) -> Covered:
    """Lay a path on every connected part of every segment (docs/motion.md).

    Args:
        segments: of the painted surface.
        pattern: the name of a registered pattern.
        spacing_m: desired distance between neighboring passes, m.
        tool_radius_m: of the tool's footprint, m.
        walls: mesh edges that no path may cross, like cracks of whatever segment is there.
        refusals: where the tool must not touch the segments.
        overlap: how far paths may go beyond the border of the only segment.
        deadline: when to give up.
        progress: told in a few words what is being done.

    Raises:
        InputError: there is no such pattern, a length is not positive, the tool's radius is larger
            than the part, or the spacing is so small that the meshes would not fit into memory.
        OutOfTime: the deadline came first.
    """
    lay, surface = find_pattern(pattern), segments.surface
    _check_lengths(surface, spacing_m, tool_radius_m)
    paths, measures, along_border = [], [], []
    parts, uncovered = _parts(segments, spacing_m, walls, refusals, overlap)
    for number, (region, part) in enumerate(parts):
        deadline.check()
        if progress is not None:
            progress(f"covering part {number + 1} of {len(parts)}")
        area = float(part.areas.sum())
        if area < _LEAST_AREA * spacing_m**2:
            place = tuple(part.points[part.corners[0]].mean(axis=0).tolist())
            cause = "a part smaller than a quarter of the spacing squared"
            uncovered.append(LeftOut(region.segment, area, cause, place))
            continue
        line, own, left = _better(lay, part, region.segment, spacing_m, deadline)
        path, beside = line.path(region.segment, region.color)
        paths.append(path)
        along_border.append(beside)
        measures.append(own)
        uncovered += left
    uncovered.sort(key=lambda place: (-place.area_m2, place.place))
    return Covered(
        ToolPaths(surface.name, pattern, spacing_m, tool_radius_m, tuple(paths), surface.sha256),
        tuple(measures),
        in_all(measures),
        tuple(uncovered),
        tuple(along_border),
    )


def _parts(
    segments: Segments,
    spacing: float,
    walls: Collection[tuple[int, int]],
    refusals: Refusals | None,
    overlap: Overlap | None,
) -> tuple[list[tuple[Region, Triangles]], list[LeftOut]]:
    """The meshes that paths are laid on, each with its region, and what of segments is refused."""
    surface = segments.surface

    def allowed(mesh: Triangles, segment: int) -> tuple[list[Triangles], list[LeftOut]]:
        if refusals is None:
            return [mesh], []
        finest, least = _REFUSED * spacing, _LEAST_AREA * spacing**2
        return without_refused(mesh, segment, refusals, finest, least)

    parts, uncovered = [], []
    for region in regions_of(segments, walls):
        own, refused = allowed(region.mesh, region.segment)
        parts += [(region, part) for part in own]
        uncovered += refused
    if overlap is not None:  # refusals beyond the border do not count for the segment
        inside = segments.segment_of >= 0
        widened = np.where(overlap.widened(surface, inside), segments.segment_of.max(), -1)
        parts = [
            (region, part)
            for region in regions_of(segments._replace(segment_of=widened), walls)
            for mesh in clipped(region.mesh, surface, inside, overlap.beyond, _REFUSED * spacing)
            for part in allowed(mesh, region.segment)[0]
            if owned(part, surface, inside).any()
        ]
    return parts, uncovered


def _better(
    lay: Pattern, part: Triangles, segment: int, spacing: float, deadline: Deadline
) -> tuple[Line, PathMeasures, list[LeftOut]]:
    """The pattern's line, or one along the part with spurs if that visits it less often.

    In a part that is hardly wider than the spacing, loops go over most places twice.
    """

    def measured(laid: Laid) -> tuple[Line, PathMeasures, list[LeftOut]]:
        line = rounded(with_spurs(laid, spacing, deadline), spacing, deadline)
        return line, *measure(line, segment, spacing)

    first = measured(lay(part, spacing, deadline))
    wide = 2 * first[1].area_m2 > _NARROW * spacing * first[1].border_m
    if wide or first[1].mean_visits <= _OFTEN:
        return first
    other = measured(Laid(part.refined(_MIDDLE * spacing), []))
    less = other[1].mean_visits < first[1].mean_visits
    return other if less and other[1].covered >= min(_COVERED, first[1].covered) else first


def _check_lengths(surface: LabelledSurface, spacing_m: float, tool_radius_m: float) -> None:
    for name, length in (("spacing_m", spacing_m), ("tool_radius_m", tool_radius_m)):
        if not (math.isfinite(length) and length > 0):
            raise InputError(None, name, f"must be positive and finite, is {length}")
    size = np.ptp(surface.vertices, axis=0)
    if tool_radius_m > float(np.linalg.norm(size)):
        message = (
            f"larger than the part ({in_meters(size.tolist())}): "
            f"{looks_like_millimeters(tool_radius_m)}"
        )
        raise InputError(None, "tool_radius_m", message)
    area = float(surface.vertex_areas.sum())
    needed = area / spacing_m**2 * _TRIANGLES
    if needed > _MOST_TRIANGLES:
        text = f"needs about {needed:.2g} triangles, at most {_MOST_TRIANGLES:,} fit"
        raise InputError(None, "spacing_m", text)


def check_spacing(surface: LabelledSurface, segment_of: Index, spacing_m: float) -> None:
    """Refuse a spacing that is larger than every segment; small segments may be among them.

    Args:
        segment_of: (n,) the segment of each vertex, -1 where it has none: all segments of it.

    Raises:
        InputError: it is larger.
    """
    at = segment_of[surface.faces]
    # A segment ends inside the triangles that it shares with others.
    sizes = [
        np.ptp(surface.vertices[surface.faces[(at == segment).any(axis=1)]], axis=(0, 1))
        for segment in np.unique(segment_of[segment_of >= 0]).tolist()
        if (at == segment).any()
    ]
    largest = max(sizes, key=lambda size: float(np.linalg.norm(size)), default=None)
    if largest is not None and spacing_m > float(np.linalg.norm(largest)):
        message = (
            f"larger than the largest segment ({in_meters(largest.tolist())}): "
            f"{looks_like_millimeters(spacing_m)}"
        )
        raise InputError(None, "spacing_m", message)
