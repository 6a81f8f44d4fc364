"""What is left out on purpose: a place to leave alone, and what a share of the area leaves out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cellcolor.arrays import Mask
from cellcolor.door.subject import Subject
from cellcolor.questions.places import Place, chosen
from cellcolor.solvers.interface import Options

_FOR_FRONT = 0.5  # of the time that is left


def rest_of(
    subject: Subject, cover: float | None, place: Place | None, options: Options
) -> tuple[Subject, tuple[str, ...], float]:
    """A subject without what is left out on purpose.

    Args:
        cover: the share of the area that can be covered and is not left alone which has to be, 0 to
            1; None for all of it. What is best left out is settled first, as by ``tradeoff``.
        place: what must not be covered, see :func:`left_alone`.
        options: deadline, workers and seed of the search for what is best left out, which takes
            half of the time that is left.

    Returns:
        What has to be covered, as a subject like any other; notes on what is left out, a sentence
        each; and the share that has to be covered.

    Raises:
        InputError: the place is of another mesh, or there is no surface for it to be on; or no
            division is known that covers as much.
        OutOfTime: the deadline came before any division was known.
    """
    notes: tuple[str, ...] = ()
    if place is not None:
        whole = subject.surface
        subject = left_alone(subject, place)
        left = sorted(set(subject.surface.given_up) - set(whole.given_up))
        share = whole.vertex_areas[left].sum() / whole.vertex_areas.sum()
        notes = (f"{share:.1%} of the surface can be covered and is left alone on purpose.",)
    if cover is None or subject.graph(options.deadline).nothing_to_cover:
        return subject, notes, 1.0
    from cellcolor.questions.tradeoff import front_of  # imports a solver

    options = replace(options, deadline=options.deadline.share(_FOR_FRONT))
    choice = front_of(subject.graph(options.deadline), options).fewest_for(cover)
    why = f"{100 * cover:.1f} % of what can be covered is asked for"
    notes += (f"{why}; covered with {choice}. The rest is left out on purpose.",)
    return _without_cells(subject, choice.point.left_out), notes, choice.point.covered_share


def left_alone(subject: Subject, place: Place | None) -> Subject:
    """A subject whose surface has no colors in a place; None leaves it as it is.

    Raises:
        InputError: the place is of another mesh, or the subject has no surface.
    """
    if place is None:
        return subject
    return _restricted(subject, chosen(subject.surface, place, "left_alone"))


def _restricted(subject: Subject, mask: Mask) -> Subject:
    """The subject without colors at some vertices (n,)."""
    if subject.built is not None:
        built = subject.built.without(mask)
        return Subject(subject.path, built, built.surface)
    return Subject(None, given_surface=subject.surface.without_vertices(mask))


def _without_cells(subject: Subject, cells: tuple[int, ...]) -> Subject:
    """The subject without some cells: on its surface, or in the graph where there is none."""
    if not cells:
        return subject
    if subject.given_instance is not None:
        return Subject(None, given_instance=subject.given_instance.without_cells(cells)[0])
    return _restricted(subject, np.isin(subject.decomposition.vertex_cell, cells))
