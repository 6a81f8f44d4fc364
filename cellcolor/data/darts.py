"""Darts, the sides of edges, as solutions name them."""

from __future__ import annotations

from typing import overload

DartName = int | tuple[int, int]
"""A dart ``±e``, or ``(±e, strand)`` where an edge or a seam has several parallel strands, which
are numbered from 1 along ``+e``."""

Strand = tuple[int, int]
"""A dart and its strand."""


def strand_of(dart: DartName) -> Strand:
    """A dart with its strand; one that is named without a strand has its edge's only one."""
    return (dart, 1) if isinstance(dart, int) else dart


@overload
def twin(dart: Strand) -> Strand: ...
@overload
def twin(dart: DartName) -> DartName: ...
def twin(dart: DartName) -> DartName:
    """The other side of the same edge, or of the same strand of it."""
    return -dart if isinstance(dart, int) else (-dart[0], dart[1])
