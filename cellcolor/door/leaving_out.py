"""What is left out on purpose: places to leave alone, and what a share or a price leaves out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.data.prices import check_price
from cellcolor.door.subject import Subject
from cellcolor.errors import InputError
from cellcolor.questions.front import Front
from cellcolor.questions.places import Place, chosen
from cellcolor.solvers.interface import Options

if TYPE_CHECKING:
    from cellcolor.arrays import Array, Mask

_FOR_FRONT = 0.5  # of the time that is left


@dataclass(frozen=True)
class Wanted:
    """What has to be covered.

    Attributes:
        cover: the share of the area that can be covered and is not left alone which has to be, 0
            to 1; None for all of it. What is best left out is settled first, as by ``tradeoff``.
        required: with a share or a price, vertices that have to be covered whatever is left out: a
            mask (n,), a :class:`~cellcolor.questions.places.WorldBox`, or what a labelled surface
            gives up.
        left_alone: vertices that must not be covered, the same kinds.
        uncovered_price: instead of a share, what it costs in lift-offs to leave out all of that
            area; a part of it costs that part. What is best left out has the least sum.

    Raises:
        InputError: the share is not from 0 to 1, the price is below 0, both are given, or something
            is required without either.
    """

    cover: float | None = None
    required: Place | None = None
    left_alone: Place | None = None
    uncovered_price: float | None = None

    def __post_init__(self) -> None:
        if self.cover is not None and not 0 <= self.cover <= 1:
            raise InputError(None, "cover", f"must be from 0 to 1, is {self.cover:g}")
        if self.uncovered_price is not None:
            check_price("uncovered_price", self.uncovered_price)
            if self.cover is not None:
                raise InputError(None, "uncovered_price", "goes without cover: either decides")
        if self.whole and self.required is not None:
            raise InputError(None, "required", "goes with cover: without it everything has to be")

    @property
    def whole(self) -> bool:
        """Whether all that is not left alone has to be covered."""
        return self.cover is None and self.uncovered_price is None


def rest_of(
    subject: Subject, wanted: Wanted, options: Options
) -> tuple[Subject, tuple[str, ...], float]:
    """A subject without what is left out on purpose.

    Args:
        options: deadline, workers and seed of the search for what is best left out, which takes
            half of the time that is left.

    Returns:
        What has to be covered, as a subject like any other; notes on what is left out, a sentence
        each; and the share that has to be covered.

    Raises:
        InputError: a place is of another mesh, or there is no surface for it to be on; or no
            division is known that covers as much.
        OutOfTime: the deadline came before any division was known.
    """
    notes: tuple[str, ...] = ()
    if wanted.left_alone is not None:
        whole = subject.surface
        subject = left_alone(subject, wanted.left_alone)
        left = sorted(set(subject.surface.given_up) - set(whole.given_up))
        share = whole.vertex_areas[left].sum() / whole.vertex_areas.sum()
        notes = (f"{share:.1%} of the surface can be covered and is left alone on purpose.",)
    if wanted.whole or subject.graph(options.deadline).nothing_to_cover:
        return subject, notes, 1.0
    options = replace(options, deadline=options.deadline.share(_FOR_FRONT))
    front = front_on(subject, None, wanted.required, options)
    if wanted.uncovered_price is not None:
        choice = front.cheapest(wanted.uncovered_price)
        why = f"Leaving out all that can be covered costs {wanted.uncovered_price:g} lift-offs"
    else:
        assert wanted.cover is not None
        choice = front.fewest_for(wanted.cover)
        why = f"{100 * wanted.cover:.1f} % of what can be covered is asked for"
    notes += (f"{why}; covered with {choice}. The rest is left out on purpose.",)
    return _without_cells(subject, choice.point.left_out), notes, choice.point.covered_share


def left_alone(subject: Subject, place: Place | None) -> Subject:
    """A subject whose surface has no colors in a place.

    Raises:
        InputError: the place is of another mesh, or the subject has no surface.
    """
    if place is None:
        return subject
    return _restricted(subject, chosen(subject.surface, place, "left_alone"))


def front_on(
    subject: Subject,
    weights: Sequence[float] | Array | None,
    required: Place | None,
    options: Options,
    progress: Callable[[str], None] | None = None,
) -> Front:
    """The front of a subject, with weights and places on its surface.

    Args:
        weights: of each vertex (n,), as a factor of its area; None for 1.

    Raises:
        InputError: weights or place are of another mesh, the subject has no surface, or nothing of
            what is required can be covered.
        OutOfTime: the deadline came before any division was known.
    """
    from cellcolor.questions.tradeoff import front_of  # imports a solver

    instance = subject.graph(options.deadline)
    cells: frozenset[int] = frozenset()
    if required is not None:
        mask = chosen(subject.surface, required, "required")
        cells = frozenset(_cells(subject)[mask].tolist()) - {OUTSIDE}
        if mask.any() and not cells and len(instance.cells):
            raise InputError(None, "required", "none of these vertices can be covered")
    per_cell = None if weights is None else _weights(subject, instance, weights)
    return front_of(instance, options, weights=per_cell, required=cells, progress=progress)


def _restricted(subject: Subject, mask: Mask) -> Subject:
    """The subject without colors at some vertices (n,)."""
    if subject.built is not None:
        built = subject.built.without(mask)
        return Subject(subject.path, built, built.surface)
    return Subject(None, given_surface=subject.surface.without_vertices(mask))


def _without_cells(subject: Subject, cells: Sequence[int]) -> Subject:
    """The subject without some cells: on its surface, or in the graph where there is none."""
    if not cells:
        return subject
    if subject.given_instance is not None:
        return Subject(None, given_instance=subject.given_instance.without_cells(cells)[0])
    return _restricted(subject, np.isin(_cells(subject), cells))


def _cells(subject: Subject) -> np.ndarray:
    """The cell of each vertex, ``OUTSIDE`` where it has none."""
    return np.array(subject.decomposition.vertex_cell, dtype=np.int64)


def _weights(subject: Subject, instance: Instance, given: Sequence[float] | Array) -> list[float]:
    """What each cell weighs: the sum over its vertices of weight times area."""
    own = np.asarray(given, dtype=float)
    areas = subject.surface.vertex_areas
    if own.shape != areas.shape:
        message = f"must be one for each of {len(areas)} vertices: are they of another mesh?"
        raise InputError(None, "weights", message)
    bad = np.flatnonzero(~((own >= 0) & np.isfinite(own)))
    if len(bad):
        text = f"must be a number from 0 on, is {own[bad[0]]:g}"
        raise InputError(None, f"weights[{bad[0]}]", text)
    cell = _cells(subject)
    inside = cell != OUTSIDE
    found = np.bincount(cell[inside], (own * areas)[inside], len(instance.cells))
    return [float(weight) for weight in found]
