#!/usr/bin/env python3
"""Judge a solution of an instance, with Python's standard library alone.

    python check_solution.py INSTANCE.json SOLUTION.json

Says whether the division is legal, counts its segments, and holds every number of the solution
against them and against each other. It shares no code with the package cellcolor. Lower bounds are
not proved here, only held against the division: `cellcolor check` verifies their certificates. The
rules are those of docs/semantics.md (sections 2 to 5) and docs/formats.

Exit code 0: valid. 1: not valid; each line says what is wrong and where. 2: no files of this kind.
"""

import json
import sys
from itertools import pairwise
from pathlib import Path


class Wrong(Exception):
    """What is wrong, with its place."""


def need(condition, message):
    if not condition:
        raise Wrong(message)


def whole(value):
    """Whether a value is a whole number; in JSON ``true`` is none."""
    return isinstance(value, int) and not isinstance(value, bool)


# --- the instance ---------------------------------------------------------------------------------


class Graph:
    """The cells with their colors and loops, and the joinable colors of each edge."""

    def __init__(self, document):
        need(document.get("format") == "cellcolor/instance", "instance: is no cellcolor/instance")
        cells, edges = document["cells"], document["edges"]
        self.colors = [set(cell["colors"]) for cell in cells]
        self.loops = [[list(loop) for loop in cell["loops"]] for cell in cells]
        self.sides = {edge["id"]: (edge["left"], edge["right"]) for edge in edges}
        self.joinable = {}
        for edge in edges:
            left, right = edge["left"], edge["right"]
            shared = self.colors[left] & self.colors[right] if min(left, right) >= 0 else set()
            self.joinable[edge["id"]] = set(edge.get("colors", shared)) & shared
        for place, cell in enumerate(cells):
            need(cell["id"] == place, f"instance: cells[{place}].id: must be {place}")
            need(self.colors[place], f"instance: cells[{place}].colors: has none")
        darts = {d: c for c, loops in enumerate(self.loops) for loop in loops for d in loop}
        sides = {
            s * e: side
            for e, two in self.sides.items()
            for s, side in zip((1, -1), two, strict=True)
        }
        need(
            {dart: side for dart, side in sides.items() if side >= 0} == darts
            and sum(len(loop) for loops in self.loops for loop in loops) == len(darts),
            "instance: loops: must have each side of an edge that belongs to a cell, once",
        )
        self.coverage = document.get("coverage")


# --- cyclic lists of live darts -------------------------------------------------------------------


def strands_along(dart, count):
    """The strands of a dart in the order in which a walk along its loop meets them."""
    numbers = range(1, count + 1)
    return [(dart, number) for number in (numbers if dart > 0 else reversed(numbers))]


def live_lists(graph, seams, strands):
    """One cyclic list of live darts for each cell, strands and seams put in."""
    counts = {edge: strands if own else 0 for edge, own in graph.joinable.items()}
    loops = [[list(loop) for loop in own] for own in graph.loops]
    highest = max(graph.sides, default=0)
    for seam in seams:
        where = f"seams: seam {seam['id']}"
        need(seam["id"] > highest, f"{where}: its id must be above {highest}")
        highest = seam["id"]
        need(0 <= seam["cell"] < len(loops), f"{where}: there is no cell {seam['cell']}")
        own = loops[seam["cell"]]
        near = next((loop for loop in own if seam["from"] in loop), None)
        far = next((loop for loop in own if seam["to"] in loop), None)
        need(near is not None and far is not None, f"{where}: a dart is in no loop of its cell")
        need(near is not far, f"{where}: its darts are in one loop already")
        start, place = far.index(seam["to"]) + 1, near.index(seam["from"]) + 1
        near[place:place] = [seam["id"], *far[start:], *far[:start], -seam["id"]]
        own[:] = [loop for loop in own if loop is not far]
        counts[seam["id"]] = seam["strands"]
    lists = []
    for cell, own in enumerate(loops):
        live = [loop for loop in own if any(counts[abs(dart)] for dart in loop)]
        need(len(live) < 2, f"seams: cell {cell}: loops with live darts are not connected")
        walk = live[0] if live else []
        lists.append([s for dart in walk for s in strands_along(dart, counts[abs(dart)])])
    return lists


# --- the division ---------------------------------------------------------------------------------


def dart_of(name):
    """A dart as it is written: a number, or a number and a strand."""
    return (name, 1) if whole(name) else (name[0], name[1])


def twin(dart):
    return -dart[0], dart[1]


def roots(nodes, pairs):
    """A name for the connected set of each node."""
    above = {node: node for node in nodes}

    def root(node):
        while above[node] != node:
            above[node] = above[above[node]]
            node = above[node]
        return node

    for one, other in pairs:
        above[root(one)] = root(other)
    return {node: root(node) for node in nodes}


