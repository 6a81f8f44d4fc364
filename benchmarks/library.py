"""Solve the open graphs of the instance library, and make its index anew.

    python benchmarks/library.py [NAME …] [--time-limit S] [--solver NAME] [--workers N]

Looks for better divisions and bounds than ``instances/solutions`` has, for all graphs whose minimum
is open, or for those named, so many seconds in each search space; what gets better is written
there. Then ``instances/index.json`` is written from all graphs and solutions; a bound that stays
keeps its version and date. A bound of a kind that is gone gives way to one of as much by a kind of
today, and loses its certificate, which nothing verifies. ``--time-limit 0`` solves nothing: for a
better solution from elsewhere, put into that folder as ``NAME.solution.json`` (of the search space
surface: ``NAME.surface.solution.json``). Graphs are made by ``benchmarks/library_graphs.py``.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime
from fnmatch import fnmatch
from importlib.metadata import version
from pathlib import Path

from library_entries import INDEX, SOLUTIONS, Origin, entry_of, graph_files, graph_of

from cellcolor.data.bounds import KINDS, Bound, certificate_of, greatest
from cellcolor.data.instance import Instance
from cellcolor.data.library_index import LibraryIndex
from cellcolor.data.solution import SearchSpace, Solution, Status
from cellcolor.deadline import Deadline
from cellcolor.machine import this_version
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import STRANDS, Options, Start
from cellcolor.solvers.registry import make_solver

LIBRARY = Path(__file__).parents[1] / "instances"

EARLIER = "earlier"
"""The kind of a bound of which only an earlier version knew how it was proved."""
BY_EARLIER = "Only an earlier version proved at least"
"""How a note on such a bound begins, or on one of a kind that is gone."""

PAPER = "Yang, Valls Miro, Lai, Wang, Xiong 2020"
GONE = "random, of a family that went with version 0.2"
ORIGINS = {
    "paper/fig*": ("paper", f"a figure of {PAPER}, drawn again"),
    "paper/*": ("by hand", "given with the specification of this project, with its reason"),
    "scenes/feasibility/*": ("scenes", "a feasibility study's front end, raw cells"),
    "scenes/*": ("scenes", "built of the scene of that name, the paper's experiment"),
    "resolutions/*": ("scenes", ""),
    "parts/machined-part*": ("parts", "fandisk.obj of common-3d-test-models before a UR5"),
    "parts/*": ("parts", ""),
    "hard/*_raw*": ("parts", ""),
    "random/blobs_*": ("blobs", "random blobs, given with the specification of this project"),
    "hubs/hub_tree.json": ("hubs", f"{GONE}: cover_tree(0, 10, 4, 20, 3)"),
    "hubs/hub_wide_40.json": ("hubs", f"{GONE}: wide_hub(0, 40, 8, 2)"),
    "hard/hub_wide_80.json": ("hubs", f"{GONE}: wide_hub(0, 80, 10, 2)"),
    "random/hub_*": ("hubs", "a random hub, given with the specification of this project"),
    "random/planar_*": ("planar graphs", ""),
    "random/annulus_*": ("holes", ""),
    "random/islands_*": ("holes", ""),
    "random/disc_*": ("patches", ""),
    "random/sphere_*": ("closed surfaces", ""),
    "random/*torus_*": ("handles", ""),
    "*/part_*": ("parts at random", f"{GONE}: part(0, 150, 40)"),
    "*/rim_*": ("rims", ""),
    "*/thin_*": ("thin bands", ""),
    "*/hub_grid_*": ("hub grids", ""),
    "*/hub_loops_*": ("hubs with loops", ""),
    "*/large_blobs_*": ("blobs", ""),
    "hard/large_*torus_*": ("handles", ""),
    "hard/large_part_*": ("parts at random", f"{GONE}: LARGE['parts'](1)"),
    "*/hub_*": ("hubs", ""),
    "hard/large_trees_*": ("hubs", f"{GONE}: LARGE['trees'](1)"),
    "random/*": ("blobs", ""),
    "hard/*": ("patches", ""),
}
"""Family and source by the file's place, the first that fits; empty: what its ``meta`` says."""


def origin_of(path: Path, graph: Instance) -> Origin:
    """Where a graph comes from."""
    place = path.relative_to(LIBRARY).as_posix()
    family, source = next(found for pattern, found in ORIGINS.items() if fnmatch(place, pattern))
    return Origin(family, source or (graph.meta or {})["made_by"], "MIT")


def make_index() -> None:
    """Write the index from all graphs and solutions."""
    path = LIBRARY / INDEX
    before = LibraryIndex.read(path).entries if path.exists() else ()
    date = f"{datetime.now(UTC):%Y-%m-%d}"
    entries = [entry for entry in before if entry.file is None]
    for name, file in graph_files(LIBRARY).items():
        old = next((entry for entry in before if entry.name == name), None)
        origin = origin_of(file, graph_of(file))
        entries.append(entry_of(LIBRARY, file, origin, old, version_of, date))
    index = LibraryIndex(tuple(sorted(entries, key=lambda entry: entry.name)))
    path.write_text(index.to_json(), encoding="utf-8")
    print(f"{path}: {len(index.entries)} graphs")


def version_of(solver: str) -> str:
    """The version that a solver of this package has now."""
    own = this_version()
    return f"{own}, OR-Tools {version('ortools')}" if solver.startswith("cp") else own


