"""Whether the zeros of a painting can be moved so that no edge could still be joined (rule 5).

"The 0s can be freely moved outside the bracket" (paper, section IV-C).
"""

from __future__ import annotations

from collections.abc import Sequence

from cellcolor.data.cells_and_edges import DartName, twin
from cellcolor.solvers.dfs.cell_schemes import CellScheme, zero_colors
from cellcolor.solvers.dfs.graph import GraphCell

Literal = int
"""``+n`` or ``-n``: zero n (from 1) shows the color of the sub-cell after it, or of that before."""


def zeros_fit(cells: Sequence[GraphCell], schemes: Sequence[CellScheme]) -> bool:
    """Whether the runs of zeros can be divided so that no edge in state 0 could be joined.

    No live edge connects the cells to others.
    """
    clauses: list[tuple[Literal, Literal]] = []
    shows: dict[DartName, tuple[tuple[int, Literal], tuple[int, Literal]]] = {}
    joinable: dict[DartName, frozenset[int]] = {}
    for cell, scheme in zip(cells, schemes, strict=True):
        joinable |= zip(cell.darts, cell.joinable, strict=True)
        painted = [color if state == 1 else None for state, color in scheme.sides]
        zero_at: dict[int, int] = {}
        for i, (before, after) in enumerate(zero_colors(painted, scheme.subcells[0][0])):
            if painted[i] is None:
                zero_at[i] = zero = len(shows) + 1
                shows[cell.darts[i]] = (before, -zero), (after, zero)
        for i, zero in zero_at.items():
            following = zero_at.get((i + 1) % len(painted))
            if following is not None:  # once the run has changed sub-cells it stays there
                clauses.append((-zero, following))
    for dart, choices in shows.items():
        for color, literal in choices:
            for other_color, other in shows[twin(dart)]:
                if color == other_color and color in joinable[dart]:
                    clauses.append((-literal, -other))
    return _satisfiable(len(shows), clauses)


def _satisfiable(variables: int, clauses: Sequence[tuple[Literal, Literal]]) -> bool:
    """2-SAT: what one value implies without contradiction can be kept for good."""
    implied: dict[Literal, list[Literal]] = {}
    for a, b in clauses:
        implied.setdefault(-a, []).append(b)
        implied.setdefault(-b, []).append(a)
    chosen: set[Literal] = set()
    for variable in range(1, variables + 1):
        if variable in chosen or -variable in chosen:
            continue
        for literal in (variable, -variable):
            reached = {literal}
            stack = [literal]
            while stack:
                for following in implied.get(stack.pop(), ()):
                    if following not in reached:
                        reached.add(following)
                        stack.append(following)
            if not any(-literal in reached for literal in reached):
                chosen |= reached
                break
        else:
            return False
    return True