def crossing(blocks):
    """Whether two blocks of a cyclic list interleave."""
    left = {block: blocks.count(block) for block in set(blocks)}
    stack = []
    for block in blocks:
        while block in stack and stack[-1] != block:
            if left[stack[-1]]:
                return True
            stack.pop()
        if block not in stack:
            stack.append(block)
        left[block] -= 1
    return False


def check_division(graph, cells, seams, strands):
    """The number of segments of a legal division."""
    need(
        [cell["id"] for cell in cells] == list(range(len(graph.colors))),
        f"cells: must be cells 0 to {len(graph.colors) - 1}, each once",
    )
    lists = live_lists(graph, seams, strands)
    joinable = dict(graph.joinable)
    joinable.update({seam["id"]: graph.colors[seam["cell"]] for seam in seams})
    color, holder, label = {}, {}, {}
    for cell, live in zip(cells, lists, strict=True):
        subcells, own = cell["subcells"], set(live)
        need(subcells, f"cells[{cell['id']}].subcells: needs at least one")
        for number, sub in enumerate(subcells):
            where = f"cells[{cell['id']}].subcells[{number}]"
            need(sub["color"] in graph.colors[cell["id"]], f"{where}.color: not one of its cell")
            need(sub["darts"] or len(subcells) == 1, f"{where}.darts: empty beside other sub-cells")
            label[cell["id"], number] = sub["segment"]
            for dart in map(dart_of, sub["darts"]):
                need(dart in own, f"{where}.darts: {dart} is no live dart of the cell")
                need(dart not in color, f"{where}.darts: {dart} appears twice")
                color[dart], holder[dart] = sub["color"], (cell["id"], number)
        blocks = [holder[dart] for dart in live if dart in holder]
        need(not crossing(blocks), f"cells[{cell['id']}].subcells: two of them cross")
    for dart, own in color.items():
        where = f"edge {abs(dart[0])}"
        need(twin(dart) in color, f"{where}: in state 1 on one side only")
        need(color[twin(dart)] == own, f"{where}: joins two different colors")
        need(own in joinable[abs(dart[0])], f"{where}: color {own} cannot continue across it")
    check_zeros(graph, cells, lists, seams, strands, joinable, color)
    root = roots(label, [(holder[dart], holder[twin(dart)]) for dart in color])
    number_of = {}
    for node, own in root.items():
        where = "cells[{}].subcells[{}].segment".format(*node)
        need(number_of.setdefault(own, label[node]) == label[node], f"{where}: not its segment's")
    need(
        sorted(number_of.values()) == list(range(len(number_of))),
        f"segment: numbers must be 0 to {len(number_of) - 1}, one for each segment",
    )
    return len(number_of)


# --- what darts in state 0 show (docs/semantics.md, section 3, rule 5) ----------------------------


def check_zeros(graph, cells, lists, seams, strands, joinable, color):
    """Darts in state 0 can show colors so that no edge shows one joinable color on both sides."""
    whole_lists = [
        (live, [sub["color"] for sub in cell["subcells"]][:1])
        for cell, live in zip(cells, lists, strict=True)
    ]
    if can_be_shown(whole_lists, color, joinable):
        return
    need(seams, "an edge in state 0 shows one joinable color on both sides")
    # Without seams: loop by loop. A loop without darts in state 1 shows the color of any sub-cell.
    joined, open_loops = [], []
    for cell, own in zip(cells, graph.loops, strict=True):
        colors = sorted({sub["color"] for sub in cell["subcells"]})
        for loop in own:
            darts = [
                d
                for dart in loop
                for d in strands_along(dart, strands if joinable[abs(dart)] else 0)
            ]
            if not darts:
                continue
            if any(dart in color for dart in darts):
                joined.append((darts, []))
            else:
                open_loops.append((darts, colors))
    open_loops.sort(key=lambda each: len(each[1]))

    def settled(shown):
        if not can_be_shown(joined + shown, color, joinable):
            return False
        if len(shown) == len(open_loops):
            return True
        darts, colors = open_loops[len(shown)]
        return any(settled([*shown, (darts, [own])]) for own in colors)

    need(settled([]), "an edge in state 0 shows one joinable color on both sides")


