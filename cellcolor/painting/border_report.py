"""Where the borders of a painting are, in numbers, before and after they were moved."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Corridor:
    """A narrow place of a segment.

    Attributes:
        segment: the segment's number in the painting.
        width_m: across, from border to border, m.
        place: (x, y, z) where it is narrowest, m.
        way: vertices on the way through it, the narrowest first, as far as the tool is too wide.
    """

    segment: int
    width_m: float
    place: tuple[float, float, float]
    way: tuple[int, ...]


@dataclass(frozen=True)
class Borders:
    """Where the borders of a painting are, in numbers.

    Attributes:
        length_m: of all borders between segments, m.
        cost: mean of the caller's cost over the area that has a color; 0 if there is no such cost.
        narrow: corridors in which the tool's footprint does not stay inside.
        narrowest: the narrowest corridor; None if all are wider than three tool radii.
        repeated_m2: area that the tool passes over a second time where its footprint cannot stay
            inside its segment: in narrow corridors and corners.
    """

    length_m: float
    cost: float
    narrow: int
    narrowest: Corridor | None
    repeated_m2: float


@dataclass(frozen=True)
class BorderReport:
    """What moving the borders has changed.

    Attributes:
        tool_radius_m: of the footprint that corridors were made for.
        before: as the solution was painted.
        after: as they are now.
        moved: how many vertices have changed their segment.
    """

    tool_radius_m: float
    before: Borders
    after: Borders
    moved: int

    @property
    def stays_inside(self) -> bool:
        """Whether the footprint can stay inside its segment everywhere.

        Then, and only then, the fewest segments of the surface are the fewest for the tool too.
        """
        return not self.after.narrow and not self.after.repeated_m2
