"""The names of darts, with strands and without."""

from __future__ import annotations

import pytest

from cellcolor.data.cells_and_edges import DartName, Strand, strand_of, twin


@pytest.mark.parametrize(
    ("dart", "strand", "other"),
    [(5, (5, 1), -5), (-5, (-5, 1), 5), ((5, 2), (5, 2), (-5, 2)), ((-7, 1), (-7, 1), (7, 1))],
)
def test_strand_and_other_side(dart: DartName, strand: Strand, other: DartName) -> None:
    assert strand_of(dart) == strand
    assert twin(dart) == other
    assert twin(twin(dart)) == dart