def improve(
    name: str, graph: Instance, solver: str, time_limit: float, workers: int | None
) -> None:
    """Look for a better solution of a graph in the search spaces that a solver has."""
    how = solver, time_limit, workers
    paper = _improved(f"{name}.solution.json", graph, "paper", *how)
    wide = f"{name}.surface.solution.json"
    of_use = not paper.proved_for_surface or (LIBRARY / SOLUTIONS / wide).exists()
    if of_use and "surface" in make_solver(solver).abilities.search_spaces:
        _improved(wide, graph, "surface", *how, paper)


def _improved(
    file: str,
    graph: Instance,
    space: SearchSpace,
    solver: str,
    time_limit: float,
    workers: int | None,
    beside: Solution | None = None,
) -> Solution:
    """The best of what is stored and what is found; written if it says more than ``beside``."""
    path = LIBRARY / SOLUTIONS / file
    stored = Solution.read(path) if path.exists() else None
    start = None
    able = make_solver(solver).abilities.start
    if able and stored is not None and stored.cells is not None:
        start = Start(stored.cells, stored.seams)
    deadline = Deadline.after(time_limit)
    options = Options(space, STRANDS[space], deadline, workers, start=start)
    found = solve(graph, options, solver)
    best = found if stored is None else better(stored, found)
    worth = (
        beside is None
        or segments_of(best) < segments_of(beside)
        or best.surface_lower_bound > beside.surface_lower_bound
    )
    if best != stored and (worth or stored is not None):
        path.parent.mkdir(exist_ok=True)
        path.write_text(best.to_json(), encoding="utf-8")
    print(
        f"{file}: {best.segments}, at least {best.lower_bound}, {best.surface_lower_bound} on the "
        f"surface; this run {found.segments}, {found.lower_bound}, {found.seconds:.1f} s",
        flush=True,
    )
    return best


def better(stored: Solution, found: Solution) -> Solution:
    """The better division of two solutions of one graph with the better bounds of both."""
    fewest = min((stored, found), key=segments_of)
    bounds = needed([*of_today(stored), *(found.bounds or ())])
    lower, surface = greatest(bounds, "strands"), greatest(bounds, "surface")
    proved = fewest.segments == surface
    status: Status = "feasible" if fewest.segments is not None else "unknown"
    if proved or (fewest.search_space == "paper" and fewest.segments == lower):
        status = "optimal"
    if set(map(_worth, bounds)) == set(map(_worth, needed(of_today(stored)))):
        bounds = of_today(stored)
    earlier = [
        f"{BY_EARLIER} {bound.value} segments; it says {bound.kind}."
        for bound in bounds
        if bound.kind not in KINDS
    ]
    merged = replace(
        fewest,
        bounds=bounds,
        model=found.model or stored.model,
        notes=(*(note for note in fewest.notes if not note.startswith(BY_EARLIER)), *earlier),
        lower_bound=lower,
        surface_lower_bound=surface,
        proved_for_surface=proved,
        status=status,
    )
    return stored if replace(merged, seconds=stored.seconds) == stored else merged


def of_today(stored: Solution) -> tuple[Bound, ...]:
    """Its bounds without certificates that nothing verifies any more.

    What an earlier version called ``model`` or ``crossings`` need not have come from a model.
    """
    bounds = []
    for bound in stored.bounds or ():
        if certificate_of(bound) is None:
            bound = replace(bound, certificate=None)
        if bound.kind in ("model", "crossings") and stored.model is None:
            bound = replace(bound, kind=EARLIER)
        bounds.append(bound)
    return tuple(bounds)


def segments_of(solution: Solution) -> float:
    """Its segments; of no division infinitely many."""
    return math.inf if solution.segments is None else solution.segments


def needed(bounds: Sequence[Bound]) -> tuple[Bound, ...]:
    """For each extent the best bound with a certificate, of a kind of today, and of any kind.

    None that says no more than one before it; one of a kind that is gone makes none superfluous.
    """
    kept: list[Bound] = []
    for extent in ("surface", "strands"):
        of_extent = [bound for bound in bounds if bound.holds_for == extent]
        certified = [bound for bound in of_extent if bound.certificate is not None]
        today = [bound for bound in of_extent if bound.kind in KINDS]
        for group in (certified, today, of_extent):
            if group:
                best = max(group, key=_worth)
                said = [b.value for b in kept if b.kind in KINDS or best.kind not in KINDS]
                if best.value > max(said, default=0):
                    kept.append(best)
    return tuple(kept)


def _worth(bound: Bound) -> tuple[int, bool, bool]:
    return bound.value, bound.certificate is not None, bound.kind in KINDS


def main() -> None:
    """Do what is asked for."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--time-limit", type=float, default=60.0)
    parser.add_argument("--solver", default="cp-sat")
    parser.add_argument("--workers", type=int)
    arguments = parser.parse_args()
    if arguments.time_limit > 0:
        files = graph_files(LIBRARY)
        entries = LibraryIndex.read(LIBRARY / INDEX).entries
        proved = {e.name for e in entries if e.paper.proved and e.surface.proved}
        for name in arguments.names or [name for name in files if name not in proved]:
            graph = graph_of(files[name])
            improve(name, graph, arguments.solver, arguments.time_limit, arguments.workers)
    make_index()


if __name__ == "__main__":
    main()
