"""Graphs that were read from a file: are they those of their surface, and where do they lie?"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition.borders import Borders, Curve
from cellcolor.decomposition.cells import Decomposition, areas_of, loops_of, pieces_of


def locate(
    surface: LabelledSurface, instance: Instance, vertex_cell: Sequence[int]
) -> Decomposition:
    """Find where an instance that was read from a file lies on its surface.

    Args:
        vertex_cell: the cell of each vertex, ``OUTSIDE`` where unreachable.

    Returns:
        The instance, with the areas of its cells and its coverage measured here, and the curves of
        its edges. There are none if another program has numbered the edges.
    """
    areas = areas_of(surface, vertex_cell, len(instance.cells))
    measured = tuple(replace(cell, area=areas[cell.id]) for cell in instance.cells)
    return Decomposition(
        replace(instance, cells=measured, coverage=surface.coverage),
        _curves(surface, instance, vertex_cell),
        tuple(vertex_cell),
    )


def _curves(
    surface: LabelledSurface, instance: Instance, vertex_cell: Sequence[int]
) -> dict[int, Curve]:
    """The curve of each edge, by its id; none at all if the ids do not fit the curves.

    The decomposition numbers edges in the order in which it finds their curves, so the curves are
    looked for again in that order. An edge has to have the same cells on its sides and the same
    joinable colors as the curve of its number, and the same neighbors on the cells' loops.
    """
    borders = Borders(surface, vertex_cell)
    curves = dict(enumerate(borders.curves(), start=1))
    if curves.keys() != {edge.id for edge in instance.edges}:
        return {}
    loops = loops_of(borders, list(curves.values()), NEVER)
    for cell in instance.cells:
        if {*map(_from_least, loops.get(cell.id, ()))} != {*map(_from_least, cell.loops)}:
            return {}
    for edge in instance.edges:
        kind = edge.left, edge.right, frozenset(instance.joinable(edge.id))
        if borders.kind(curves[edge.id][0]) != kind:
            return {}
    return curves


def _from_least(loop: Sequence[int]) -> tuple[int, ...]:
    """A cyclic list from its least dart on."""
    first = loop.index(min(loop))
    return (*loop[first:], *loop[:first])


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
    curves = borders.curves(deadline)
    loops = loops_of(borders, curves, deadline)
    drawn: dict[int, _Side] = {}
    for number, curve in enumerate(curves, start=1):
        left, right, joinable = borders.kind(curve[0])
        drawn[number] = left, right, tuple(sorted(joinable))
    told = {edge.id: (edge.left, edge.right, instance.joinable(edge.id)) for edge in instance.edges}
    for sides in (drawn, told):
        sides |= {-dart: (right, left, c) for dart, (left, right, c) in sides.items()}
    on_mesh = _shapes(drawn, loops.values(), deadline)
    in_file = _shapes(told, (cell.loops for cell in instance.cells), deadline)
    different = (on_mesh - in_file) + (in_file - on_mesh)
    return min((shape[0][0][0] for shape in different), default=None)


_Shape = tuple[tuple[_Side, int, int], ...]


def _shapes(
    sides: Mapping[int, _Side], loops: Iterable[Sequence[Sequence[int]]], deadline: Deadline
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
