"""From valid configurations to colors and cracks (``docs/frontend.md``, "Continuity", "Turns").

A node is a valid configuration: a vertex and a branch. Nodes on the ends of a mesh edge are linked
where their branch leads from one to the other (:mod:`cellcolor.frontend.links`). Colors are the
connected components of linked nodes; a mesh edge whose ends have a color in common but are not
linked in it is a crack of that color.

The colors of a surface keep the joint limits by themselves. Their nodes are vertices with a
position of each joint inside its limits. Of a component that comes back to a vertex turned by a
full circle, a window of one circle gives each vertex one position, and where neighbors disagree
there is a crack. If the joint has two full circles, once around fits in wherever a segment begins:
the color stays whole.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import islice, product

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.configurations.components import components_of
from cellcolor.data.surface import Crack
from cellcolor.frontend.arm.robot import Robot
from cellcolor.mesh.triangle_mesh import grouped

_CIRCLE = 2 * np.pi
_ROUNDING = 1e-9  # rad; an angle on its limit is inside
_MARGIN = 0.02  # rad; between two vertices a joint may go a little beyond both
_ENOUGH = 2 * _CIRCLE - _ROUNDING  # rad; positions over one circle fit in, wherever they begin
_MOST = 64  # combinations of the joints' parts of one color


@dataclass(frozen=True, eq=False)
class Coloring:
    """Colors of all nodes.

    Attributes:
        names: of the colors: the branch, with a number where it has several components.
        branch: of each color.
        node_color: (n, branches) the color of each valid configuration, -1 for others.
        linked: (edges, branches) along which mesh edges each branch leads.
        cracks: the mesh edges whose ends share a color that is not continuous along the edge.
    """

    names: tuple[str, ...]
    branch: tuple[int, ...]
    node_color: Index
    linked: Mask
    cracks: tuple[Crack, ...]


def color_nodes(nodes: Mask, edges: Index, linked: Mask, branch_names: tuple[str, ...]) -> Coloring:
    """Connected components of linked nodes.

    Numbering is deterministic: colors follow their branches; within a branch the components
    with more vertices come first, and of equal ones that with the smallest vertex.

    Args:
        nodes: (n, branches) which of them there are.
        edges: (k, 2) all mesh edges.
        linked: (k, branches) along which of them a branch leads; False where an end is no node.
    """
    component = regions(nodes, edges, linked)
    of_branch = np.zeros(component.max(initial=-1) + 1, dtype=np.int64)
    of_branch[component[nodes]] = np.nonzero(nodes)[1]
    order = np.argsort(of_branch, kind="stable")
    node_color = np.full(nodes.shape, -1, dtype=np.int64)
    node_color[nodes] = np.argsort(order)[component[nodes]]
    names = []
    sizes = np.bincount(of_branch, minlength=len(branch_names)).tolist()
    for name, size in zip(branch_names, sizes, strict=True):
        names += [name] if size == 1 else [f"{name} {k}" for k in range(1, size + 1)]
    branch = tuple(of_branch[order].tolist())
    return Coloring(tuple(names), branch, node_color, linked, _cracks(edges, linked, node_color))


def regions(nodes: Mask, edges: Index, linked: Mask) -> Index:
    """The number of each node's component, (n, branches), largest first; -1 for no node."""
    row, branch = np.nonzero(linked)
    return components_of(nodes, edges, np.column_stack([row, branch, branch]))


def _cracks(edges: Index, linked: Mask, node_color: Index) -> tuple[Crack, ...]:
    start, end = node_color[edges[:, 0]], node_color[edges[:, 1]]
    torn = (start == end) & (start >= 0) & ~linked
    return tuple(
        Crack(int(edges[row, 0]), int(edges[row, 1]), tuple(sorted(start[row, torn[row]].tolist())))
        for row in np.flatnonzero(torn.any(axis=1))
    )


@dataclass(frozen=True, eq=False)
class LimitColors:
    """The colors of a surface, each of which is inside the joint limits by itself.

    Attributes:
        color: of each the color modulo full circles, as numbered in the coloring.
        cracks: the mesh edges along which a color of both ends is not continuous.
        members: (n,) of each color, which vertices have it.
        positions: (n, joints) of each color that is a part of one: unwound angles, rad, NaN at
            vertices that do not have it.
        winding: names of the colors modulo full circles that come back turned.
    """

    names: tuple[str, ...]
    color: tuple[int, ...]
    cracks: tuple[Crack, ...]
    members: tuple[Mask, ...]
    positions: Mapping[int, Array]
    winding: tuple[str, ...]


