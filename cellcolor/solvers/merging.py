"""Fewer and larger cells, for the search space ``surface`` and for lower bounds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from cellcolor.data.instance import Cell, Edge, Instance
from cellcolor.solvers.reductions import drop_dominated

__all__ = ["bundled", "merged", "simplified"]


def simplified(
    instance: Instance, colors: Sequence[frozenset[int]]
) -> tuple[Instance, dict[int, int]]:
    """Merge cells and drop dominated colors until nothing changes, then bundle edges.

    Args:
        instance: the topological graph.
        colors: the colors each cell may be painted in, all or some of its own.

    Returns:
        The new instance, and how many edges each of its edges stands for.
    """
    while True:
        smaller = merged(instance, colors)
        colors = drop_dominated(smaller)
        if len(smaller.cells) == len(instance.cells) and all(
            set(cell.colors) == own for cell, own in zip(smaller.cells, colors, strict=True)
        ):
            return bundled(smaller)
        instance = smaller


def merged(instance: Instance, colors: Sequence[frozenset[int]]) -> Instance:
    """The instance with neighboring cells made one where nothing separates them.

    Two cells with one and the same set of colors, and an edge between them that is joinable for
    the whole set, are one area in which any division can be drawn: the edge goes. Only the paper's
    rule that an edge is crossed once is lost with it. So

    - the minimum of the search space ``surface`` stays the same;
    - the minimum of ``paper`` may fall, but the new one is a lower bound of the old one, since the
      edges that stay are still crossed once at most.

    An edge with one merged cell on both sides goes as well, which may leave a hole. Dead darts are
    left out; areas, lengths and provenance are not kept.

    Args:
        instance: the topological graph.
        colors: the colors each cell may be painted in, all or some of its own.

    Returns:
        The new instance; its cells and edges have other numbers.
    """
    joinable = {
        edge.id: colors[edge.left] & colors[edge.right] & frozenset(instance.joinable(edge.id))
        for edge in instance.edges
        if instance.joinable(edge.id)
    }
    joinable = {edge: shared for edge, shared in joinable.items() if shared}
    loops = {
        cell.id: [live for loop in cell.loops if (live := [d for d in loop if abs(d) in joinable])]
        for cell in instance.cells
    }
    sides = {edge: [instance.edge(edge).left, instance.edge(edge).right] for edge in joinable}
    for edge in sorted(joinable):
        left, right = sides[edge]
        if colors[left] != joinable[edge] or colors[right] != joinable[edge]:
            continue
        near = next(loop for loop in loops[left] if edge in loop)
        far = next(loop for loop in loops[right] if -edge in loop)
        if near is far:
            # The walk there and back along the edge was what held the two parts together.
            turned = _from(near, edge)
            place = turned.index(-edge)
            parts = [turned[:place], turned[place + 1 :]]
            loops[left] = [loop for loop in loops[left] if loop is not near]
        elif left != right:
            parts = [_from(near, edge) + _from(far, -edge)]
            others = [loop for loop in loops.pop(right) if loop is not far]
            loops[left] = [loop for loop in loops[left] if loop is not near] + others
            for pair in sides.values():
                pair[:] = [left if cell == right else cell for cell in pair]
        else:
            continue  # two loops of one cell: a handle, and without the edge it was not planar
        loops[left] += [part for part in parts if part]
        del joinable[edge]
        del sides[edge]
    number = {cell: position for position, cell in enumerate(loops)}
    return Instance(
        instance.name,
        instance.colors,
        tuple(
            Cell(number[cell], tuple(sorted(colors[cell])), tuple(map(tuple, found)))
            for cell, found in loops.items()
        ),
        tuple(
            Edge(edge, number[left], number[right], tuple(sorted(joinable[edge])))
            for edge, (left, right) in sides.items()
        ),
    )


def bundled(instance: Instance) -> tuple[Instance, dict[int, int]]:
    """The instance with parallel edges made one.

    Edges are parallel when they follow each other around the cells on both of their sides, dead
    edges left out, and are joinable in the same colors. A corridor that crosses one of them might
    as well cross another; together they are crossed as often as there are of them at most.

    Args:
        instance: without dead edges.

    Returns:
        The new instance, and how many edges each of its edges stands for.
    """
    following = {
        dart: after
        for cell in instance.cells
        for loop in cell.loops
        for dart, after in zip(loop, loop[1:] + loop[:1], strict=True)
    }
    count = {edge.id: 1 for edge in instance.edges}
    for edge in instance.edges:
        while edge.id in count and edge.left != edge.right:
            other = following[edge.id]
            if (
                other == edge.id
                or other < 0
                or following[-other] != -edge.id
                or instance.joinable(other) != instance.joinable(edge.id)
            ):
                break
            count[edge.id] += count.pop(other)
            following[edge.id] = following.pop(other)
            before = next(dart for dart, after in following.items() if after == -other)
            following[before] = following.pop(-other)
    cells = tuple(
        replace(
            cell,
            loops=tuple(tuple(dart for dart in loop if abs(dart) in count) for loop in cell.loops),
        )
        for cell in instance.cells
    )
    edges = tuple(edge for edge in instance.edges if edge.id in count)
    return replace(instance, cells=cells, edges=edges), count


def _from(loop: list[int], dart: int) -> list[int]:
    """A cyclic list from behind a dart on, without it."""
    place = loop.index(dart)
    return loop[place + 1 :] + loop[:place]
