"""The stages of a build: candidates, links, coloring, cleaned coloring, each a value.

Each function takes the prepared scene and what the stages before it have made.

A scene may say how far its part may be off
(:class:`~cellcolor.frontend.parts.placement.Tolerance`). Then a candidate is valid only if its
branch is valid at every displacement of a sample, and a branch leads along a mesh edge only if it
does at each. Whoever follows the colors of what is left has a motion in the same branches wherever
the sample puts the part.

On request the mesh edges that cross borders of colors are bisected: a vertex in the middle is
tested like any other, and tells in which half the color ends. Proofs are about the finer surface.

A verdict on a configuration depends only on the place and normal of its vertex, and whether a
branch is continuous along a mesh edge on nothing but the edge's ends. So where a surface is judged
and then one with all its vertices and some more, what is known is taken over.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cellcolor.arrays import Mask
from cellcolor.data.surface import Crack
from cellcolor.deadline import Deadline
from cellcolor.errors import InputError, naming
from cellcolor.frontend.links import Links, continuous_links, valid_links
from cellcolor.frontend.parts.surface import Surface, bisected
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.continuity import Coloring, color_nodes, find_cracks, node_links
from cellcolor.frontend.reach.slivers import SliverReport, clean
from cellcolor.frontend.reach.validity import Candidates, Verdicts
from cellcolor.frontend.sizes import check_turns
from cellcolor.frontend.stage_clock import StageClock

TURN_NOT_DEFINED = "turn not defined"
"""The reason at a vertex where the setup's rule for the tool's turn says nothing."""


@dataclass(frozen=True)
class Cleaned:
    """What a sliver policy leaves; everything, if there is none.

    Attributes:
        links: between what is left.
        coloring: of what is left.
        cracks: the mesh edges along which a color of both ends is not continuous.
        report: what was changed, None without a policy.
    """

    links: Links
    coloring: Coloring
    cracks: tuple[Crack, ...]
    report: SliverReport | None


@dataclass(frozen=True)
class Stages:
    """What the stages of a build have made, in their order.

    Attributes:
        surface: what they were asked about.
        candidates: all branches on all vertices, and what became of them.
        continuous: the links along which a branch moves without a jump.
        links: those of them that are valid between the vertices as well.
        coloring: the colors of all valid candidates.
        cleaned: the same after the sliver policy.
        branches: names of the branches, or of the sheets of an arm whose solutions have no names.
    """

    surface: Surface
    candidates: Candidates
    continuous: Links
    links: Links
    coloring: Coloring
    cleaned: Cleaned
    branches: tuple[str, ...]


@dataclass(frozen=True)
class Judged:
    """The stages of a surface, and what a finer one takes over besides.

    Attributes:
        stages: what they have made.
        verdicts: on all solutions of all vertices, (n * solutions,).
        in_place: with the part where it should stand, if ``stages`` are those that hold at every
            displacement (:mod:`cellcolor.frontend.stages`).
        elsewhere: at each displacement.
    """

    stages: Stages
    verdicts: Verdicts
    in_place: Judged | None = None
    elsewhere: tuple[Judged, ...] = ()


def judged_in_place(
    prepared: PreparedScene, clock: StageClock, before: Judged | None = None
) -> Judged:
    """All stages with the part where it should stand, where something may be known already.

    Args:
        before: of the same scene on a surface whose vertices are the first ones of this one, with
            the same normals. Only new vertices and new mesh edges are asked about, to the same
            result.

    Raises:
        InputError: a color has two configurations on one vertex; there are too many vertices for
            the turns of the tool.
    """
    deadline = clock.deadline
    known = None if before is None else before.stages
    first = 0 if known is None else len(known.surface.vertices)
    setup, surface = prepared.setup, prepared.surface
    if setup.task.turn is not None:
        with naming(setup.file):
            check_turns(len(surface.vertices), len(setup.task.turn.degrees))
    with clock.timed("inverse kinematics"):
        vertices, directions = surface.vertices[first:], -surface.normals[first:]
        solutions = prepared.arm.inverse(vertices, directions, deadline)
    clock.begin("validity at the vertices")
    verdicts = prepared.judge(solutions.reshape(-1, solutions.shape[2]), deadline)
    clock.add(verdicts.seconds)
    if before is not None and known is not None:
        verdicts = before.verdicts.followed_by(verdicts)
    candidates, tracked = candidates_of(prepared, verdicts), verdicts.tracked
    with clock.timed("continuity"):
        continuous = continuous_links(
            prepared, candidates, None if known is None else known.continuous, deadline
        )
    candidates, links = with_turn(prepared, candidates), continuous
    if prepared.setup.continuity.validity_spacing_m is not None:
        with clock.timed("validity between vertices"):
            taken = None if known is None else (known.links, known.candidates)
            links = valid_links(prepared, candidates, continuous, tracked, taken, deadline)
    return Judged(colored_stages(prepared, candidates, continuous, links, clock), verdicts)


def colored_stages(
    prepared: PreparedScene,
    candidates: Candidates,
    continuous: Links,
    links: Links,
    clock: StageClock,
) -> Stages:
    """The stages, the last ones made."""
    names = prepared.kinematics.branches
    with clock.timed("colors and cracks"):
        coloring = _colored(names, candidates, candidates.valid, links)
        clock.deadline.check()
        cleaned = _cleaned(prepared, candidates, links, coloring, clock.deadline)
    return Stages(
        surface=prepared.surface,
        candidates=candidates,
        continuous=continuous,
        links=links,
        coloring=coloring,
        cleaned=cleaned,
        branches=names,
    )


def candidates_of(prepared: PreparedScene, verdicts: Verdicts) -> Candidates:
    """Verdicts on all candidates as arrays of vertices and branches."""
    shape = len(prepared.surface.vertices), -1
    return Candidates(
        verdicts.configurations.reshape(*shape, prepared.robot.joints),
        verdicts.reasons.reshape(shape),
        verdicts.determinants.reshape(shape),
        prepared.judge.reason_names,
    )


def with_turn(prepared: PreparedScene, candidates: Candidates) -> Candidates:
    """The same with another reason where the setup's rule for the tool's turn says nothing."""
    if prepared.setup.task.turn is None:
        return candidates
    names, reasons = (*candidates.reason_names, TURN_NOT_DEFINED), candidates.reasons.copy()
    surface = prepared.surface
    reasons[prepared.arm.without_turn(surface.vertices, -surface.normals)] = len(names) - 1
    return replace(candidates, reasons=reasons, reason_names=names)


def _colored(names: tuple[str, ...], candidates: Candidates, nodes: Mask, links: Links) -> Coloring:
    """The colors of some of the candidates, ``nodes`` (n, branches)."""
    pairs = node_links(links.edges, links.linked)
    return color_nodes(nodes, candidates.configurations, pairs, names)


def _cleaned(
    prepared: PreparedScene,
    candidates: Candidates,
    links: Links,
    coloring: Coloring,
    deadline: Deadline,
) -> Cleaned:
    """What the setup's sliver policy leaves, with new colors and cracks."""
    policy, report = prepared.setup.slivers, None
    edges = links.edges
    if policy is not None:
        areas = prepared.surface.vertex_areas()
        kept, report = clean(edges, links.linked, coloring, areas, policy, deadline)
        links = Links.of(edges, links.linked & kept[edges].all(axis=1))
        coloring = _colored(prepared.kinematics.branches, candidates, kept, links)
    return Cleaned(links, coloring, find_cracks(edges, links.linked, coloring), report)