def limit_colors(
    robot: Robot,
    coloring: Coloring,
    configurations: Array,
    edges: Index,
) -> LimitColors:
    """Divide the colors that do not fit into the joint limits as a whole.

    Args:
        configurations: (n, branches, joints) in rad.
        edges: (k, 2) all mesh edges.
    """
    found: list[tuple[str, int, Mask, Array | None]] = []  # name, color, members, positions
    winding: list[str] = []
    torn: dict[tuple[int, int], list[int]] = {}
    number: dict[int, int] = {}  # of each color that stays whole
    for color, (name, branch) in enumerate(zip(coloring.names, coloring.branch, strict=True)):
        mask = coloring.node_color[:, branch] == color
        links = edges[coloring.linked[:, branch] & mask[edges].all(axis=1)]
        angles = configurations[:, branch]
        divided = _divided(robot, mask, links, angles)
        if divided is None:
            number[color] = len(found)
            found.append((name, color, mask, None))
            continue
        joints, parts, winds = divided
        if winds:
            winding.append(name)
        inside = edges[mask[edges].all(axis=1)]
        for part in parts:
            here, words = len(found), _in_words(robot, joints, part.angles[part.mask])
            found.append((f"{name} ({words})", color, part.mask, part.angles))
            whole = {tuple(link) for link in links[part.agrees(links)].tolist()}
            for edge in map(tuple, inside[part.mask[inside].all(axis=1)].tolist()):
                if edge not in whole:
                    torn.setdefault(edge, []).append(here)
    for crack in coloring.cracks:
        kept = [number[color] for color in crack.colors if color in number]
        if kept:
            torn.setdefault((crack.i, crack.j), [])[:0] = kept
    names = [name for name, _, _, _ in found]
    repeated = {name for name, times in Counter(names).items() if times > 1}
    names = [
        f"{name} {names[: place + 1].count(name)}" if name in repeated else name
        for place, name in enumerate(names)
    ]
    all_cracks = tuple(Crack(i, j, tuple(sorted(own))) for (i, j), own in sorted(torn.items()))
    return LimitColors(
        tuple(names),
        tuple(color for _, color, _, _ in found),
        all_cracks,
        tuple(mask for _, _, mask, _ in found),
        {here: own for here, (_, _, _, own) in enumerate(found) if own is not None},
        tuple(winding),
    )


@dataclass(frozen=True, eq=False)
class _Part:
    """A part of a color with one position of the joints at each vertex.

    Attributes:
        mask: (n,) its vertices.
        angles: (n, joints) the positions there, rad; NaN elsewhere.
    """

    mask: Mask
    angles: Array

    def agrees(self, links: Index) -> Mask:
        """Along which links (l, 2) the positions go on, (l,)."""
        way = np.abs(self.angles[links[:, 0]] - self.angles[links[:, 1]])
        return np.asarray((way <= np.pi).all(axis=1))  # NaN is no way


def _divided(
    robot: Robot, mask: Mask, links: Index, angles: Array
) -> tuple[list[int], list[_Part], bool] | None:
    """The joints that divide a color, its parts, and whether it winds; None if it stays whole.

    Args:
        mask: (n,) the vertices of the color.
        links: (l, 2) between them.
        angles: (n, joints) in rad.
    """
    chosen: list[list[Array]] = []
    joints, winds = [], False
    for joint in range(robot.joints):
        limits, own = (robot.lower[joint], robot.upper[joint]), angles[:, joint]
        if robot.slides[joint] or not np.isfinite(limits).all():
            chosen.append([own])
            continue
        choices, winding = _choices(limits, mask, links, own)
        chosen.append(choices)
        winds |= winding
        if len(choices) > 1 or winding:
            joints.append(joint)
    if not joints:
        return None
    parts: list[_Part] = []
    for choice in islice(product(*chosen), _MOST):
        unwound = np.column_stack(choice)
        whole = _Part(~np.isnan(unwound).any(axis=1) & mask, unwound)
        group = grouped(len(mask), links[whole.agrees(links)])
        for component in np.unique(group[whole.mask]):
            inside = whole.mask & (group == component)
            parts.append(_Part(inside, np.where(inside[:, None], unwound, np.nan)))
    parts.sort(key=lambda part: -int(part.mask.sum()))
    kept: list[_Part] = []
    for part in parts:
        agreed = links[part.agrees(links)]
        # A segment in a part that is all in another part, with its links, is one of that as well.
        wider = (each for each in kept if not (part.mask & ~each.mask).any())
        if not any(each.agrees(agreed).all() for each in wider):
            kept.append(part)
    return joints, kept, winds