def can_be_shown(lists, color, joinable):
    """Whether the runs of darts in state 0 can change color somewhere, all together.

    A dart shows the color before its run or, from some dart of the run on, the one after it. This
    is 2-satisfiability: a dart's variable says that it shows the later one.
    """
    shown, clauses = {}, []
    for darts, alone in lists:
        ones = [place for place, dart in enumerate(darts) if dart in color]
        if not ones:
            shown.update(dict.fromkeys(darts, (alone[0], alone[0])))
            continue
        for place, following in zip(ones, [*ones[1:], ones[0] + len(darts)], strict=True):
            run = [darts[k % len(darts)] for k in range(place + 1, following)]
            ends = color[darts[place]], color[darts[following % len(darts)]]
            shown.update(dict.fromkeys(run, ends))
            clauses += [((one, False), (other, True)) for one, other in pairwise(run)]
    for dart in shown:
        other = twin(dart)
        if dart[0] < 0 or other not in shown:
            continue
        for late in (0, 1):
            for other_late in (0, 1):
                own = shown[dart][late]
                if own == shown[other][other_late] and own in joinable[abs(dart[0])]:
                    clauses.append(((dart, not late), (other, not other_late)))
    return satisfiable(clauses)


def satisfiable(clauses):
    """2-satisfiability: no literal implies its negation and is implied by it."""
    implied = {}
    for one, other in clauses:
        for first, then in ((one, other), (other, one)):
            implied.setdefault((first[0], not first[1]), []).append((then[0], bool(then[1])))
    backward = {}
    for literal, ends in implied.items():
        for end in ends:
            backward.setdefault(end, []).append(literal)
    component = {}
    for start in reversed(order_of(implied, list(implied))):
        if start in component:
            continue
        component[start], waiting = start, [start]
        while waiting:
            for literal in backward.get(waiting.pop(), ()):
                if literal not in component:
                    component[literal] = start
                    waiting.append(literal)
    return not any(
        value and (dart, False) in component and component[dart, True] == component[dart, False]
        for dart, value in component
    )


def order_of(implied, starts):
    """Literals in the order in which a depth-first search leaves them."""
    seen, order = set(), []
    for start in starts:
        if start in seen:
            continue
        seen.add(start)
        stack = [(start, iter(implied.get(start, ())))]
        while stack:
            literal, ends = stack[-1]
            end = next((e for e in ends if e not in seen), None)
            if end is None:
                order.append(literal)
                stack.pop()
            else:
                seen.add(end)
                stack.append((end, iter(implied.get(end, ()))))
    return order


# --- the numbers ----------------------------------------------------------------------------------


def check_numbers(solution, segments):
    """The solution's numbers against its division and each other."""
    known = ("optimal", "feasible", "unknown")
    need(solution["status"] in known, f"status: must be one of {', '.join(known)}")
    lower, surface = solution["lower_bound"], solution["surface_lower_bound"]
    need(lower >= surface, f"lower_bound: {lower} cannot be below surface_lower_bound, {surface}")
    bounds = solution.get("bounds")
    if bounds is not None:
        for name, kinds in (
            ("surface_lower_bound", ("surface",)),
            ("lower_bound", ("surface", "strands")),
        ):
            best = max((b["value"] for b in bounds if b["holds_for"] in kinds), default=0)
            need(solution[name] == best, f"{name}: the greatest of bounds is {best}")
    if segments is None:
        need(solution["segments"] is None, "segments: cannot be known without a division")
        need(solution["status"] == "unknown", "status: must be unknown without a division")
        need(not solution["proved_for_surface"], "proved_for_surface: there is no division")
        return
    need(solution["segments"] == segments, f"segments: the division has {segments}")
    need(
        solution["lift_offs"] == max(0, segments - 1), f"lift_offs: must be {max(0, segments - 1)}"
    )
    need(
        max(lower, surface) <= segments,
        f"lower_bound: cannot be above the {segments} segments found",
    )
    need(
        solution["proved_for_surface"] == (segments == surface),
        f"proved_for_surface: must be {segments == surface}",
    )
    bound = lower if solution["search_space"] == "paper" else surface
    if solution["status"] == "optimal":
        need(bound == segments, f"status: {segments} is not proved by a lower bound of {bound}")
    need(solution["status"] != "unknown", "status: unknown beside a division")


def check(instance, solution):
    """The number of segments of a valid solution, None without a division."""
    graph = Graph(instance)
    need(solution.get("format") == "cellcolor/solution", "solution: is no cellcolor/solution")
    need(
        solution["search_space"] != "paper" or solution["strands"] == 1,
        "strands: must be 1 in search space 'paper'",
    )
    segments = None
    if solution["cells"] is None:
        need(not solution["seams"], "seams: there are none without a division")
    else:
        segments = check_division(graph, solution["cells"], solution["seams"], solution["strands"])
    check_numbers(solution, segments)
    return segments


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        documents = []
        for name in arguments:
            documents.append(json.loads(Path(name).read_text(encoding="utf-8")))
        segments = check(*documents)
    except Wrong as error:
        print(f"not valid: {error}")
        return 1
    except (OSError, ValueError) as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 2
    except (KeyError, TypeError, AttributeError, IndexError) as error:
        print(f"not valid: a member is missing or of the wrong kind: {error!r}")
        return 1
    print("valid: no division" if segments is None else f"valid: {segments} segments")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
