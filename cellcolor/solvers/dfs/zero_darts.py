"""Whether the zeros (darts in state 0) of a complete painting can be given to sub-cells rightly.

An edge in state 0 is one across which the painting does not continue. So wherever the zeros of a
gap between two sub-cells are put (section IV-C, "the 0s can be freely moved outside the bracket"),
its two sides must not show one color that is joinable there. All gaps of all cells decide
together: a 2-SAT problem with one variable for each dart that may show either of two colors.
"""

from __future__ import annotations

from collections.abc import Sequence

from cellcolor.data.darts import DartName, twin
from cellcolor.solvers.dfs.cell_schemes import CellScheme, zero_colors
from cellcolor.solvers.dfs.graph import GraphCell

Literal = int
"""``+n`` or ``-n``: variable n (from 1) is true, or false."""


def zeros_fit(cells: Sequence[GraphCell], schemes: Sequence[CellScheme]) -> bool:
    """Whether the runs of zeros can be divided so that no edge in state 0 could be joined.

    Args:
        cells: cells that no live edge connects to others.
        schemes: the scheme of each of them.
    """
    clauses: list[tuple[Literal, Literal]] = []
    shows: dict[DartName, list[tuple[int, Literal]]] = {}
    variables = 0
    for cell, scheme in zip(cells, schemes, strict=True):
        painted = [side[1] if side and side[0] == 1 else None for side in scheme.sides]
        shown = zero_colors(painted, scheme.subcells[0][0])
        variable_at: dict[int, int] = {}
        for i, colors in enumerate(shown):
            if colors is None:
                continue
            before, after = colors
            if before == after:
                shows[cell.darts[i]] = [(before, 0)]
                continue
            variables += 1
            variable_at[i] = variables  # true: it lies in the sub-cell after the gap
            shows[cell.darts[i]] = [(before, -variables), (after, variables)]
        for i, variable in variable_at.items():
            following = variable_at.get((i + 1) % len(painted))
            if following is not None:  # once the run has changed sub-cells it stays there
                clauses.append((-variable, following))
    joinable = {d: j for cell in cells for d, j in zip(cell.darts, cell.joinable, strict=True)}
    for dart, choices in shows.items():
        for color, literal in choices:
            for other_color, other in shows[twin(dart)]:
                if color != other_color or color not in joinable[dart]:
                    continue
                if literal == 0 and other == 0:
                    return False
                clauses.append((-literal or -other, -other or -literal))
    return _satisfiable(variables, clauses)


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
