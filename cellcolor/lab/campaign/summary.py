"""What a campaign has looked at, in numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

from cellcolor.lab.campaign.pool import Outcome

_BINS: tuple[tuple[int, str], ...] = (
    (1, "1"),
    (2, "2"),
    (4, "3-4"),
    (6, "5-6"),
    (9, "7-9"),
    (16, "10-16"),
    (99, "17-99"),
    (999, "100-999"),
)


@dataclass(slots=True)
class Tally:
    """Counts, of one family or of all together.

    Attributes:
        instances: looked at.
        proved: of these, with one minimum that every solver proved.
        scheme_sets: whose sets of optimal schemes are the same.
        always_cut: of these, with a cutting path in every optimum.
        meshes: compared with a search over the vertices of the mesh.
        meshes_alike: of these, with as many segments in both.
        disagreements: what went wrong.
        seconds: of all processes together.
    """

    instances: int = 0
    proved: int = 0
    scheme_sets: int = 0
    always_cut: int = 0
    meshes: int = 0
    meshes_alike: int = 0
    disagreements: int = 0
    seconds: float = 0.0

    def add(self, outcome: Outcome) -> None:
        """Count one more."""
        finding, mesh = outcome.finding, outcome.mesh
        self.instances += 1
        self.proved += finding is not None and finding.minimum is not None
        self.scheme_sets += finding is not None and finding.schemes is not None
        self.always_cut += finding is not None and finding.always_cut is True
        self.meshes += mesh is not None
        self.meshes_alike += mesh is not None and mesh.segments == mesh.by_vertices
        self.disagreements += len(outcome.wrong)
        self.seconds += outcome.seconds


@dataclass(slots=True)
class Summary:
    """What a campaign has looked at so far.

    Attributes:
        total: everything.
        kinds: the same for each family.
    """

    total: Tally = field(default_factory=Tally)
    kinds: dict[str, Tally] = field(default_factory=dict)
    _outcomes: list[Outcome] = field(default_factory=list)

    def add(self, outcome: Outcome) -> None:
        """Count one more."""
        self.total.add(outcome)
        self.kinds.setdefault(outcome.kind, Tally()).add(outcome)
        self._outcomes.append(outcome)

    def histograms(self) -> dict[str, Sequence[tuple[str, int]]]:
        """How hard the instances were: per measure, instances in each range of values."""

        def schemes(outcome: Outcome) -> int | None:
            return None if outcome.finding is None else outcome.finding.schemes

        def minimum(outcome: Outcome) -> int | None:
            return None if outcome.finding is None else outcome.finding.minimum

        measures: dict[str, Callable[[Outcome], int | None]] = {
            "cells": lambda outcome: outcome.cells,
            "most live darts of a cell": lambda outcome: outcome.darts,
            "fewest segments": minimum,
            "optimal schemes": schemes,
        }
        return {name: _binned(map(of, self._outcomes)) for name, of in measures.items()}


def _binned(values: Iterable[int | None]) -> Sequence[tuple[str, int]]:
    names = [name for _, name in _BINS] + ["1000 and more"]
    counts: Counter[str] = Counter()
    for value in values:
        if value is not None:
            counts[next((name for most, name in _BINS if value <= most), names[-1])] += 1
    return [(name, counts[name]) for name in names if counts[name]]
