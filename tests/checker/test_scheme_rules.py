"""The checker passes the schemes of the definition and nothing else (docs/semantics.md, section 3).

For a checker without one of the rules another division of some graph below is a scheme.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import holes
import pytest
from holes import Painted
from rooms import BLUE, GREEN, RED, graph, hub, petal_cells

from cellcolor.checker import division as checker
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division

BOTH = RED, BLUE
ALL = RED, BLUE, GREEN

GRAPHS = {
    # Blue is joinable on one of two edges.
    "pair": graph((BOTH, (1, 2)), (BOTH, (-2, -1)), cracks={1: (RED,)}),
    "red cell": graph((BOTH, (1,)), ((RED,), (-1,))),
    "in turn": hub(RED, BLUE, RED, BLUE),
    "two and two": hub(RED, RED, BLUE, BLUE),
    "all alike": hub(RED, RED, RED, (RED, BLUE)),
    "crossing-zeros": graph(
        (BOTH, (1, 2, 3, 4, 5, 6)),
        *(((RED,), (-3, -2)), ((BLUE,), (-5, -4)), ((RED,), (-1,)), ((BLUE,), (-6,))),
    ),
    # Two red sub-cells, the first and the last around a cell, are joined by way of another cell.
    "round the end": graph(
        (BOTH, (1, 2, 3, 4, 5, 6)),
        *(((RED,), (-1, -6)), ((RED,), (-2,)), ((BLUE,), (-3,)), ((BLUE,), (-4,)), ((RED,), (-5,))),
    ),
    "two loops": graph((BOTH, (1, 2), (3, 4)), *petal_cells(RED, RED, RED, RED)),
    "one in a hole": graph(
        (BOTH, (1, 2, 3, 4), (5,)), *petal_cells(RED, RED, BLUE, BLUE, (RED, BLUE))
    ),
    "all alike, one in a hole": graph(
        (BOTH, (1, 2, 3, 4), (5,)), *petal_cells(RED, RED, RED, RED, (RED, BLUE))
    ),
    # Darts 3 and 4 need not be joined. Then 3, the last of a loop, shows red, and 4, the first of
    # the other, blue.
    "last and first": graph(
        (BOTH, (1, 2, 3), (4, 5, 6)),
        *(((RED,), (-1,)), ((BLUE,), (-2, -3)), ((RED,), (-4, -5)), ((BLUE,), (-6,))),
    ),
    "bands": graph((ALL, (1, 2, 3), (4, 5, 6)), *petal_cells(RED, BLUE, GREEN, RED, BLUE, GREEN)),
}


def anything(instance: Instance) -> Iterator[tuple[Painted, ...]]:
    """Any darts in any sub-cells of any colors, also in two or in none: for tiny graphs."""
    every = range(len(instance.colors))
    options = []
    for cell in instance.cells:
        darts = [dart for loop in cell.loops for dart in loop]
        own: list[Painted] = []
        for size in range(len(darts) + 1):
            for joined in itertools.combinations(darts, size):
                for blocks in holes.set_partitions(joined):
                    for more in ([], [[]], [[], []], blocks[:1]):
                        parts = [*blocks, *more]
                        for colors in itertools.product(every, repeat=len(parts)):
                            pairs = zip(colors, map(frozenset, parts), strict=True)
                            own.append(frozenset(pairs))
        options.append([painted for painted in dict.fromkeys(own) if painted])
    yield from itertools.product(*options)


def is_legal(instance: Instance, painting: Sequence[Painted]) -> bool:
    """Rules 1 and 3, and whether sub-cells do not cross."""
    if any(
        one & other for cell in painting for (_, one), (_, other) in itertools.combinations(cell, 2)
    ):
        return False
    color = {dart: own for cell in painting for own, block in cell for dart in block}
    return all(
        color.get(-dart) == own and own in instance.joinable(dart) for dart, own in color.items()
    ) and all(
        all(own in cell.colors for own, _ in painted)
        and (len(painted) == 1 or all(block for _, block in painted))
        and holes.can_be_drawn(
            holes.live_loops(instance, cell), frozenset(block for _, block in painted if block)
        )
        for cell, painted in zip(instance.cells, painting, strict=True)
    )


def defined(name: str) -> list[tuple[Division, bool]]:
    """Divisions of a graph, and whether each is a scheme."""
    instance = GRAPHS[name]
    tiny = len(instance.cells) < 3
    return [
        (holes.as_division(one), is_legal(instance, one) and holes.is_scheme(instance, one))
        for one in (anything(instance) if tiny else holes.divisions(instance, crossing=True))
    ]


@pytest.mark.parametrize("name", GRAPHS)
def test_just_the_schemes_of_the_definition(name: str) -> None:
    instance = GRAPHS[name]
    verdicts = [
        (checker.check_scheme(instance, division).is_scheme, expected)
        for division, expected in defined(name)
    ]
    assert set(verdicts) == {(True, True), (False, False)}
