"""The stages of a scene that asks for less or more than one whose stages are before.

Only what the difference can change is tested again, on the same surface. The results are those
of :func:`~cellcolor.frontend.stages.judged`, but for full circles of joints without
limits, and raise the same.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from cellcolor.arrays import Index
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import Deadline
from cellcolor.frontend.links import Links, linked_along, valid_links
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.validity import Verdicts
from cellcolor.frontend.reach.validity_tests import JointLimits
from cellcolor.frontend.stage_clock import StageClock
from cellcolor.frontend.stages import Stages, candidates_of, colored_stages, with_turn


def judged_asking_less(
    prepared: PreparedScene, before: Stages, reasons: Collection[str], clock: StageClock
) -> Stages:
    """All stages of a scene that asks for less: only what was refused is tested again.

    Args:
        prepared: the scene that asks for less: whatever was valid before is valid.
        before: of the stricter scene. Its arm's solutions have names.
        reasons: the tests that ask for less. A candidate becomes valid only if one of them was the
            first that it failed.
    """
    deadline = clock.deadline
    clock.begin("validity at the vertices")
    codes = [prepared.judge.reason_names.index(reason) for reason in reasons]
    rows = np.flatnonzero(np.isin(before.candidates.reasons.ravel(), codes))
    verdicts = _judged_there(prepared, before, rows, deadline)
    candidates = with_turn(prepared, candidates_of(prepared, verdicts))
    with clock.timed("continuity"):
        edges, linked = before.continuous.edges, before.continuous.linked.copy()
        both = candidates.valid[edges].all(axis=1)
        rows = np.flatnonzero((both & ~linked).any(axis=1))
        linked[rows] |= linked_along(prepared, edges[rows], candidates, deadline)
        continuous = links = Links.of(edges, linked)
    if prepared.setup.continuity.validity_spacing_m is not None:
        with clock.timed("validity between vertices"):
            links = valid_links(
                prepared,
                candidates,
                continuous,
                verdicts.tracked,
                (before.links, before.candidates),
                deadline,
                # A point that fails another test fails it still, and is tested as long as there are
                # as many (where a border has come or gone, all points are tested anyway).
                anew=continuous.linked
                & ~before.links.linked
                & np.isin(before.links.reasons, [VALID, *codes]),
            )
    return colored_stages(prepared, candidates, verdicts.tracked, continuous, links, clock)


def judged_asking_more(
    prepared: PreparedScene, before: Stages, reasons: Collection[str], clock: StageClock
) -> Stages:
    """All stages of a scene that asks for more: of what was valid only its new tests are made.

    A candidate that was refused before keeps that reason.

    Args:
        prepared: the scene that asks for more: whatever is valid was valid before.
        before: of the scene that asks for less. Its arm's solutions have names.
        reasons: the tests that ask for more.
    """
    deadline = clock.deadline
    strict = replace(prepared, judge=prepared.judge.only(frozenset(reasons)))
    clock.begin("validity at the vertices")
    rows = np.flatnonzero(before.candidates.reasons.ravel() == VALID)
    verdicts = _judged_there(strict, before, rows, deadline)
    candidates = with_turn(prepared, candidates_of(prepared, verdicts))
    with clock.timed("continuity"):
        edges = before.continuous.edges
        linked = before.continuous.linked & candidates.valid[edges].all(axis=1)
        if JointLimits.name in reasons:
            rows = np.flatnonzero(linked.any(axis=1))
            linked[rows] &= linked_along(prepared, edges[rows], candidates, deadline)
        continuous = links = Links.of(edges, linked)
    if prepared.setup.continuity.validity_spacing_m is not None:
        with clock.timed("validity between vertices"):
            left, tracked = Links.of(edges, linked & before.links.linked), verdicts.tracked
            left = valid_links(strict, candidates, left, tracked, None, deadline)
            # Near a new border of the domain all tests are made at closer points.
            taken = before.links, before.candidates
            links = valid_links(prepared, candidates, left, tracked, taken, deadline)
    return colored_stages(prepared, candidates, verdicts.tracked, continuous, links, clock)


def _judged_there(
    prepared: PreparedScene, before: Stages, rows: Index, deadline: Deadline
) -> Verdicts:
    """The verdicts on all candidates, those of some rows (k,) made anew."""
    known = before.candidates
    configurations = known.configurations.reshape(-1, prepared.robot.joints).copy()
    reasons, determinants = known.reasons.flatten(), known.determinants.flatten()
    new = prepared.judge(configurations[rows], deadline)
    configurations[rows], reasons[rows] = new.configurations, new.reasons
    determinants[rows], tracked = new.determinants, before.tracked.copy()
    tracked[:, rows] = new.tracked
    return Verdicts(configurations, reasons, determinants, tracked, new.seconds)