def _choices(
    limits: tuple[float, float], mask: Mask, links: Index, angles: Array
) -> tuple[list[Array], bool]:
    """What positions a joint may have: arrays (n,), NaN where there is none; and whether it winds.

    A single one, if there is one for the whole color.
    """
    lower, upper = limits
    least, most = angles[mask].min(), angles[mask].max()
    gains = np.rint((angles[links[:, 1]] - angles[links[:, 0]]) / _CIRCLE).astype(np.int64)
    if not gains.any() and lower - _ROUNDING <= least and most <= upper + _ROUNDING:
        return [np.where(mask, angles, np.nan)], False
    turns = np.arange(
        int(np.ceil((lower - most - _ROUNDING) / _CIRCLE)),
        int(np.floor((upper - least + _ROUNDING) / _CIRCLE)) + 1,
    )
    turned = angles[:, None] + _CIRCLE * turns
    exact: Mask = mask[:, None] & (turned >= lower - _ROUNDING) & (turned <= upper + _ROUNDING)
    roomy: Mask = exact & (turned >= lower + _MARGIN) & (turned <= upper - _MARGIN)
    for single, nodes in _components(exact, links, gains):
        everywhere = bool(np.any(nodes, axis=1)[mask].all())
        if everywhere and single:
            return [_positions(nodes, turned)], False
    found: list[Array] = []
    winds = False
    nowhere = ~np.any(roomy, axis=1)
    for single, nodes in _components(roomy | (exact & nowhere[:, None]), links, gains):
        if single:
            found.append(_positions(nodes, turned))
            continue
        low, high = turned[nodes].min(), turned[nodes].max()
        everywhere = bool(np.any(nodes, axis=1)[mask].all())
        if upper - lower >= _ENOUGH and everywhere:
            return [np.where(mask, angles, np.nan)], False
        winds = True
        for middle in (low + np.pi, (low + high) / 2, high - np.pi):
            off = np.where(nodes, np.abs(turned - middle), np.inf)
            nearest = np.zeros_like(nodes)
            nearest[np.arange(len(nodes)), off.argmin(axis=1)] = True
            found.append(_positions(nodes & nearest, turned))
    return found, winds


def _components(nodes: Mask, links: Index, gains: Index) -> list[tuple[bool, Mask]]:
    """The components of nodes (n, turns), and whether each has one node at most at a vertex.

    A link (l, 2) leads from a node to the one that has ``gains`` (l,) turns less.
    """
    width = nodes.shape[1]
    pairs = []
    for column in range(width):
        other = column - gains
        (rows,) = np.nonzero((other >= 0) & (other < width))
        one, two = links[rows, 0], links[rows, 1]
        both = nodes[one, column] & nodes[two, other[rows]]
        ends = one * width + column, two * width + other[rows]
        pairs.append(np.column_stack(ends)[both])
    group = grouped(nodes.size, np.concatenate(pairs)).reshape(nodes.shape)
    found = []
    for component in np.unique(group[nodes]):
        own: Mask = nodes & (group == component)
        found.append((bool(own.sum(axis=1).max() == 1), own))
    return found


def _positions(nodes: Mask, turned: Array) -> Array:
    """The position (n,) of each vertex that has a node, NaN elsewhere."""
    found = np.where(nodes, turned, 0.0).sum(axis=1)
    return np.where(nodes.any(axis=1), found, np.nan)


def _in_words(robot: Robot, joints: list[int], angles: Array) -> str:
    """Where the joints are that a color is divided by."""
    low, high = np.degrees(angles.min(axis=0)), np.degrees(angles.max(axis=0))
    return ", ".join(
        f"{robot.joint_names[joint]} from {low[joint]:.0f}° to {high[joint]:.0f}°"
        for joint in joints
    )
