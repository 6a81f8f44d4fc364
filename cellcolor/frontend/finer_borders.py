"""Borders of colors found more exactly: the mesh edges that cross them are bisected, on request.

What a color reaches ends somewhere on the mesh edge between a vertex that has it and one that has
not. A vertex in the middle of that edge is asked like any other, inverse kinematics, tests and
continuity, and tells in which half. The finer surface is the one that is solved, so whatever is
proved is proved for it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cellcolor.arrays import Mask
from cellcolor.frontend.parts.bisect import bisected
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.stage_clock import StageClock
from cellcolor.frontend.stages import Stages, run_stages

__all__ = ["with_finer_borders"]


def with_finer_borders(prepared: PreparedScene, clock: StageClock) -> tuple[PreparedScene, Stages]:
    """The stages of a build, on a surface refined at borders as far as the setup asks for.

    Returns:
        The scene with the surface that was used last, and what the stages have made of that.

    Raises:
        InputError: there would be too many vertices, or as the stages do.
        OutOfTime: the deadline came first.
    """
    longest = prepared.setup.continuity.border_length_m
    stages = run_stages(prepared, clock)
    while longest is not None:
        marked = _at_borders(stages) & (prepared.surface.lengths(stages.links.edges) > longest)
        if not marked.any():
            break
        clock.begin("bisecting borders")
        finer = bisected(prepared.surface, marked, "continuity.border_length_m")
        prepared = replace(prepared, surface=finer)
        stages = run_stages(prepared, clock)
    return prepared, stages


def _at_borders(stages: Stages) -> Mask:
    """The mesh edges (k,) whose ends have different colors, or that have a crack."""
    cleaned = stages.cleaned
    first, second = (cleaned.coloring.node_color[end] for end in cleaned.links.edges.T)
    # A branch has at most one color at a vertex, and a color one branch.
    different = (first != second).any(axis=1)
    torn = ((first == second) & (first >= 0) & ~cleaned.links.linked).any(axis=1)
    return np.asarray(different | torn)
