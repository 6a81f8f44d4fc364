"""How many minima carry a certificate that verifies: ``python benchmarks/certificates.py``.

Solves groups of instances in the search space ``paper``, 10 s each, and hands every solution that
is optimal to the checker, which knows no solver. Prints a line for each group: which kind of bound
was verified, what is taken from CP-SAT on trust, and the choices and the time that the checker
took.

    python benchmarks/certificates.py [GROUP …]    these groups only
    python benchmarks/certificates.py FILE …       graphs, labelled surfaces or scenes, one by one
    python benchmarks/certificates.py forged [N]   N forged certificates, 1,000 without a number
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

import forged_certificates
import forged_truth

import cellcolor
from cellcolor.checker.certificates import BoundVerdict, verify_bound
from cellcolor.checker.color_regions import regions_of_cells
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from cellcolor.lab.families import LARGE, MEDIUM, hub, hub_grid
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

ROOT = Path(__file__).resolve().parents[1] / "instances"
LIMIT = 10.0
SEEDS = 40

Named = Iterator[tuple[str, Instance]]


def scenes(raw: bool) -> Callable[[], Named]:
    """The paper's six scenes, built anew."""
    return lambda: built(sorted((ROOT / "scenes").glob("*.toml")), raw)


def parts(raw: bool) -> Callable[[], Named]:
    """The meshes of real shape, built anew; what the front end refuses is no instance."""
    return lambda: built(sorted((ROOT / "parts").glob("*.toml")), raw)


def built(files: list[Path], raw: bool) -> Named:
    """Graphs of scenes, with the setup's sliver policy or without."""
    for file in files:
        scene = cellcolor.read(file)
        if raw:
            scene = scene.with_setup(scene.setup.varied(slivers=None))
        try:
            yield file.stem, decompose(cellcolor.build(scene).surface)
        except InputError as error:
            print(f"{file.stem}: {error}", file=sys.stderr)


def stored(*patterns: str) -> Callable[[], Named]:
    """Graphs and surfaces that are files of the library; of a graph and its surface the graph."""

    def make() -> Named:
        found = {file for pattern in patterns for file in ROOT.glob(pattern)}
        for file in sorted(found):
            if file.with_name(file.name.replace(".surface.json", ".json")) in found - {file}:
                continue
            yield file.name, cellcolor.decompose(file)

    return make


def family(make: Callable[[int], Instance | LabelledSurface]) -> Callable[[], Named]:
    """The first seeds of a random family."""
    return lambda: ((str(seed), graph_of(make(seed))) for seed in range(SEEDS))


def graph_of(made: Instance | LabelledSurface) -> Instance:
    """The graph of what a family made."""
    return made if isinstance(made, Instance) else decompose(made)


GROUPS: dict[str, Callable[[], Named]] = {
    "scenes": scenes(raw=False),
    "scenes, raw": scenes(raw=True),
    "scenes, other raw ones": stored("scenes/feasibility/*.surface.json"),
    "real parts": parts(raw=False),
    "real parts, raw": parts(raw=True),
    "a public part": stored("parts/*.json"),
    "paper and random files": stored("paper/*.json", "random/*.json"),
    "blobs": family(MEDIUM["blobs"]),
    "blobs, 64 × 64 points": family(MEDIUM["64 × 64 points, 10 colors"]),
    "rim": family(MEDIUM["rim"]),
    "thin bands": family(MEDIUM["thin"]),
    "hubs, 6 to 45 petals": family(lambda seed: hub(seed, 6 + seed, 4)),
    "grids of hubs": family(lambda seed: hub_grid(seed, 2, 2 + seed % 3, 4, 2 + seed % 2)),
    "tori": family(LARGE["torus"]),
    "double tori": family(LARGE["double torus"]),
    "random parts": family(LARGE["parts"]),
    "patches": family(LARGE["patches"]),
}


