"""A plan: another planner's one color per vertex, for the oracle to judge."""

from __future__ import annotations

from dataclasses import dataclass

from cellcolor.data.value import Document
from cellcolor.data.wording import count


@dataclass(frozen=True, slots=True, repr=False)
class Plan(Document):
    """One color per vertex of a labelled surface.

    Attributes:
        vertex_colors: the painted color of each vertex, by its number, None exactly where it has
            none; lists and arrays of integers become this.

    Raises:
        InputError: a color is no integer, as ``True``, 1.0 and names are not.
    """

    FORMAT = "cellcolor/plan"

    vertex_colors: tuple[int | None, ...]

    def __str__(self) -> str:
        painted = [color for color in self.vertex_colors if color is not None]
        vertices = count(len(self.vertex_colors), "vertex", "vertices")
        colors = count(len(set(painted)), "color")
        return f"plan for {vertices}, {len(painted)} of them painted, in {colors}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"
