"""The build of a scene that asks for less or more than one that is built.

Only what the difference can change is tested again, on the same surface. The results are those
of :func:`~cellcolor.frontend.build.build_prepared`, but for full circles of joints without
limits, and raise the same.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from cellcolor.arrays import Mask
from cellcolor.deadline import Deadline
from cellcolor.frontend.build import BuildResult, colored
from cellcolor.frontend.links import continuous_along, valid_along
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.validity import Verdicts
from cellcolor.frontend.reach.validity_tests import JointLimits
from cellcolor.frontend.stage_clock import StageClock


def built_asking_less(
    prepared: PreparedScene, before: BuildResult, reasons: Collection[str], clock: StageClock
) -> BuildResult:
    """The build of a scene that asks for less: only what was refused is tested again.

    Args:
        prepared: the scene that asks for less: whatever was valid before is valid.
        before: of the stricter scene. Its arm's solutions have names.
        reasons: the tests that ask for less. A candidate becomes valid only if one of them was the
            first that it failed.
    """
    deadline, edges = clock.deadline, prepared.surface.edges()
    codes = [prepared.judge.reason_names.index(reason) for reason in reasons]
    clock.begin("validity at the vertices")
    verdicts = _judged_there(prepared, before, np.isin(before.reasons, codes), deadline)
    clock.begin("continuity")
    continuous = before.continuous.copy()
    rows = np.flatnonzero((verdicts.valid[edges].all(axis=1) & ~continuous).any(axis=1))
    continuous[rows] |= continuous_along(prepared, edges[rows], verdicts, deadline)
    clock.begin("validity between vertices")
    known = before.all_colors.linked, before.verdicts.valid
    linked = valid_along(prepared, verdicts, continuous, deadline, known)
    return colored(prepared, verdicts, continuous, linked, clock)


def built_asking_more(
    prepared: PreparedScene, before: BuildResult, reasons: Collection[str], clock: StageClock
) -> BuildResult:
    """The build of a scene that asks for more: of what was valid only its new tests are made.

    A candidate that was refused before keeps that reason.

    Args:
        prepared: the scene that asks for more: whatever is valid was valid before.
        before: of the scene that asks for less. Its arm's solutions have names.
        reasons: the tests that ask for more.
    """
    deadline, edges = clock.deadline, prepared.surface.edges()
    strict = replace(prepared, left_out=frozenset(prepared.judge.reason_names) - set(reasons))
    clock.begin("validity at the vertices")
    verdicts = _judged_there(strict, before, before.verdicts.valid, deadline)
    clock.begin("continuity")
    continuous = before.continuous & verdicts.valid[edges].all(axis=1)
    if JointLimits.name in reasons:
        rows = np.flatnonzero(continuous.any(axis=1))
        continuous[rows] &= continuous_along(prepared, edges[rows], verdicts, deadline)
    clock.begin("validity between vertices")
    left = valid_along(strict, verdicts, continuous & before.all_colors.linked, deadline)
    # Near a new border of the domain all tests are made at closer points.
    known = before.all_colors.linked, before.verdicts.valid
    linked = valid_along(prepared, verdicts, left, deadline, known)
    return colored(prepared, verdicts, continuous, linked, clock)


def _judged_there(
    prepared: PreparedScene, before: BuildResult, where: Mask, deadline: Deadline
) -> Verdicts:
    """The verdicts on all candidates, those of some (n, branches) made anew."""
    known, new = before.verdicts, prepared.judge(before.configurations[where], deadline)
    configurations, reasons = known.configurations.copy(), known.reasons.copy()
    determinants, tracked = known.determinants.copy(), known.tracked.copy()
    configurations[where], reasons[where] = new.configurations, new.reasons
    determinants[where], tracked[:, where] = new.determinants, new.tracked
    return Verdicts(configurations, reasons, determinants, tracked, known.reason_names)