@dataclass
class Tally:
    """What came of the instances of a group.

    Attributes:
        instances: how many.
        verified: for each kind of bound how many minima it proves by its certificate.
        trusted: for each kind how many minima it proves without one.
        tried: choices of the checker, for each minimum that was verified.
        seconds: what the checker took, for each of these.
    """

    instances: int = 0
    verified: Counter[str] = field(default_factory=Counter)
    trusted: Counter[str] = field(default_factory=Counter)
    tried: list[int] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)

    def add(self, instance: Instance, solution: Solution) -> str:
        """Count a result, and say what came of it."""
        self.instances += 1
        if solution.status != "optimal":
            return "open"
        verdict, seconds = verdict_on(instance, solution)
        if verdict.outcome != "verified":
            self.trusted[verdict.bound.kind] += 1
            return f"{verdict.bound.kind} by CP-SAT: {verdict.outcome} {verdict.reason}"
        self.verified[verdict.bound.kind] += 1
        self.tried.append(verdict.tried)
        self.seconds.append(seconds)
        return str(verdict)

    @property
    def optimal(self) -> int:
        """How many minima were proved."""
        return self.verified.total() + self.trusted.total()

    def row(self, name: str) -> str:
        """The line of the table."""
        share = f"{100 * self.verified.total() / self.optimal:.1f} %" if self.optimal else "–"
        simple = self.verified["strangers"] + self.verified["cover"]
        trusted = ", ".join(f"{number} {kind}" for kind, number in sorted(self.trusted.items()))
        cells = (
            *(name, self.instances, self.optimal, share),
            *(simple, self.verified["conflicts"], trusted or 0),
            *(max(self.tried, default=0), f"{median(self.seconds or [0]):.3f}"),
            f"{max(self.seconds, default=0):.2f}",
        )
        return f"| {' | '.join(map(str, cells))} |"


HEAD = """\
| group | instances | proved optimal | of these verified | by cover | by conflicts | by CP-SAT \
| most choices | median s | worst s |
|---|--:|--:|--:|--:|--:|---|--:|--:|--:|"""


def verdict_on(instance: Instance, solution: Solution) -> tuple[BoundVerdict, float]:
    """What the checker says of the bounds that prove a minimum, at best, and its seconds."""
    begun = time.process_time()
    regions = regions_of_cells(instance)
    proving = [bound for bound in solution.bounds or () if bound.value == solution.segments]
    verdicts = [verify_bound(instance, bound, regions) for bound in proving]
    verified = [verdict for verdict in verdicts if verdict.outcome == "verified"]
    return (verified or verdicts)[0], time.process_time() - begun


def solved(instance: Instance) -> Solution:
    """The instance's solution, or the best within the limit."""
    return solve(instance, Options(deadline=Deadline.after(LIMIT)))


def forged(wanted: int) -> None:
    """Forge certificates until so many claim what is not true, and print what the checker said.

    What is true all the same, as all colorings of a small mesh tell, is counted apart.
    """
    small = [found for seed in range(120) for found in forged_certificates.small(seed)]
    originals = [*small, *forged_certificates.large()]
    refused, true, accepted = Counter[str](), Counter[str](), Counter[str]()
    fallen, given_up = Counter[str](), Counter[str]()
    kinds = list(forged_certificates.FORGERIES)
    number = 0
    while refused.total() + given_up.total() + accepted.total() + fallen.total() < wanted:
        kind = kinds[number % len(kinds)]
        original = originals[number // len(kinds) % len(originals)]
        claim = forged_certificates.forge(kind, number, original)
        try:
            verdict = verify_bound(original.instance, claim, regions_of_cells(original.instance))
        except Exception as error:  # a checker refuses, it does not fall
            fallen[kind] += 1
            number += 1
            print(f"fell: {kind}, number {number - 1}, {original.name}: {error!r}")
            continue
        if verdict.outcome == "refused":
            refused[kind] += 1
        elif verdict.outcome == "budget exceeded":
            given_up[kind] += 1
        elif forged_truth.claims_truth(original, claim):
            true[kind] += 1
        else:
            accepted[kind] += 1
            print(f"not refused: {kind}, number {number}, {original.name}: {verdict}")
        number += 1
    print("| forged | times | refused | given up | accepted | fell | true all the same |")
    print("|---|--:|--:|--:|--:|--:|--:|")
    for kind in kinds:
        counted = [own[kind] for own in (refused, given_up, accepted, fallen)]
        print(f"| {kind} | {' | '.join(map(str, [sum(counted), *counted, true[kind]]))} |")
    sums = f"{refused.total()} of {wanted} refused, {given_up.total()} given up at the budget"
    print(f"\n{sums}, of {len(originals)} true certificates")


def main(arguments: list[str]) -> None:
    """Print what was asked for."""
    if arguments[:1] == ["forged"]:
        forged(int(arguments[1]) if len(arguments) > 1 else 1000)
        return
    files = [argument for argument in arguments if argument not in GROUPS]
    for file in files:
        instance = cellcolor.decompose(file)
        print(f"{file}: {Tally().add(instance, solved(instance))}", flush=True)
    if files:
        return
    print(HEAD, flush=True)
    for name in arguments or GROUPS:
        tally = Tally()
        for label, instance in GROUPS[name]():
            said = tally.add(instance, solved(instance))
            if "by CP-SAT" in said:
                print(f"{name}, {label}: {said}", file=sys.stderr, flush=True)
        print(tally.row(name), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
