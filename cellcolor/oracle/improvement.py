"""Where a plan can be beaten: a painting with fewer segments, and which segments it joins."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Index
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import count
from cellcolor.painting.paint import Painted


@dataclass(frozen=True)
class BetterPainting:
    """A painting with as few segments as were found, and what is left of it on the mesh as it was.

    Attributes:
        painted: on the surface, refined where it had to be.
        on_mesh: a plan for the mesh as it was.
        segments_on_mesh: of that; more than ``painted.segments`` where the mesh is too coarse.
    """

    painted: Painted
    on_mesh: Plan
    segments_on_mesh: int


@dataclass(frozen=True)
class Improvement:
    """How a plan can have fewer segments.

    Attributes:
        joined: two segments of the plan that can be one, numbered by their first vertices.
        places: a vertex of each, well inside what can be joined.
        better: the painting that joins them.
    """

    joined: tuple[int, int]
    places: tuple[int, int]
    better: BetterPainting

    @property
    def segments(self) -> int:
        """Of the better painting, on a surface that may be refined."""
        return self.better.painted.segments

    @property
    def segments_on_mesh(self) -> int:
        """Of the better plan on the mesh as it is."""
        return self.better.segments_on_mesh

    def __str__(self) -> str:
        one, other = self.joined
        near, far = self.places
        text = f"segments {one} and {other} (at vertices {near} and {far}) can be joined"
        if self.segments_on_mesh > self.segments:
            fewest = count(self.segments_on_mesh, "segment")
            text += f", but this mesh is coarse: on it {fewest} are the fewest found"
        return text


def better_painting(surface: LabelledSurface, painted: Painted) -> BetterPainting:
    """A painting of a surface, whose vertices come first in it, and what it leaves on the mesh."""
    on_mesh = Plan(painted.plan.vertex_colors[: len(surface.vertices)])
    segments = check_plan(surface, on_mesh).segments
    assert segments is not None  # every vertex has one of its colors
    return BetterPainting(painted, on_mesh, segments)


def improvement_of(
    surface: LabelledSurface, segment_of: Sequence[int], better: BetterPainting
) -> Improvement | None:
    """Which two segments of a plan the better painting has in one.

    Of all such pairs it is the one whose smaller part within the better segment is largest.

    Args:
        segment_of: (n,) the plan's segment of each vertex, -1 where it has no color.

    Returns:
        None if the painting does not have fewer segments, or has them only since segments that
        touch are one in it.
    """
    old = np.asarray(segment_of, dtype=np.int64)
    if better.painted.segments >= len(set(old[old >= 0].tolist())):
        return None
    new = better.painted.segment_of[: len(old)]
    inside = (np.flatnonzero(new == number) for number in range(int(new.max()) + 1))
    pairs = [pair for own in inside if (pair := _largest_pair(surface, old, own)) is not None]
    if not pairs:
        return None
    _, joined, places = max(pairs)
    return Improvement(joined, places, better)


def _largest_pair(
    surface: LabelledSurface, old: Index, inside: Index
) -> tuple[tuple[float, int], tuple[int, int], tuple[int, int]] | None:
    """The two segments with the most area among some vertices, and a vertex of each.

    Where triangles are flat to a line there is no area; then most vertices. Both numbers of the
    smaller one come first.
    """
    numbers, counts = np.unique(old[inside], return_counts=True)
    if len(numbers) < 2:
        return None
    areas = np.bincount(old[inside], surface.vertex_areas[inside])[numbers]
    order = np.lexsort((counts, areas))[-2:]
    second, first = numbers[order].tolist()
    pair = min(first, second), max(first, second)
    places = []
    for number in pair:
        vertices = inside[old[inside] == number]
        points = surface.vertices[vertices]
        nearest = np.argmin(np.linalg.norm(points - points.mean(axis=0), axis=1))
        places.append(int(vertices[nearest]))
    smaller = float(areas[order[0]]), int(counts[order[0]])
    return smaller, pair, (places[0], places[1])
