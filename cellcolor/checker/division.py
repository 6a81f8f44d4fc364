"""Is a solution what it says: a legal division of the instance, with that many segments?"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from cellcolor.checker.certificates import BoundVerdict, verify_bound
from cellcolor.checker.claimed_numbers import number_problems
from cellcolor.checker.dart_lists import NoLists, live_lists
from cellcolor.checker.groups import ColorRegion, Groups, regions_of_cells
from cellcolor.checker.scheme_rules import (
    Joinable,
    PaintedCell,
    as_one,
    can_be_drawn,
    crossing,
    idle_cut,
    on_loops,
    superfluous,
    unavoidable_join,
    unavoidable_join_on_loops,
    unconnected_pair,
)
from cellcolor.data.cells_and_edges import Strand, strand_of, twin
from cellcolor.data.instance import Instance
from cellcolor.data.solution import CellDivision, Division, Seam, Solution
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline


@dataclass(frozen=True, slots=True)
class Report:
    """The verdict on a solution or a scheme.

    Attributes:
        problems: what is wrong, each naming its element; none when it is valid.
        not_canonical: why a legal division is not a scheme (semantics, rules 2 and 4).
        segments: as many as were counted, None when the division is not legal.
        bounds: what came of verifying each of a solution's bounds by its certificate.
    """

    problems: tuple[str, ...]
    not_canonical: tuple[str, ...]
    segments: int | None
    bounds: tuple[BoundVerdict, ...] = ()

    @property
    def valid(self) -> bool:
        """Nothing is wrong; superfluous sub-cells are not wrong."""
        return not self.problems

    def __str__(self) -> str:
        if self.problems:
            more = len(self.problems) - 1
            rest = f" (and {count(more, 'other problem')})" if more else ""
            return f"not valid: {self.problems[0]}{rest}"
        return "valid" if self.segments is None else f"valid: {count(self.segments, 'segment')}"

    @property
    def is_scheme(self) -> bool:
        """A valid division in canonical form."""
        return not self.problems and not self.not_canonical


def check_division(
    instance: Instance, division: Division, seams: Sequence[Seam] = (), strands: int = 1
) -> Report:
    """Hold a division against the instance (docs/semantics.md, sections 2, 3 and 5)."""
    if problems := _id_problems(instance, division):
        return Report(tuple(problems), (), None)
    try:
        lists = live_lists(instance, seams, strands)
    except NoLists as error:
        return Report((str(error),), (), None)
    own_colors = {seam.id: frozenset(instance.cells[seam.cell].colors) for seam in seams}

    def joinable(strand: Strand) -> frozenset[int]:
        edge = abs(strand[0])
        return own_colors[edge] if edge in own_colors else frozenset(instance.joinable(edge))

    painted: list[PaintedCell] = []
    for cell, darts in zip(division, lists, strict=True):
        block_of = {
            strand_of(name): block for block, sub in enumerate(cell.subcells) for name in sub.darts
        }
        painted.append(PaintedCell(darts, block_of, [sub.color for sub in cell.subcells]))
        found = _cell_problems(instance, cell, darts)
        if not found and (crossed := crossing(painted[-1])) is not None:
            found = [f"cells[{cell.id}].subcells: {crossed[0]} and {crossed[1]} cross"]
        problems += found
    if problems := problems or _edge_problems(division, joinable):
        return Report(tuple(problems), (), None)
    stuck = unavoidable_join(painted, joinable)
    if stuck is not None and seams:
        stuck = unavoidable_join_on_loops(on_loops(instance, division, seams, strands), joinable)
    canonical = [why for n, cell in enumerate(painted) for why in _not_canonical(n, cell, [cell])]
    return _legal(division, stuck, canonical)


def check_scheme(instance: Instance, division: Division) -> Report:
    """Hold a scheme against the instance (docs/semantics.md, section 3).

    Schemes know no seams: in cells with several loops sub-cells have to be such as can be drawn.
    """
    if instance.most_live_loops < 2:
        return check_division(instance, division)
    if problems := _id_problems(instance, division):
        return Report(tuple(problems), (), None)

    def joinable(strand: Strand) -> frozenset[int]:
        return frozenset(instance.joinable(strand[0]))

    for cell, loops in zip(division, instance.live_loops, strict=True):
        darts = [(dart, 1) for loop in loops for dart in loop]
        problems += _cell_problems(instance, cell, darts)
    if not problems:
        cells = on_loops(instance, division, (), 1)
        problems += [
            f"cells[{cell_id}].subcells: cannot be drawn without crossing each other"
            for cell_id, own in cells.items()
            if not can_be_drawn([[loop.block_of[d] for d in loop.joined()] for loop in own])
        ] or _edge_problems(division, joinable)
    if problems:
        return Report(tuple(problems), (), None)
    canonical: list[str] = []
    for cell_id, own in cells.items():
        canonical += _not_canonical(cell_id, as_one(own), own)
        if (pair := unconnected_pair(own)) is not None:
            alike = f"{pair[0]} and {pair[1]} have one color and no chain of loops connects them"
            canonical.append(f"cells[{cell_id}].subcells: {alike}")
    return _legal(division, unavoidable_join_on_loops(cells, joinable), canonical)


def _id_problems(instance: Instance, division: Division) -> list[str]:
    if [cell.id for cell in division] == [cell.id for cell in instance.cells]:
        return []
    return [f"cells: must be cells 0 to {len(instance.cells) - 1}, each once"]


def _legal(division: Division, stuck: Strand | None, not_canonical: Sequence[str]) -> Report:
    """The report on a division whose cells and joined edges are legal.

    ``stuck`` is an edge in state 0 that has to show one joinable color on both sides.
    """
    problems, segments = _segments(division)
    if stuck is not None:
        text = f"edge {_edge(stuck)}: shows one joinable color on both sides in state 0; join it"
        problems.insert(0, f"{text} (cellcolor.solvers.cpsat.painting.joined does)")
    return Report(tuple(problems), tuple(not_canonical), segments)


def check_solution(
    instance: Instance,
    solution: Solution,
    regions: Sequence[frozenset[ColorRegion]] | None = None,
    deadline: Deadline = NEVER,
) -> Report:
    """Hold a solution against its instance: its division, and every number in it.

    Lower bounds are verified by their certificates before the deadline; those without one are taken
    on trust, as far as they contradict nothing (``claimed_numbers.claims`` names them).

    Args:
        regions: the color regions that each cell lies in, if they are not to be read off the graph.
    """
    problems: list[str] = []
    reference = solution.instance
    if reference.of == "graph" and reference.sha256 != instance.sha256:
        problems.append(f"instance.sha256: the solution is not for {instance.name!r} as it is here")
    if solution.search_space == "paper" and solution.strands != 1:
        problems.append("strands: must be 1 in search space 'paper'")
    regions = regions_of_cells(instance) if regions is None else regions
    verdicts = tuple(
        verify_bound(instance, bound, regions, deadline=deadline)
        for bound in deadline.watch(solution.bounds or ())
    )
    refused = [
        f"bounds[{number}].certificate: {verdict.reason}"
        for number, verdict in enumerate(verdicts)
        if verdict.outcome == "refused"
    ]
    if solution.cells is None:
        if solution.seams:
            problems.append("seams: there are none without a division")
        problems += number_problems(instance, solution, None)
        return Report(tuple(problems + refused), (), None, verdicts)
    report = check_division(instance, solution.cells, solution.seams, solution.strands)
    problems += report.problems
    if report.segments is not None:
        problems += number_problems(instance, solution, report.segments)
    return replace(report, problems=tuple(problems + refused), bounds=verdicts)


def _cell_problems(instance: Instance, cell: CellDivision, darts: Sequence[Strand]) -> list[str]:
    """What is wrong with one cell's division, taken alone."""
    problems = []
    if not cell.subcells:
        problems.append(f"cells[{cell.id}].subcells: needs at least one sub-cell")
    own, seen = set(darts), set[Strand]()
    for number, sub in enumerate(cell.subcells):
        where = f"cells[{cell.id}].subcells[{number}]"
        if sub.color not in instance.cells[cell.id].colors:
            problems.append(f"{where}.color: cell {cell.id} cannot be painted in color {sub.color}")
        if not sub.darts and len(cell.subcells) > 1:
            # What it would show to the darts in state 0 could not be told (semantics, section 3).
            problems.append(f"{where}.darts: empty, though the cell has other sub-cells")
        for name in sub.darts:
            dart = strand_of(name)
            if dart not in own:
                not_own = f"is not a live dart of cell {cell.id}"
                problems.append(f"{where}.darts: {_text(dart)} {not_own}")
            if dart in seen:
                problems.append(f"{where}.darts: {_text(dart)} appears twice")
            seen.add(dart)
    return problems


