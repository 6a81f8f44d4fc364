"""What an instance knows of itself: live edges, loops and darts, against the rule in the text."""

from __future__ import annotations

import pytest
from hypothesis import given
from meshes import surfaces

from cellcolor.data.cells_and_edges import DartName, Strand, strand_of, twin
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose


def alive(instance: Instance, dart: int) -> bool:
    """An edge between two cells is live if they share a color that is not cracked along it."""
    (edge,) = (edge for edge in instance.edges if edge.id == abs(dart))
    if -1 in (edge.left, edge.right):
        return False
    shared = set(instance.cells[edge.left].colors) & set(instance.cells[edge.right].colors)
    return bool(shared if edge.colors is None else edge.colors)


@given(surfaces())
def test_what_is_live(surface: LabelledSurface) -> None:
    instance = decompose(surface)
    assert set(instance.live_edges) == {e.id for e in instance.edges if alive(instance, e.id)}
    darts = []
    for cell, loops in zip(instance.cells, instance.live_loops, strict=True):
        left = iter(loops)
        for loop in cell.loops:
            own = tuple(dart for dart in loop if alive(instance, dart))
            assert own == () or own == next(left)
        assert next(left, None) is None
        darts.append(sum(alive(instance, dart) for loop in cell.loops for dart in loop))
    assert instance.most_live_darts == max(darts, default=0)
    assert instance.most_live_loops == max(map(len, instance.live_loops), default=0)


@pytest.mark.parametrize(
    ("dart", "strand", "other"),
    [(5, (5, 1), -5), (-5, (-5, 1), 5), ((5, 2), (5, 2), (-5, 2)), ((-7, 1), (-7, 1), (7, 1))],
)
def test_strand_and_other_side(dart: DartName, strand: Strand, other: DartName) -> None:
    assert strand_of(dart) == strand
    assert twin(dart) == other
    assert twin(twin(dart)) == dart
