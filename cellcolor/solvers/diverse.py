"""A few schemes that differ as much as possible, out of many (max-min diversity, greedily)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, scheme_key

POOL = 1000
"""Schemes that a few are chosen from."""


def pool_of(schemes: Iterator[Division], number: int = POOL) -> Iterator[Division]:
    """Up to so many different schemes: drawn at random where the solver has counted them.

    If what the solver lists has the attributes ``count`` and ``drawn`` of
    :class:`~cellcolor.solvers.cpsat.schemes.enumeration.OptimalSchemes` and there are more than
    ``number``, all but the first ones are drawn. Else these are the first ones, much alike perhaps.
    """
    seen = set()
    for division in schemes:
        seen.add(scheme_key(division))
        yield division
        if len(seen) >= number:
            return
        if len(seen) > 1 and (getattr(schemes, "count", None) or 0) > number:
            break
    else:
        return
    for division in schemes.drawn(2 * number):  # type: ignore[attr-defined]  # it has a count
        if len(seen) >= number:
            return
        if (key := scheme_key(division)) not in seen:
            seen.add(key)
            yield division


def most_different(instance: Instance, schemes: Sequence[Division], number: int) -> list[Division]:
    """The first scheme, then always the one that differs most from all chosen before.

    Two schemes differ by the area of the cells that they paint in other colors. In a divided cell
    each dart stands for an equal part of the cell; where areas are unknown, cells count alike.

    They come in the order of choice (Gonzalez' farthest-point selection), fewer if there are no
    more different ones. The least difference between two of them is at least half of what it is in
    any other choice.
    """
    painted = np.array([_colors(instance, division) for division in schemes])
    weights = _weights(instance)
    nearest = np.full(len(schemes), np.inf)
    chosen = [0]
    while len(chosen) < number:
        nearest = np.minimum(nearest, (painted != painted[chosen[-1]]) @ weights)
        farthest = int(nearest.argmax())
        if nearest[farthest] <= 0:
            break
        chosen.append(farthest)
    return [schemes[k] for k in chosen]


def _colors(instance: Instance, division: Division) -> Index:
    """The color at each dart of each cell, -1 for a zero; for a cell without darts its color."""
    found = []
    for cell, own in zip(instance.cells, division, strict=True):
        of_dart = {dart: sub.color for sub in own.subcells for dart in sub.darts}
        whole = own.subcells[0].color if len(own.subcells) == 1 else -1
        darts = [dart for loop in cell.loops for dart in loop]
        found += [of_dart.get(dart, whole) for dart in darts] or [whole]
    return np.array(found)


def _weights(instance: Instance) -> Array:
    """What each entry of :func:`_colors` counts."""
    known = all(cell.area is not None for cell in instance.cells)
    found: list[float] = []
    for cell in instance.cells:
        darts = max(sum(map(len, cell.loops)), 1)
        found += [(cell.area if known and cell.area is not None else 1.0) / darts] * darts
    return np.array(found)
