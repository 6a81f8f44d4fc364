"""A solution painted with its scene: everything that is drawn is tested with the robot.

A painting that had to be refined copies colors (docs/motion.md). Here the robot says what
reaches each new vertex, and whether a segment's color leads along each mesh edge inside it. If
it rejects one of them, the refined surface gets its true colors, and is solved and painted
again; the proof is then for that surface.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cellcolor.arrays import Index, unit
from cellcolor.data.solution import Solution
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition import Decomposition, decomposition_of
from cellcolor.frontend.build import BuildResult, Progress, StageClock, build_prepared
from cellcolor.frontend.parts.surface import Surface
from cellcolor.motion.posture import color_costs, with_best_posture
from cellcolor.painting.moving import move_borders
from cellcolor.painting.paint import Painted, paint
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

_TIMES = 4
"""The most times that a surface is solved; what the scene still refuses is only reported."""


@dataclass(frozen=True)
class ScenePainting:
    """A painting that the scene was asked about.

    Attributes:
        painted: the painting, its borders moved.
        built: the labelled surface that was painted, and what reaches it: what was given, unless it
            had to be solved again.
    """

    painted: Painted
    built: BuildResult
    decomposition: Decomposition
    solution: Solution


def paint_scene(
    built: BuildResult,
    decomposition: Decomposition,
    solution: Solution,
    *,
    deadline: Deadline = NEVER,
    progress: Progress | None = None,
) -> ScenePainting:
    """Paint a solution of a scene, and ask the scene about every vertex that is new.

    For a better posture a border bends about as sharply as the rim of the tool's footprint; without
    one in the setup its radius is taken to be one mean mesh edge.

    Raises:
        InputError: the solution has no division.
        TooLarge: a painting would need too many vertices.
    """
    prepared = built.prepared
    clock = StageClock(deadline, progress)
    motion = prepared.scene.setup.motion
    radius = None if motion is None else motion.tool_radius_m
    minima: list[int] = []
    while True:
        minima.append(solution.segments or 0)
        clock.begin("painting")
        drawn = paint(built.surface, decomposition, solution, deadline)
        whole = drawn.surface is built.surface
        finer = built
        if not whole:
            normals = unit(drawn.interpolated(built.prepared.surface.normals))
            surface = Surface(drawn.surface.vertices, drawn.surface.faces, normals)
            finer = build_prepared(replace(prepared, surface=surface), clock)
        clock.begin("moving borders")
        branch = np.array(built.color_branch)
        cost = color_costs(prepared.robot, finer.verdicts)[:, branch]
        painted = move_borders(drawn, radius, cost, deadline)
        refused = () if whole else _refused(painted, finer, branch)
        if not refused or len(minima) == _TIMES:
            painted = replace(painted, minima=tuple(minima), refused=refused)
            return ScenePainting(painted, built, decomposition, solution)
        clock.begin("solving again")
        left_alone = built.left_alone
        built = finer
        if left_alone is not None:
            built = finer.without(left_alone[drawn.stands_for])
        decomposition = decomposition_of(built.surface, None, deadline)
        options = Options(solution.search_space, solution.strands, deadline=deadline)
        found = solve(decomposition.instance, options)
        solution = with_best_posture(built, decomposition, found, options)


def _refused(painted: Painted, finer: BuildResult, branch: Index) -> tuple[int, ...]:
    """The vertices where the scene refuses a painting (:class:`~cellcolor.painting.paint.Painted`).

    Args:
        branch: (colors,) of each of its colors.
    """
    colors = painted.plan.vertex_colors
    own = np.array([-1 if color is None else branch[color] for color in colors])
    colored = np.flatnonzero(own >= 0)
    refused = set(colored[~finer.verdicts.valid[colored, own[colored]]].tolist())
    edges, linked = finer.prepared.surface.mesh.edges, finer.all_colors.linked
    segment = painted.segment_of
    within = np.flatnonzero(
        (segment[edges[:, 0]] == segment[edges[:, 1]]) & (own[edges[:, 0]] >= 0)
    )
    torn = within[~linked[within, own[edges[within, 0]]]]
    for a, b in edges[torn].tolist():
        if colors[a] not in painted.surface.cracked(a, b):
            refused |= {a, b}
    return tuple(sorted(refused))
