"""Lower bounds verified without a solver, from what their certificates say (docs/bounds.md).

A verifier gets a :class:`~cellcolor.checker.proof.Proof` and the certificate, and raises what
speaks against it. The certificate of a ``cover`` or of ``strangers`` names cells that fewer color
regions than the bound says do not touch. That of ``conflicts`` names, for each part of the surface,
such cells as well, and pairs of segments that would have to cross. What crosses is verified by
``crossing_segments``, and then every way to touch the cells is tried by ``plan_search``, to the end
or until the budget is used up.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from cellcolor.checker.crossing_segments import WORK, TwoRegions
from cellcolor.checker.groups import ColorRegion, Groups
from cellcolor.checker.plan_search import Conflict, PlanSearch
from cellcolor.checker.proof import BudgetExceeded, Proof, Refused, few
from cellcolor.data.bounds import (
    Bound,
    CertifiedCells,
    CertifiedPart,
    CertifiedParts,
    certificate_of,
)
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError

BUDGET = 200_000
"""Choices that are tried before a certificate is given up; some seconds."""

Outcome = Literal["verified", "refused", "budget exceeded", "no certificate"]


@dataclass(frozen=True, slots=True)
class BoundVerdict:
    """What came of verifying a bound.

    Attributes:
        outcome: ``verified``: it is true. ``refused``: its certificate does not prove it.
            ``budget exceeded``: not known. ``no certificate``: it is taken on trust, or of a kind
            that nothing here can verify.
        reason: why it was refused, a sentence; empty otherwise.
        tried: choices, of as many as ``budget``.
    """

    bound: Bound
    outcome: Outcome
    reason: str = ""
    tried: int = 0
    budget: int = BUDGET

    @property
    def trusted(self) -> bool:
        """Nothing here verifies or refutes it: it rests on the solver that found it."""
        return self.outcome in ("no certificate", "budget exceeded")

    def __str__(self) -> str:
        tried = f", {self.tried} of {self.budget} choices tried" if self.tried else ""
        reason = f": {self.reason}" if self.reason else ""
        return f"{self.bound}: {self.outcome}{tried}{reason}"


def verify_cells(proof: Proof, certificate: CertifiedCells, value: int) -> None:
    """Verify that fewer color regions do not touch all of the cells."""
    _verify(proof, (CertifiedPart(value, certificate.cells),), value)


def verify_parts(proof: Proof, certificate: CertifiedParts, value: int) -> None:
    """Verify that the parts together need that many segments."""
    _verify(proof, certificate.parts, value)


VERIFIERS: dict[str, Callable[[Proof, Any, int], None]] = {
    "strangers": verify_cells,
    "cover": verify_cells,
    "conflicts": verify_parts,
}
"""What proves a bound, given its certificate and value, or raises ``Refused``; by the kind's name.
They are this package's own: what says ``verified`` does not rest on what else is installed."""


def verify_bound(
    instance: Instance,
    bound: Bound,
    regions: Sequence[frozenset[ColorRegion]],
    budget: int = BUDGET,
    deadline: Deadline = NEVER,
) -> BoundVerdict:
    """Verify a lower bound of the number of segments by its certificate.

    Args:
        regions: the color regions that each cell lies in.
        budget: how many choices may be tried. The deadline ends them in the same way.
    """
    proof = Proof(instance, regions, budget, deadline)
    outcome: Outcome = "verified"
    reason = ""
    try:
        certificate = certificate_of(bound)
        if certificate is None or bound.kind not in VERIFIERS:
            return BoundVerdict(bound, "no certificate", budget=budget)
        VERIFIERS[bound.kind](proof, certificate, bound.value)
    except BudgetExceeded:
        outcome = "budget exceeded"
    except (InputError, Refused) as error:
        outcome, reason = "refused", str(error)
    return BoundVerdict(bound, outcome, reason, proof.tried, budget)


def _verify(proof: Proof, parts: Sequence[CertifiedPart], value: int) -> None:
    if sum(part.value for part in parts) < value:
        raise Refused(f"the parts need fewer than {value} segments")
    used: set[ColorRegion] = set()
    for part in parts:
        demands = {cell: proof.regions_of(cell) for cell in part.cells}
        own = frozenset[ColorRegion]().union(*demands.values())
        if not used.isdisjoint(own):
            raise Refused("one color region lies in two parts")
        used |= own
        conflicts = list(_conflicts(proof, part))
        if PlanSearch(demands, conflicts, proof.count).is_possible(part.value - 1):
            fewer = f"{part.value} {'segments' if conflicts else 'color regions'}"
            raise Refused(f"fewer than {fewer} touch all of the cells {few(part.cells)}")


def _conflicts(proof: Proof, part: CertifiedPart) -> Iterator[Conflict]:
    two_regions: dict[tuple[ColorRegion, ColorRegion], TwoRegions] = {}
    for crossing in part.conflicts:
        if proof.deadline.over:
            raise BudgetExceeded
        ends = [frozenset(cells) for cells in (*crossing.one, *crossing.other)]
        if not all(ends):
            raise Refused("a conflict names no cells")
        first = proof.region(crossing.colors[0], min(ends[0]))
        second = proof.region(crossing.colors[1], min(ends[2]))
        for number, cells in enumerate(ends):
            _one_area(proof, cells, *((first, second) if number < 2 else (second, first)))
        if (first, second) not in two_regions:
            cells_of = frozenset(proof.cells_of(first)), frozenset(proof.cells_of(second))
            two_regions[first, second] = TwoRegions(
                proof.instance, crossing.colors, cells_of, proof.count
            )
        one, other, far, farther = (min(cells) for cells in ends)
        if not two_regions[first, second].must_cross((one, other), (far, farther)):
            text = f"segments that connect cells {one} and {other}, and {far} and {farther}"
            raise Refused(f"{text}, need not cross")
        yield Conflict((first, second), (ends[0], ends[1], ends[2], ends[3]))


def _one_area(proof: Proof, cells: frozenset[int], region: ColorRegion, other: ColorRegion) -> None:
    """Hold cells of one region to be connected in its color, and outside of the other region.

    What touches one of them can then be grown over all of them: the other segment is in none.
    """
    for cell in cells:
        if region not in proof.regions_of(cell):
            raise Refused(f"cell {cell} is not in the color region of cell {min(cells)}")
        if other in proof.regions_of(cell):
            raise Refused(f"cell {cell} is in the color regions of both segments")
    darts = [dart for c in cells for loop in proof.instance.cells[c].loops for dart in loop]
    proof.count((len(cells) + len(darts)) // WORK)
    together = Groups(cells)
    for dart in darts:
        edge = proof.instance.edge(dart)
        inside = edge.left in cells and edge.right in cells
        if inside and region[0] in proof.instance.joinable(dart):
            together.join(edge.left, edge.right)
    if len(together.sets()) > 1:
        raise Refused(f"the cells {few(cells)} are not connected in color {region[0]}")
