"""The stages of a build: candidates, links, coloring, cleaned coloring, each a value.

Each function takes the prepared scene and what the stages before it have made.

A scene may say how far its part may be off
(:class:`~cellcolor.frontend.parts.placement.Tolerance`). Then a candidate is valid only if its
branch is valid at every displacement of a sample, and a branch leads along a mesh edge only if it
does at each. Whoever follows the colors of what is left has a motion in the same branches wherever
the sample puts the part.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.data.surface import Crack
from cellcolor.deadline import Deadline
from cellcolor.errors import InputError, naming
from cellcolor.frontend.links import Links, continuous_links, valid_links
from cellcolor.frontend.parts.surface import Surface
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
        tracked: (points, n * branches, 3) points on the bodies in each candidate, m.
        continuous: the links along which a branch moves without a jump.
        links: those of them that are valid between the vertices as well.
        coloring: the colors of all valid candidates.
        cleaned: the same after the sliver policy.
        branches: names of the branches, or of the sheets of an arm whose solutions have no names.
    """

    surface: Surface
    candidates: Candidates
    tracked: Array
    continuous: Links
    links: Links
    coloring: Coloring
    cleaned: Cleaned
    branches: tuple[str, ...]


def judged(prepared: PreparedScene, clock: StageClock) -> Stages:
    """All stages of a build.

    Raises:
        InputError: a color has two configurations on one vertex; there are too many vertices for
            the turns of the tool; a displaced part stands in a link that cannot move; a tolerance
            asks for an arm whose solutions have names.
    """
    found = _judged_in_place(prepared, clock)
    if prepared.scene.tolerance is None:
        return found
    if not prepared.arm.named:
        message = (
            "the solutions of this arm have no names, and are told apart on the part where it "
            "stands: a scene with a tolerance needs an arm whose solutions have names"
        )
        raise InputError(None, "robot.kinematics", message)
    elsewhere = [_judged_in_place(there, clock) for there in prepared.displaced()]
    return _held(prepared, found, elsewhere, clock)


def _judged_in_place(prepared: PreparedScene, clock: StageClock) -> Stages:
    """All stages with the part where it should stand."""
    deadline, setup = clock.deadline, prepared.setup
    candidates, tracked = judged_at_vertices(prepared, clock)
    with clock.timed("continuity"):
        continuous = continuous_links(prepared, candidates, deadline)
    candidates, links = with_turn(prepared, candidates), continuous
    if setup.continuity.validity_spacing_m is not None:
        with clock.timed("validity between vertices"):
            links = valid_links(prepared, candidates, continuous, tracked, None, deadline)
    return colored_stages(prepared, candidates, tracked, continuous, links, clock)


def judged_at_vertices(prepared: PreparedScene, clock: StageClock) -> tuple[Candidates, Array]:
    """All candidates, whatever lies between the vertices, and the points tracked on the bodies.

    Raises:
        InputError: there are too many vertices for the turns of the tool.
    """
    deadline, setup, surface = clock.deadline, prepared.setup, prepared.surface
    if setup.task.turn is not None:
        with naming(setup.file):
            check_turns(len(surface.vertices), len(setup.task.turn.degrees))
    with clock.timed("inverse kinematics"):
        solutions = prepared.arm.inverse(surface.vertices, -surface.normals, deadline)
    clock.begin("validity at the vertices")
    verdicts = prepared.judge(solutions.reshape(-1, solutions.shape[2]), deadline)
    clock.add(verdicts.seconds)
    return candidates_of(prepared, verdicts), verdicts.tracked


def colored_stages(
    prepared: PreparedScene,
    candidates: Candidates,
    tracked: Array,
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
        tracked=tracked,
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
    return colored_stages(prepared, candidates, stages.tracked, continuous, linked, clock)
