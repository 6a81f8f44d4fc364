"""Solve the open graphs of the instance library, and make its index anew.

    python benchmarks/library.py [NAME …] [--time-limit S] [--solver NAME]

Looks for better divisions and bounds than ``instances/solutions`` has, for all graphs whose minimum
is open, or for those named, so many seconds in each search space; what gets better is written
there. Then ``instances/index.json`` is written from all graphs and solutions; a bound that stays
keeps its version and date. ``--time-limit 0`` solves nothing: for a better solution from elsewhere,
put into that folder as ``NAME.solution.json`` (of the search space surface:
``NAME.surface.solution.json``). Graphs are made by ``benchmarks/library_graphs.py``.
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

from cellcolor.data.bounds import Bound, greatest
from cellcolor.data.instance import Instance
from cellcolor.data.library_index import LibraryIndex
from cellcolor.data.solution import SearchSpace, Solution, Status
from cellcolor.deadline import Deadline
from cellcolor.machine import this_version
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import STRANDS, Options, Start

LIBRARY = Path(__file__).parents[1] / "instances"

PAPER = "Yang, Valls Miro, Lai, Wang, Xiong 2020"
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
    "random/hub_*": ("hubs", "a random hub, given with the specification of this project"),
    "random/planar_*": ("planar graphs", ""),
    "random/annulus_*": ("holes", ""),
    "random/islands_*": ("holes", ""),
    "random/disc_*": ("patches", ""),
    "random/sphere_*": ("closed surfaces", ""),
    "random/*torus_*": ("handles", ""),
    "*/part_*": ("parts at random", ""),
    "*/rim_*": ("rims", ""),
    "*/thin_*": ("thin bands", ""),
    "*/hub_grid_*": ("hub grids", ""),
    "*/hub_loops_*": ("hubs with loops", ""),
    "*/large_blobs_*": ("blobs", ""),
    "hard/large_*torus_*": ("handles", ""),
    "hard/large_part_*": ("parts at random", ""),
    "*/hub_*": ("hubs", ""),
    "hard/large_trees_*": ("hubs", ""),
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


def improve(name: str, graph: Instance, solver: str, time_limit: float) -> None:
    """Look for a better solution of a graph in both search spaces."""
    paper = _improved(f"{name}.solution.json", graph, "paper", solver, time_limit)
    if not paper.proved_for_surface:
        _improved(f"{name}.surface.solution.json", graph, "surface", solver, time_limit, paper)


def _improved(
    file: str,
    graph: Instance,
    space: SearchSpace,
    solver: str,
    time_limit: float,
    beside: Solution | None = None,
) -> Solution:
    """The best of what is stored and what is found; written if it says more than ``beside``."""
    path = LIBRARY / SOLUTIONS / file
    stored = Solution.read(path) if path.exists() else None
    start = None
    if stored is not None and stored.cells is not None:
        start = Start(stored.cells, stored.seams)
    deadline = Deadline.after(time_limit)
    options = Options(space, STRANDS[space], start=start, deadline=deadline)
    found = solve(graph, options, solver)
    best = found if stored is None else better(stored, found)
    worth = (
        beside is None
        or segments_of(best) < segments_of(beside)
        or best.surface_lower_bound > beside.surface_lower_bound
    )
    if best != stored and worth:
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
    bounds = needed([*(stored.bounds or ()), *(found.bounds or ())])
    lower, surface = greatest(bounds, "strands"), greatest(bounds, "surface")
    proved = fewest.segments == surface
    status: Status = "feasible" if fewest.segments is not None else "unknown"
    if proved or (fewest.search_space == "paper" and fewest.segments == lower):
        status = "optimal"
    if set(map(_worth, bounds)) == set(map(_worth, needed(stored.bounds or ()))):
        bounds = stored.bounds or ()
    merged = replace(
        fewest,
        bounds=bounds,
        lower_bound=lower,
        surface_lower_bound=surface,
        proved_for_surface=proved,
        status=status,
    )
    return stored if replace(merged, seconds=stored.seconds) == stored else merged


def segments_of(solution: Solution) -> float:
    """Its segments; of no division infinitely many."""
    return math.inf if solution.segments is None else solution.segments


def needed(bounds: Sequence[Bound]) -> tuple[Bound, ...]:
    """For each extent the best bound, and the best one with a certificate if that is less."""
    kept: list[Bound] = []
    for extent in ("surface", "strands"):
        of_extent = [bound for bound in bounds if bound.holds_for == extent]
        best = max(of_extent, key=_worth, default=None)
        certified = [bound for bound in of_extent if bound.certificate is not None]
        if best is not None and best.certificate is None and certified:
            kept.append(max(certified, key=_worth))
        if best is not None and best.value > max((b.value for b in kept), default=0):
            kept.append(best)
    return tuple(kept)


def _worth(bound: Bound) -> tuple[int, bool]:
    return bound.value, bound.certificate is not None


def main() -> None:
    """Do what is asked for."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--time-limit", type=float, default=60.0)
    parser.add_argument("--solver", default="cp-sat")
    arguments = parser.parse_args()
    if arguments.time_limit > 0:
        files = graph_files(LIBRARY)
        entries = LibraryIndex.read(LIBRARY / INDEX).entries
        proved = {entry.name for entry in entries if not entry.is_open}
        for name in arguments.names or [name for name in files if name not in proved]:
            improve(name, graph_of(files[name]), arguments.solver, arguments.time_limit)
    make_index()


if __name__ == "__main__":
    main()
