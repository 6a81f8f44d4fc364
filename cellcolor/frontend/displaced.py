"""The stages of a build, and what is left of them where the part stands a little off.

A scene may say how far its part may be off
(:class:`~cellcolor.frontend.parts.tolerance.Tolerance`). Then a candidate is valid only if its
branch is valid at every displacement of a sample, and a branch leads along a mesh edge only if it
does at each. The colors are made of what is left. Whoever follows them has a motion in the same
branches wherever the sample puts the part.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cellcolor.arrays import Mask
from cellcolor.errors import InputError
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.stage_clock import StageClock
from cellcolor.frontend.stages import Judged, Links, Stages, colored_stages, judged_in_place

OFF = "tolerance"
"""The reason of a candidate that is valid where the part should stand and not wherever it may."""


def run_stages(prepared: PreparedScene, clock: StageClock) -> Stages:
    """All stages, one after the other.

    Raises:
        InputError: a color has two configurations on one vertex; there are too many vertices for
            the turns of the tool; a displaced part stands in a link that cannot move.
        OutOfTime: the deadline came first.
    """
    return judged(prepared, clock).stages


def judged(prepared: PreparedScene, clock: StageClock, before: Judged | None = None) -> Judged:
    """All stages, where something may be known already; raises like :func:`run_stages`.

    Args:
        prepared: the scene.
        clock: of the build.
        before: of the same scene on a surface whose vertices are the first ones of this one, with
            the same normals. Only new vertices and new mesh edges are asked about, to the same
            result.
    """
    own = None if before is None else before.in_place or before
    found = judged_in_place(prepared, clock, own)
    if prepared.scene.tolerance is None:
        return found
    if not prepared.arm.named:
        message = (
            "the solutions of this arm have no names, and are told apart on the part where it "
            "stands: a scene with a tolerance needs an arm whose solutions have names"
        )
        raise InputError(None, "robot.kinematics", message)
    elsewhere = []
    for number, there in enumerate(prepared.displaced()):
        known = None if before is None else before.elsewhere[number]
        elsewhere.append(judged_in_place(there, clock, known))
    stages = _held(prepared, found.stages, [one.stages for one in elsewhere], clock)
    return replace(found, stages=stages, in_place=found, elsewhere=tuple(elsewhere))


def _held(
    prepared: PreparedScene, stages: Stages, elsewhere: Sequence[Stages], clock: StageClock
) -> Stages:
    """What of the stages holds at every displacement."""
    candidates = stages.candidates
    held: Mask = np.all([one.candidates.valid for one in elsewhere], axis=0)
    names, reasons = (*candidates.reason_names, OFF), candidates.reasons.copy()
    reasons[candidates.valid & ~held] = len(names) - 1
    candidates = replace(candidates, reasons=reasons, reason_names=names)
    edges = stages.links.edges
    continuous, linked = (
        Links(edges, own.linked & np.all([one.linked for one in others], axis=0))
        for own, others in (
            (stages.continuous, [one.continuous for one in elsewhere]),
            (stages.links, [one.links for one in elsewhere]),
        )
    )
    return colored_stages(prepared, stages.branches, candidates, continuous, linked, clock)
