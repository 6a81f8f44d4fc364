"""The codes of one cell (paper, section IV)."""

from __future__ import annotations

from itertools import combinations, product
from math import comb

import pytest

from cellcolor.solvers.dfs.cell_schemes import cell_schemes
from cellcolor.solvers.dfs.graph import GraphCell


def divisions(size: int) -> set[frozenset[frozenset[int]]]:
    """The divisions of a lone cell with that many edges, colors ignored.

    Each is the set of its sub-cells, as sets of the places of their darts in state 1. They come
    from the solver's own enumeration with a color for every sub-cell there can be.
    """
    colors = tuple(range(max(1, size // 2)))
    darts = tuple(range(1, size + 1))
    cell = GraphCell(0, colors, darts, (frozenset(colors),) * size)
    return {
        frozenset(frozenset(darts) for _, darts in scheme.subcells)
        for scheme in cell_schemes(cell, (None,) * size)
    }


@pytest.mark.parametrize("edges", range(1, 7))
def test_divisions_of_a_lone_cell(edges: int) -> None:
    """Catalan(n) + n, of which one block or none are 2^n."""
    found = divisions(edges)
    assert len(found) == comb(2 * edges, edges) // (edges + 1) + edges
    assert sum(len(division) == 1 for division in found) == 2**edges


def schemes_of_a_lone_cell(edges: int, colors: int) -> int:
    """The schemes by their definition (docs/semantics.md, section 3, rules 2 to 4): all are tried.

    Each dart gets 0 or the number of its block, blocks in the order of their first darts, and each
    block a color.
    """
    count = 0
    for darts in product(range(edges + 1), repeat=edges):
        blocks = list(dict.fromkeys(block for block in darts if block))
        if blocks != list(range(1, len(blocks) + 1)):
            continue  # the same division, its blocks numbered in another order
        if len(blocks) > 1 and any(darts.count(block) < 2 for block in blocks):
            continue
        if any(
            0 != darts[a] == darts[c] != darts[b] == darts[d] != 0
            for a, b, c, d in combinations(range(edges), 4)
        ):
            continue  # the blocks cross
        ones = [block for block in darts if block]
        for painted in product(range(colors), repeat=max(1, len(blocks))):
            count += not any(
                one != other and painted[one - 1] == painted[other - 1]
                for one, other in zip(ones, ones[1:] + ones[:1], strict=True)
            )
    return count


@pytest.mark.parametrize(
    ("edges", "colors", "schemes"),
    [(1, 2, 4), (2, 2, 8), (3, 2, 16), (4, 2, 36), (5, 2, 94), (6, 2, 272), (4, 3, 60)],
)
def test_a_cell_has_more_divisions_than_the_paper_says(
    edges: int, colors: int, schemes: int
) -> None:
    """The third erratum: 2^n * m with one sub-cell, and from n = 4 on others beside these.

    One sub-cell has any of the 2^n - 1 sets of darts that are not empty, in m colors; and there are
    m ways without a dart in state 1. With n = 4, two darts and the other two in another color are
    m * (m - 1) schemes more in each of two ways.
    """
    darts = tuple(range(1, edges + 1))
    lone = GraphCell(0, tuple(range(colors)), darts, (frozenset(range(colors)),) * edges)
    assert schemes_of_a_lone_cell(edges, colors) == schemes
    assert len(list(cell_schemes(lone, (None,) * edges))) == schemes
    assert (schemes > 2**edges * colors) == (edges >= 4)
