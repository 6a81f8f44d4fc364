"""Is a topological graph that of its surface, however its edges and loops are numbered?"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition.borders import Borders
from cellcolor.decomposition.cells import loops_of, pieces_of

_Side = tuple[int, int, tuple[int, ...]]
"""What a dart is besides its number: its cell, the cell across, the joinable colors."""


def wrong_cell(
    surface: LabelledSurface,
    instance: Instance,
    vertex_cell: Sequence[int],
    deadline: Deadline = NEVER,
) -> int | None:
    """A cell of a connected part whose borders are not those on the surface; None if all are.

    Args:
        instance: a topological graph that is said to be of it.
        vertex_cell: the cell of each vertex, ``OUTSIDE`` where unreachable. Cells have to have the
            colors of their vertices; they may be smaller than they could be.
    """
    _, firsts = pieces_of(surface, vertex_cell, OUTSIDE, deadline)
    pieces = Counter(vertex_cell[first] for first in firsts)
    for cell in range(len(instance.cells)):
        if pieces[cell] != 1:
            return cell
    borders = Borders(surface, vertex_cell)
    cell_of = borders.cell_of
    curves = borders.curves(deadline)
    loops = loops_of(borders, curves, deadline)
    drawn: dict[int, _Side] = {}
    for number, curve in enumerate(curves, start=1):
        left, right = curve.steps[0]
        colors = tuple(sorted(borders.joinable(left, right)))
        drawn[number] = cell_of[left], cell_of[right], colors
        drawn[-number] = cell_of[right], cell_of[left], colors
    told: dict[int, _Side] = {}
    for edge in instance.edges:
        colors = instance.joinable(edge.id)
        told[edge.id] = edge.left, edge.right, colors
        told[-edge.id] = edge.right, edge.left, colors
    on_mesh = _shapes(drawn, loops.values(), deadline)
    in_file = _shapes(told, (cell.loops for cell in instance.cells), deadline)
    different = (on_mesh - in_file) + (in_file - on_mesh)
    return min((shape[0][0][0] for shape in different), default=None)


_Shape = tuple[tuple[_Side, int, int], ...]


def _shapes(
    sides: Mapping[int, _Side],
    loops: Iterable[Sequence[Sequence[int]]],
    deadline: Deadline,
) -> Counter[_Shape]:
    """Each connected part of the borders in a form that does not depend on any number of an edge.

    From a dart on, the following dart of its loop and the one across its edge are numbered as they
    are met. So one dart says where all are, and of the darts to begin with the least form counts.
    """
    following = {
        dart: loop[place - len(loop) + 1]
        for own in loops
        for loop in own
        for place, dart in enumerate(loop)
    }
    found: Counter[_Shape] = Counter()
    left = set(following)
    for first in sorted(following):
        if first not in left:
            continue
        part = _walk(first, following)
        left.difference_update(part)
        alike: dict[_Side, list[int]] = defaultdict(list)
        for dart in part:
            alike[sides[dart]].append(dart)
        # The rarest sort of dart, so that there are few to begin with.
        starts = min(alike.items(), key=lambda item: (len(item[1]), item[0]))[1]
        forms = []
        for start in starts:
            deadline.check()
            number = {dart: place for place, dart in enumerate(_walk(start, following))}
            forms.append(
                tuple(
                    (sides[dart], number[following[dart]], number.get(-dart, -1)) for dart in number
                )
            )
        found[min(forms)] += 1
    return found


def _walk(first: int, following: Mapping[int, int]) -> list[int]:
    """All darts connected with one, in the order in which they are met from there."""
    met = {first: None}
    order = [first]
    for dart in order:  # which grows meanwhile
        for other in (following[dart], -dart):
            if other in following and other not in met:
                met[other] = None
                order.append(other)
    return order
