"""True certificates forged in one place: all refused, but what is true all the same."""

from __future__ import annotations

from itertools import islice

import pytest
from forged_certificates import FORGERIES, Original, forge, large, small
from forged_truth import claims_truth

from cellcolor.checker.certificates import verify_bound
from cellcolor.checker.groups import regions_of_cells
from cellcolor.data.bounds import Bound

pytestmark = pytest.mark.second

TIMES = 60
BUDGET = 2_000


@pytest.fixture(scope="module")
def originals() -> list[Original]:
    """Bounds of small meshes and of stored instances, some of them by conflicts."""
    return [*(found for seed in range(30) for found in small(seed)), *islice(large(), 5)]


def outcome_of(original: Original, bound: Bound) -> str:
    regions = regions_of_cells(original.instance)
    return verify_bound(original.instance, bound, regions, BUDGET).outcome


def test_what_is_forged_was_true(originals: list[Original]) -> None:
    assert {outcome_of(original, original.bound) for original in originals} == {"verified"}
    assert all(claims_truth(o, o.bound) for o in originals if o.surface is not None)
    by_conflicts = [o for o in originals if any(p["conflicts"] for p in _parts(o))]
    assert any(o.surface is None for o in by_conflicts)
    assert any(o.surface is not None for o in by_conflicts)


@pytest.mark.parametrize("kind", FORGERIES)
def test_forged_certificates_are_refused(kind: str, originals: list[Original]) -> None:
    refused = 0
    for seed in range(TIMES):
        original = originals[seed % len(originals)]
        claim = forge(kind, seed, original)
        outcome = outcome_of(original, claim)
        assert outcome != "verified" or claims_truth(original, claim), (original.name, seed)
        refused += outcome != "verified"
    assert refused > TIMES // 2


def _parts(original: Original) -> list[dict[str, object]]:
    certificate = original.bound.certificate
    assert certificate is not None
    parts: list[dict[str, object]] = certificate["parts"]
    return parts
