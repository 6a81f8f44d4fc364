"""Lower bounds verified without a solver, from what their certificates say (docs/bounds.md).

Each kind of bound with a certificate has its verifier in a table. A verifier gets a
:class:`~cellcolor.checker.proof.Proof` and the certificate, and raises what speaks against it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from cellcolor.checker.color_regions import ColorRegion
from cellcolor.checker.parts_proof import verify_cells, verify_parts
from cellcolor.checker.proof import BudgetExceeded, Proof, Refused
from cellcolor.data.bound_kinds import certificate_of
from cellcolor.data.bounds import Bound
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
        bound: the bound.
        outcome: ``verified``: it is true. ``refused``: its certificate does not prove it.
            ``budget exceeded``: not known. ``no certificate``: it is taken on trust, or of a kind
            that nothing here can verify.
        reason: why it was refused, a sentence; empty otherwise.
        tried: how many choices were tried.
        budget: how many could have been tried.
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
        regions: the color regions that each cell lies in, see
            :mod:`cellcolor.checker.color_regions`.
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