OFF = "tolerance"
"""The reason of a candidate that is valid where the part should stand and not wherever it may."""


def judged(prepared: PreparedScene, clock: StageClock, before: Judged | None = None) -> Judged:
    """All stages, where something may be known already.

    Args:
        before: as of :func:`judged_in_place`.

    Raises:
        InputError: a color has two configurations on one vertex; there are too many vertices for
            the turns of the tool; a displaced part stands in a link that cannot move.
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
    """The stages with the candidates and links that hold at every displacement."""
    candidates = stages.candidates
    held: Mask = np.all([one.candidates.valid for one in elsewhere], axis=0)
    names, reasons = (*candidates.reason_names, OFF), candidates.reasons.copy()
    reasons[candidates.valid & ~held] = len(names) - 1
    candidates = replace(candidates, reasons=reasons, reason_names=names)
    edges = stages.links.edges
    continuous, linked = (
        Links.of(edges, own.linked & np.all([one.linked for one in others], axis=0))
        for own, others in (
            (stages.continuous, [one.continuous for one in elsewhere]),
            (stages.links, [one.links for one in elsewhere]),
        )
    )
    return colored_stages(prepared, candidates, continuous, linked, clock)


_WITH_SLIVERS = 4  # times as long are mesh edges at borders that the sliver policy takes away


def with_finer_borders(prepared: PreparedScene, clock: StageClock) -> tuple[PreparedScene, Stages]:
    """The stages of a build, on a surface refined at borders as the setup says.

    Returns:
        The scene with the last surface, and the results of the stages on it.

    Raises:
        InputError: there would be too many vertices, or as the stages do.
    """
    *_, (prepared, last) = border_levels(prepared, clock)
    return prepared, last.stages


def border_levels(
    prepared: PreparedScene, clock: StageClock, found: Judged | None = None
) -> Iterator[tuple[PreparedScene, Judged]]:
    """Each surface on the way to finer borders and its stages; see :func:`with_finer_borders`.

    Args:
        found: the stages on this surface, where they are known.
    """
    longest = prepared.setup.continuity.border_length_m
    found = found or judged(prepared, clock)
    yield prepared, found
    while longest is not None:
        marked = _too_long(found.stages, longest)
        if not marked.any():
            break
        clock.begin("bisecting borders")
        finer = bisected(prepared.surface, marked, "continuity.border_length_m")
        prepared = replace(prepared, surface=finer)
        found = judged(prepared, clock, found)
        yield prepared, found


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
