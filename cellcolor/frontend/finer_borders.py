"""Borders of colors found more exactly: the mesh edges that cross them are bisected, on request.

A color ends somewhere on the mesh edge between a vertex that has it and one that does not. A vertex
in the middle of that edge is tested like any other (inverse kinematics, tests, continuity), and
tells in which half. The finer surface is then solved, so proofs are about that surface.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cellcolor.arrays import Mask
from cellcolor.frontend.displaced import judged
from cellcolor.frontend.parts.surface import bisected
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.continuity import Coloring
from cellcolor.frontend.stage_clock import StageClock
from cellcolor.frontend.stages import Judged, Links, Stages

_WITH_SLIVERS = 4  # times as long are mesh edges at borders that the sliver policy takes away


def with_finer_borders(
    prepared: PreparedScene, clock: StageClock, found: Judged | None = None
) -> tuple[PreparedScene, Stages]:
    """The stages of a build, on a surface refined at borders as the setup says.

    Args:
        prepared: the scene.
        clock: of the build.
        found: its stages on this surface, where they are known.

    Returns:
        The scene with the last surface, and the results of the stages on it.

    Raises:
        InputError: there would be too many vertices, or as the stages do.
        OutOfTime: the deadline came first.
    """
    longest = prepared.setup.continuity.border_length_m
    found = found or judged(prepared, clock)
    while longest is not None:
        marked = _too_long(found.stages, longest)
        if not marked.any():
            break
        clock.begin("bisecting borders")
        finer = bisected(prepared.surface, marked, "continuity.border_length_m")
        prepared = replace(prepared, surface=finer)
        found = judged(prepared, clock, found)
    return prepared, found.stages


def _too_long(stages: Stages, longest: float) -> Mask:
    """The mesh edges (k,) at borders that are longer than they may be, in m.

    Which cells a sliver policy removes depends on areas and neighbors, so on borders that are gone
    afterwards. These have to be known as well, but only so well as areas ask for.
    """
    lengths, cleaned = stages.surface.lengths(stages.links.edges), stages.cleaned
    left = (lengths > longest) & _at_borders(cleaned.links, cleaned.coloring)
    taken = (lengths > _WITH_SLIVERS * longest) & _at_borders(stages.links, stages.coloring)
    return np.asarray(left | taken)


def _at_borders(links: Links, coloring: Coloring) -> Mask:
    """The mesh edges (k,) whose ends have different colors, or that have a crack."""
    first, second = (coloring.node_color[end] for end in links.edges.T)
    # A branch has at most one color at a vertex, and a color one branch.
    different = (first != second).any(axis=1)
    torn = ((first == second) & (first >= 0) & ~links.linked).any(axis=1)
    return np.asarray(different | torn)
