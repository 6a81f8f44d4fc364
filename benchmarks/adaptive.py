"""Fine at borders only, or everywhere: ``python benchmarks/adaptive.py [SCENE …]``.

A scene's surface begins with about 500 vertices. Once its mesh edges are bisected where colors end
(``border_length_m``), and once everywhere, until none there is longer than a length that is given
with the scene: short enough that the first surface has at most a tenth of the vertices of the
second. Both are solved, and their topological graphs, which the scenes' sliver policy has made
simpler, are compared by a test of isomorphism that shares nothing with the decomposition
(``tests/support/relabelled.py``). Names of colors are no part of that: where a branch has several,
they are numbered by how much area each covers.

The two meshes have the same start, since a crossing of two borders is a point where four cells
meet, and on a mesh two opposite ones of them share a short edge: which two is up to the mesh. On
meshes that have nothing in common, both uniform and fine, graphs differ in that.

Seconds are of building, by the wall clock and of the processor, child processes included.
"""

from __future__ import annotations

import argparse
import resource
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition import decomposition_of
from cellcolor.frontend import Scene
from cellcolor.frontend.build import result_of
from cellcolor.frontend.parts.surface import bisected
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.frontend.stage_clock import StageClock
from cellcolor.frontend.stages import Stages, judged, with_finer_borders
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP / "tests" / "support"))

from relabelled import isomorphic  # noqa: E402

START = 500  # vertices
SECONDS = 300.0  # to solve
LENGTHS_M = {
    "square": 0.0045,
    "wok": 0.0035,
    "wok_obstacle": 0.003,
    "hemisphere_flat": 0.00115,
    "half_pipe": 0.0012,
    "hemisphere_tilted": 0.00105,
}


@dataclass(frozen=True)
class Measured:
    """What came of one mesh."""

    vertices: int
    instance: Instance
    solution: Solution
    seconds: float
    cpu_seconds: float

    @property
    def minimum(self) -> str:
        """Segments, and the bound if that is not the same."""
        found, bound = self.solution.segments, self.solution.lower_bound
        return f"{found}" if found == bound else f"{bound} to {found}"


def fine_everywhere(prepared: PreparedScene, clock: StageClock) -> tuple[PreparedScene, Stages]:
    """The stages on a mesh without any edge that is longer than the setup allows at borders."""
    longest, surface = prepared.setup.continuity.border_length_m, prepared.surface
    assert longest is not None  # who calls has set it
    while (marked := surface.lengths(surface.edges()) > longest).any():
        surface = bisected(surface, marked, "continuity.border_length_m")
    prepared = replace(prepared, surface=surface)
    return prepared, judged(prepared, clock).stages


def measured(
    prepared: PreparedScene,
    make: Callable[[PreparedScene, StageClock], tuple[PreparedScene, Stages]],
) -> Measured:
    """One mesh made, judged and solved."""
    clock = StageClock(NEVER, None)
    started, cpu = time.perf_counter(), _cpu_seconds()
    built = result_of(*make(prepared, clock), clock)
    seconds, cpu = time.perf_counter() - started, _cpu_seconds() - cpu
    instance = decomposition_of(built.surface).instance
    solution = solve(instance, Options(deadline=Deadline.after(SECONDS)))
    return Measured(len(built.surface.vertices), instance, solution, seconds, cpu)


def renamed(instance: Instance) -> Instance:
    """Colors of one branch numbered by the area that they cover, not by their vertices."""
    areas = [
        sum(cell.area or 0.0 for cell in instance.cells if color in cell.colors)
        for color in range(len(instance.colors))
    ]
    branches = [name.rstrip("0123456789").rstrip() for name in instance.colors]
    names = tuple(
        f"{branch} {sum(b == branch and a > area for b, a in zip(branches, areas, strict=True))}"
        for branch, area in zip(branches, areas, strict=True)
    )
    return replace(instance, colors=names)


def _cpu_seconds() -> float:
    used = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(usage.ru_utime + usage.ru_stime for usage in used)


def scene_of(name: str, start: int, longest_m: float) -> Scene:
    """One of the six scenes on a coarse mesh, fine borders asked for."""
    scene = Scene.read(TOP / "instances" / "scenes" / f"{name}.toml")
    setup = scene.setup.varied(continuity={"border_length_m": longest_m})
    return scene.varied(object={"target_vertices": start}, setup=setup)


def main() -> None:
    """The table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("scenes", nargs="*", default=[*LENGTHS_M], metavar="SCENE")
    parser.add_argument("--start", type=int, default=START, metavar="VERTICES")
    parser.add_argument("--length", type=float, metavar="METERS", help="instead of the scene's")
    arguments = parser.parse_args()
    print("| scene | mm | vertices | at borders | ratio | cells | minimum | at borders ", end="")
    print("| isomorphic | s (CPU) | at borders |\n|---|--:|--:|--:|--:|--:|--:|--:|---|--:|--:|")
    for name in arguments.scenes:
        longest = arguments.length or LENGTHS_M[name]
        prepared = prepare(scene_of(name, arguments.start, longest))
        sparse, dense = measured(prepared, with_finer_borders), measured(prepared, fine_everywhere)
        same = isomorphic(renamed(sparse.instance), renamed(dense.instance))
        cells = sorted({len(m.instance.cells) for m in (sparse, dense)})
        print(
            f"| {name} | {1000 * longest:g} | {dense.vertices:,} | {sparse.vertices:,} "
            f"| {dense.vertices / sparse.vertices:.1f} | {', '.join(map(str, cells))} "
            f"| {dense.minimum} | {sparse.minimum} | {'yes' if same else 'no'} "
            f"| {dense.seconds:.1f} ({dense.cpu_seconds:.1f}) "
            f"| {sparse.seconds:.1f} ({sparse.cpu_seconds:.1f}) |",
            flush=True,
        )


if __name__ == "__main__":
    main()
