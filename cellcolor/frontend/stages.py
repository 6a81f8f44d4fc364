"""The stages of a build: candidates, links, coloring, cleaned coloring, each a value.

Each function takes the prepared scene and what the stages before it have made.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.surface import Crack
from cellcolor.deadline import Deadline
from cellcolor.frontend.contact.collision import longest_steps
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.between import at_domain_border, remains_valid
from cellcolor.frontend.reach.continuity import Coloring, color_nodes, find_cracks, link, node_links
from cellcolor.frontend.reach.slivers import SliverReport, clean
from cellcolor.frontend.reach.smooth import Measure
from cellcolor.frontend.reach.validity import Candidates, Verdicts
from cellcolor.frontend.stage_clock import StageClock

__all__ = ["Cleaned", "Links", "Stages", "run_stages"]

_AT_ONCE = 50_000  # mesh edges, or links on them; a matter of memory: some kilobytes each


@dataclass(frozen=True)
class Links:
    """Which branches lead along which mesh edges.

    Attributes:
        edges: (k, 2) all mesh edges, as vertex indices.
        linked: (k, branches).
    """

    edges: Index
    linked: Mask


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
    """

    surface: Surface
    candidates: Candidates
    continuous: Links
    links: Links
    coloring: Coloring
    cleaned: Cleaned


def run_stages(prepared: PreparedScene, clock: StageClock) -> Stages:
    """All stages, one after the other.

    Raises:
        InputError: a color has two configurations on one vertex.
        OutOfTime: the deadline came first.
    """
    with clock.timed("inverse kinematics"):
        solutions = prepared.inverse(prepared.surface.vertices, -prepared.surface.normals)
    clock.begin("validity at the vertices")
    verdicts = prepared.judge(solutions.reshape(-1, solutions.shape[2]))
    clock.add(verdicts.seconds)
    candidates = _candidates(prepared, verdicts, solutions.shape[:2])
    with clock.timed("continuity"):
        continuous = _continuous_links(prepared, candidates)
    links = continuous
    if prepared.setup.continuity.validity_spacing_m is not None:
        with clock.timed("validity between vertices"):
            links = _valid_links(prepared, candidates, continuous, verdicts.ends)
    with clock.timed("colors and cracks"):
        coloring = _colored(prepared, candidates, candidates.valid, links)
        prepared.deadline.check()
        cleaned = _cleaned(prepared, candidates, links, coloring)
    return Stages(prepared.surface, candidates, continuous, links, coloring, cleaned)


def _candidates(prepared: PreparedScene, verdicts: Verdicts, shape: tuple[int, ...]) -> Candidates:
    """Verdicts on all candidates as arrays of vertices and branches."""
    return Candidates(
        verdicts.configurations.reshape(*shape, -1),
        verdicts.reasons.reshape(shape),
        verdicts.determinants.reshape(shape),
        prepared.judge.reason_names,
    )


def _continuous_links(prepared: PreparedScene, candidates: Candidates) -> Links:
    """The links along which a branch moves without a jump and within the joint limits."""
    robot, setup, edges = prepared.robot, prepared.setup, prepared.surface.edges()
    limits = (robot.lower, robot.upper) if setup.constraints.collision else None
    measure = Measure(
        setup.continuity,
        prepared.workplace.conditioning.near_singular_determinant,
        prepared.kinematics.lever,
    )
    linked = np.zeros((len(edges), candidates.valid.shape[1]), dtype=bool)
    for part in _parts(len(edges), prepared.deadline):
        linked[part] = link(
            prepared.surface, edges[part], candidates, measure, limits, prepared.probe
        )
    return Links(edges, linked)


def _valid_links(
    prepared: PreparedScene, candidates: Candidates, continuous: Links, ends: Array
) -> Links:
    """The links that are valid between the vertices as well.

    Args:
        ends: (ends, n * branches, 3) of the bodies at the vertices, m.
    """
    surface, edges, linked = prepared.surface, continuous.edges, continuous.linked.copy()
    if prepared.setup.constraints.collision:
        for part in _parts(len(edges), prepared.deadline):
            linked[part] &= prepared.workplace.tip.free_along(surface, edges[part])[:, None]
    near_border = at_domain_border(edges, candidates.valid)
    spacing = prepared.setup.continuity.validity_spacing_m
    assert spacing is not None  # asked by who calls
    counts = np.maximum(np.ceil(surface.lengths(edges) / spacing).astype(int), 2)
    at_vertices = ends.reshape(-1, *candidates.valid.shape, 3)
    longest = longest_steps(prepared.judge.end_radii)
    all_rows, all_branches = np.nonzero(linked)
    for part in _parts(len(all_rows), prepared.deadline):
        rows, branches = all_rows[part], all_branches[part]
        pieces = np.where(near_border[rows, branches], counts[rows], 1)
        linked[rows, branches] = remains_valid(
            surface, edges[rows], branches, pieces, at_vertices, longest, prepared.test
        )
    return Links(edges, linked)


def _colored(
    prepared: PreparedScene, candidates: Candidates, nodes: Mask, links: Links
) -> Coloring:
    """The colors of some of the candidates, ``nodes`` (n, branches)."""
    pairs = node_links(links.edges, links.linked)
    return color_nodes(nodes, candidates.configurations, pairs, prepared.kinematics.branches)


def _cleaned(
    prepared: PreparedScene, candidates: Candidates, links: Links, coloring: Coloring
) -> Cleaned:
    """What the setup's sliver policy leaves, colored anew, and its cracks."""
    policy, report = prepared.setup.slivers, None
    edges = links.edges
    if policy is not None:
        areas = prepared.surface.vertex_areas()
        kept, report = clean(edges, links.linked, coloring, areas, policy, prepared.deadline)
        links = Links(edges, links.linked & kept[edges].all(axis=1))
        coloring = _colored(prepared, candidates, kept, links)
    return Cleaned(links, coloring, find_cracks(edges, links.linked, coloring), report)


def _parts(count: int, deadline: Deadline) -> Iterator[slice]:
    """Slices of a long list, as long as there is time."""
    for first in range(0, count, _AT_ONCE):
        deadline.check()
        yield slice(first, first + _AT_ONCE)
