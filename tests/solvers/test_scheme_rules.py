"""Every rule of schemes (docs/semantics.md, section 3), taken out of one of the two searches.

Both list just the schemes that the definition names. Without a rule one of the graphs below has
others, so :func:`test_the_schemes_of_the_definition` fails for it.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import exhaustive_minima
import holes
import pytest
from library import PAPER
from mutants import change
from rooms import BLUE, GREEN, RED, graph, petal_cells

from cellcolor.data.instance import Instance
from cellcolor.data.solution import SchemeKey, scheme_key
from cellcolor.lab.families import planar_graph
from cellcolor.solvers.cpsat import CpSatSolver
from cellcolor.solvers.dfs import ReferenceSolver
from cellcolor.solvers.interface import Options

BOTH = RED, BLUE
ALL = RED, BLUE, GREEN


def drawn(seed: int, self_edges: bool = False) -> Instance:
    return planar_graph(seed, 4 + seed % 3, 7, 3, self_edges=self_edges)


ONE_LOOP = {
    "crossing-zeros": Instance.read(PAPER / "crossing-zeros.json"),
    # The same, its list beginning between the two darts that may show either color.
    "crossing-zeros, turned": graph(
        (BOTH, (4, 5, 6, 1, 2, 3)),
        *(((RED,), (-3, -2)), ((BLUE,), (-5, -4)), ((RED,), (-1,)), ((BLUE,), (-6,))),
    ),
    "drawn 2": drawn(2),
    "drawn 4": drawn(4),
    "drawn 4, self-edges": drawn(4, self_edges=True),
    "drawn 6": drawn(6),
    # Two red sub-cells, the first and the last around a cell, are joined by way of another cell.
    "round the end": graph(
        (BOTH, (1, 2, 3, 4, 5, 6)),
        *(((RED,), (-1, -6)), ((RED,), (-2,)), ((BLUE,), (-3,)), ((BLUE,), (-4,))),
        ((RED,), (-5,)),
    ),
    # The same with blue around the end: red is taken up again after another red sub-cell.
    "inside": graph(
        (BOTH, (1, 2, 3, 4, 5, 6)),
        *(((RED,), (-1, -4)), ((BLUE,), (-2,)), ((BLUE,), (-3,)), ((RED,), (-5,)), ((RED,), (-6,))),
    ),
    # A crack that ends in the cell, for red only.
    "crack": graph(
        (BOTH, (1, 2, 6, -6, 3, 4)), *petal_cells(RED, BLUE, RED, BLUE), cracks={6: (BLUE,)}
    ),
    # A crack for blue around a red cell.
    "crack around": graph(
        (BOTH, (1, 6, 2, -6, 3, 4, 5)), *petal_cells(RED, RED, BLUE, BLUE, RED), cracks={6: (RED,)}
    ),
}
HOLES = {
    "two and two": holes.holed(0, 4, 2, 2),
    "two and two, in turn": holes.holed(4, 4, 2, 2),
    "on two loops": holes.holed(25, 5, 2, 3),
    "on three loops": holes.holed(0, 5, 3, 2),
    "a loop in either": holes.holed(20, 5, 3, 2),
    "crack": graph(
        (BOTH, (1, 2, 5, -5), (3, 4)), *petal_cells(RED, BLUE, RED, BLUE), cracks={5: (BLUE,)}
    ),
    # Three bands from loop to loop would cross: not all colors can be connected.
    "bands": graph(
        (ALL, (1, 2, 3, 4), (5, 6, 7)), *petal_cells(BLUE, GREEN, GREEN, RED, GREEN, RED, BLUE)
    ),
    # Darts 3 and 4 need not be joined. Then 3, the last of a loop, shows red, and 4, the first of
    # the other, blue.
    "last and first": graph(
        (BOTH, (1, 2, 3), (4, 5, 6)),
        *(((RED,), (-1,)), ((BLUE,), (-2, -3)), ((RED,), (-4, -5)), ((BLUE,), (-6,))),
    ),
}


@cache
def defined(holed: bool, name: str) -> tuple[int, set[SchemeKey]]:
    """The minimum and the optimal schemes, by brute force."""
    return (
        holes.optimal_schemes(HOLES[name])
        if holed
        else exhaustive_minima.optimal_schemes(ONE_LOOP[name])
    )


def as_defined(solver: CpSatSolver | ReferenceSolver, name: str, holed: bool = False) -> bool:
    """Whether a solver lists just these schemes, each once; an error is no list."""
    segments, schemes = defined(holed, name)
    instance = (HOLES if holed else ONE_LOOP)[name]
    try:
        found = [scheme_key(d) for d in solver.optimal_schemes(instance, Options(), segments)]
    except (KeyError, ValueError):  # of a search without one of its rules
        return False
    return len(found) == len(set(found)) and set(found) == schemes


@pytest.mark.parametrize("name", ONE_LOOP)
@pytest.mark.parametrize("solver", [CpSatSolver(), ReferenceSolver()])
def test_the_schemes_of_the_definition(solver: CpSatSolver | ReferenceSolver, name: str) -> None:
    assert as_defined(solver, name)


@pytest.mark.parametrize("name", HOLES)
def test_the_schemes_of_the_definition_with_holes(name: str) -> None:
    assert as_defined(CpSatSolver(), name, holed=True)


DIVISIONS = "cellcolor.solvers.cpsat.cell_divisions"
FRONTIER = "cellcolor.solvers.cpsat.frontier"
SHOWN = "cellcolor.solvers.cpsat.shown_colors"
CODES = "cellcolor.solvers.dfs.cell_schemes"
ZEROS = "cellcolor.solvers.dfs.search"

RULES = [
    # What is taken out, where, the source with and without it, and the graph whose test falls.
    (
        "1, an edge of the cell with itself",
        DIVISIONS,
        "options[place] if twin is None or twin > place else [states[twin]]",
        "options[place]",
        "drawn 4, self-edges",
    ),
    (
        "1, edges",
        FRONTIER,
        "known = tuple(states.get(darts[dart].twin) for dart in self._graph.lists[cell])",
        "known = (None,) * len(self._graph.lists[cell])",
        "drawn 2",
    ),
    (
        "2, blocks do not cross",
        DIVISIONS,
        "yield from decide(stack[: level + 1], block)",
        "yield from decide(stack, block)",
        "drawn 4",
    ),
    (
        "2, at least two darts",
        DIVISIONS,
        "min(map(len, members)) > 1 and (last == 0",
        "(last == 0",
        "drawn 2",
    ),
    (
        "3, joinable",
        DIVISIONS,
        "[ZERO, *sorted(graph.darts[dart].colors)]",
        "[ZERO, *sorted(graph.colors[cell])]",
        "crossing-zeros",
    ),
    (
        "3, one color",
        DIVISIONS,
        "if colors[block] == color and (block == last",
        "if (block == last",
        "crossing-zeros",
    ),
    (
        "3, any color without a dart in state 1",
        DIVISIONS,
        "for color in sorted(graph.colors[cell]))",
        "for color in sorted(graph.colors[cell])[:1])",
        "drawn 2",
    ),
    (
        "4, a block that goes on",
        DIVISIONS,
        "if colors[block] == color and (block == last or colors[last] != color):",
        "if colors[block] == color:",
        "inside",
    ),
    (
        "4, a new block",
        DIVISIONS,
        "if last < 0 or colors[last] != color:",
        "if True:",
        "crack around",
    ),
    (
        "4, the last dart and the first",
        DIVISIONS,
        "> 1 and (last == 0 or colors[last] != colors[0])",
        "> 1",
        "round the end",
    ),
    (
        "5, no color on both sides",
        SHOWN,
        "in product((0, 1), repeat=2) if twin in shown else ():",
        "in ():",
        "drawn 2",
    ),
    (
        "5, first the color before, then that after",
        SHOWN,
        "yield (-dart - 1, following + 1)",
        "pass",
        "crossing-zeros",
    ),
    (
        "5, the gap that the list begins in",
        SHOWN,
        "pairwise((*loop, loop[0]))",
        "pairwise(loop)",
        "crossing-zeros, turned",
    ),
    (
        "5, joinable",
        SHOWN,
        "if color == shown[twin][late_there] and color in graph.darts[dart].colors:",
        "if color == shown[twin][late_there]:",
        "crack",
    ),
    (
        "5, the color before",
        SHOWN,
        "found[dart] = met[passed - 1], met[passed % len(met)]",
        "found[dart] = (met[passed % len(met)],) * 2",
        "crossing-zeros",
    ),
    (
        "5, the color after",
        SHOWN,
        "found[dart] = met[passed - 1], met[passed % len(met)]",
        "found[dart] = (met[passed - 1],) * 2",
        "crossing-zeros",
    ),
    (
        "1, an edge of the cell with itself",
        CODES,
        "if not 0 <= partner < i:",
        "if True:",
        "drawn 4, self-edges",
    ),
    (
        "1, a dart in state 1 beyond one in state 0",
        CODES,
        "colors = [side[1]] if side[0] == 1 else []",
        "colors = sorted(self._cell.joinable[i])",
        "drawn 2",
    ),
    (
        "1, a dart in state 0 beyond one in state 1",
        CODES,
        "if (side is None or side[0] == 0) and not",
        "if not",
        "drawn 2",
    ),
    (
        "2, blocks do not cross",
        CODES,
        "code.opened[: level + 1], i)",
        "code.opened, i)",
        "drawn 4",
    ),
    (
        "2, at least two darts",
        CODES,
        "if len(darts) > 1 and any(len(places) == 1 for places in darts):",
        "if False:",
        "drawn 2",
    ),
    (
        "3, joinable",
        CODES,
        "colors = sorted(self._cell.joinable[i]) if",
        "colors = sorted(self._cell.colors) if",
        "crossing-zeros",
    ),
    (
        "3, one color",
        CODES,
        "if code.colors[own] in colors and self._follows(",
        "if self._follows(",
        "crossing-zeros",
    ),
    (
        "3, the color across the edge",
        CODES,
        "colors = [side[1]] if side[0] == 1 else []",
        "colors = sorted(self._cell.joinable[i]) if side[0] == 1 else []",
        "drawn 2",
    ),
    (
        "3, any color without a dart in state 1",
        CODES,
        "for color in self._cell.colors:",
        "for color in self._cell.colors[:1]:",
        "drawn 2",
    ),
    (
        "4",
        CODES,
        "return (own == before or color != code.colors[before]) and self._gap(",
        "return self._gap(",
        "drawn 2",
    ),
    (
        "4, the last dart and the first",
        CODES,
        "if own != 0 and color == code.colors[0]:",
        "if False:",
        "round the end",
    ),
    (
        "5, no color on both sides",
        ZEROS,
        "return _satisfiable(len(shows), clauses)",
        "return True",
        "crossing-zeros",
    ),
    (
        "5, first the color before, then that after",
        ZEROS,
        "clauses.append((-zero, following))",
        "pass",
        "crossing-zeros",
    ),
    (
        "5, the gap that the list begins in",
        ZEROS,
        "zero_at.get((i + 1) % len(painted))",
        "zero_at.get(i + 1)",
        "crossing-zeros, turned",
    ),
    (
        "5, joinable",
        ZEROS,
        "if color == other_color and color in joinable[dart]:",
        "if color == other_color:",
        "crack",
    ),
    (
        "5, the color before",
        CODES,
        "shown.append((ones[passed - 1], ones[passed % len(ones)]))",
        "shown.append((ones[passed % len(ones)],) * 2)",
        "crossing-zeros",
    ),
    (
        "5, the color after",
        CODES,
        "shown.append((ones[passed - 1], ones[passed % len(ones)]))",
        "shown.append((ones[passed - 1],) * 2)",
        "crossing-zeros",
    ),
    (
        "5, either of two colors",
        CODES,
        "(0, before if before == after else EITHER)",
        "(0, before)",
        "crossing-zeros",
    ),
]

RULES_WITH_HOLES = [
    (
        "1, an edge of the cell with itself",
        DIVISIONS,
        "if any(t is not None and states[t] != own for own, t in zip(states, twins, strict=True)):",
        "if False:",
        "crack",
    ),
    (
        "2, at least two darts",
        DIVISIONS,
        "if len(parts) < 2 or min(map(len, parts)) > 1:",
        "if True:",
        "two and two",
    ),
    (
        "2, blocks do not cross on a loop",
        DIVISIONS,
        "if any(a == c != b == d for a, b, c, d in combinations(held, 4)):",
        "if False:",
        "on two loops",
    ),
    (
        "2, blocks can be drawn",
        DIVISIONS,
        "if one_loop or can_be_drawn(cell, made):",
        "if True:",
        "bands",
    ),
    (
        "3, one color",
        DIVISIONS,
        "if ones[part[0]] == ones[dart]:",
        "if True:",
        "two and two",
    ),
    (
        "4, on each loop",
        DIVISIONS,
        "if one != other and blocks[one][0] == blocks[other][0]:",
        "if False:",
        "on three loops",
    ),
    (
        "4, blocks that no chain connects",
        DIVISIONS,
        "and connected[one] != connected[other]",
        "and False",
        "two and two, in turn",
    ),
    (
        "5, a gap is one of a loop",
        SHOWN,
        "for loop in graph.loops[cell]:\n        for dart, following",
        "for loop in [sum(map(tuple, graph.loops[cell]), ())]:\n        for dart, following",
        "last and first",
    ),
    (
        "5, a loop without darts in state 1 lies in any block",
        SHOWN,
        "[_gap_colors(loop, color_of, color) for color in every]",
        "[_gap_colors(loop, color_of, color) for color in every[:1]]",
        "a loop in either",
    ),
]

SAVE_TIME = [
    # What ends a branch that leads to no scheme, and what makes fronts look alike.
    (
        "a block with one dart is not complete",
        DIVISIONS,
        "if len(members[block]) == 1:\n                        break",
        "pass",
    ),
    ("zeros of one color on both sides", SHOWN, "if pair[0] == pair[1]:", "if False:"),
    (
        "colors that cannot be joined are alike",
        SHOWN,
        "color if color in graph.darts[dart].colors else -1 for color",
        "color for color",
    ),
    ("a bracket with one dart stays open", CODES, "if code.owner.count(own) == 1:", "if False:"),
    ("room for its second dart", CODES, "if several and single > self._room[i]:", "if False:"),
    (
        "what solved neighbors show",
        CODES,
        "forced_after = False\n",
        "return True\n        forced_after = False\n",
    ),
]


def of(module: str) -> CpSatSolver | ReferenceSolver:
    """The solver that uses a module."""
    return ReferenceSolver() if ".dfs." in module else CpSatSolver()


def names(table: list[Any]) -> list[str]:
    return [f"{module.rpartition('.')[2]}: {rule}" for rule, module, *_ in table]


@pytest.mark.parametrize(("rule", "module", "old", "new", "name"), RULES, ids=names(RULES))
def test_every_rule_is_needed(
    rule: str, module: str, old: str, new: str, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert as_defined(of(module), name)
    change(monkeypatch, module, old, new)
    assert not as_defined(of(module), name), rule


@pytest.mark.parametrize(
    ("rule", "module", "old", "new", "name"), RULES_WITH_HOLES, ids=names(RULES_WITH_HOLES)
)
def test_every_rule_for_holes_is_needed(
    rule: str, module: str, old: str, new: str, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert as_defined(CpSatSolver(), name, holed=True)
    change(monkeypatch, module, old, new)
    assert not as_defined(CpSatSolver(), name, holed=True), rule


@pytest.mark.parametrize(("what", "module", "old", "new"), SAVE_TIME, ids=names(SAVE_TIME))
def test_what_saves_time_changes_no_schemes(
    what: str, module: str, old: str, new: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    change(monkeypatch, module, old, new)
    assert all(as_defined(of(module), name) for name in ONE_LOOP), what
