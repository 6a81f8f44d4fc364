"""Bounds that some cells prove: fewer color regions do not touch all of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cellcolor.data.bounds.kind import BoundKind, Certificate, Mark, Shown
from cellcolor.data.wording import count, listed

if TYPE_CHECKING:
    from cellcolor.data.instance import Instance


@dataclass(frozen=True, slots=True)
class CertifiedCells(Certificate):
    """Cells that fewer color regions than the bound says do not touch."""

    cells: tuple[int, ...]

    def shown(self, value: int, instance: Instance) -> Shown:
        """The cells."""
        cells = sorted(set(self.cells))
        notes: tuple[str, ...] = (
            f"No {count(value - 1, 'color region')} touch all of these cells.",
        )
        if len(cells) == value:
            notes = (
                "No two of these cells can share a segment:",
                "no color leads from one to another.",
            )
        return Shown(marks_of(instance, cells), (), notes)

    def witness(self, value: int) -> tuple[int, ...]:
        """The cells if there are as many: then no color region touches two of them."""
        return self.cells if len(self.cells) == value else ()


def marks_of(
    instance: Instance, cells: Sequence[int], hubs: Sequence[int] = ()
) -> tuple[Mark, ...]:
    """Cells, each by itself, and hubs that are taken away, with their colors."""
    named = [(cell, "cell", number) for number, cell in enumerate(cells)]
    marks = []
    for cell, what, group in [*named, *((hub, "hub", None) for hub in hubs)]:
        colors = listed(instance.colors[color] for color in instance.cells[cell].colors)
        marks.append(Mark(str(cell), f"{what} {cell}: {colors}", (cell,), group))
    return tuple(marks)


STRANGERS = BoundKind(
    "that many cells cannot share a segment, no two of them",
    "It holds for the number of segments, also where only those cells have to be covered.",
    CertifiedCells,
)
COVER = BoundKind(
    "fewer color regions cannot touch every cell",
    "It holds for the number of segments, also where only the cells of its certificate have to be "
    "covered.",
    CertifiedCells,
)