def _edge_problems(division: Division, joinable: Joinable) -> list[str]:
    """Edges in state 1 need both sides, in one and the same joinable color."""
    color = {strand_of(name): s.color for c in division for s in c.subcells for name in s.darts}
    problems = []
    for dart, own in color.items():
        if twin(dart) not in color:
            problems.append(f"edge {_edge(dart)}: in state 1 on one side only")
        elif color[twin(dart)] != own:
            problems.append(f"edge {_edge(dart)}: joins two different colors")
        elif own not in joinable(dart):
            problems.append(f"edge {_edge(dart)}: color {own} cannot continue across it")
    return problems


def _segments(division: Division) -> tuple[list[str], int]:
    """Faults of the segment numbers, and how many segments there are."""
    subcells = {(cell.id, n): sub for cell in division for n, sub in enumerate(cell.subcells)}
    joined = Groups(subcells)
    holder = {strand_of(name): node for node, sub in subcells.items() for name in sub.darts}
    for dart, node in holder.items():
        joined.join(node, holder[twin(dart)])
    problems = []
    pieces: Counter[int] = Counter()
    components = joined.sets()
    for component in components:
        labels = {subcells[node].segment for node in component}
        if len(labels) > 1:
            where = "cells[{}].subcells[{}].segment".format(*min(component))
            problems.append(f"{where}: one segment has numbers {sorted(labels)}")
        pieces.update(labels)
    problems += [
        f"segment {value}: stands for {count} separate segments"
        for value, count in sorted(pieces.items())
        if count > 1
    ]
    if not problems and set(pieces) != set(range(len(components))):
        problems.append(f"segment numbers must be 0 to {len(components) - 1}")
    return problems, len(components)


def _not_canonical(number: int, cell: PaintedCell, loops: Sequence[PaintedCell]) -> Iterator[str]:
    """Why the division of a cell is not that of a scheme, as far as single loops tell."""
    block = superfluous(cell)
    if block is not None:
        yield f"cells[{number}].subcells[{block}]: fewer than two darts in state 1"
    for cut in filter(None, map(idle_cut, loops)):
        between = f"{_text(cut[0])} and {_text(cut[1])}"
        yield f"cells[{number}]: a cut between {between} separates equal colors"


def _text(dart: Strand) -> str:
    return str(dart[0]) if dart[1] == 1 else f"{dart[0]} strand {dart[1]}"


def _edge(dart: Strand) -> str:
    return _text((abs(dart[0]), dart[1]))
