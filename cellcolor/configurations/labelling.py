"""The labelled surface of joint solutions, and what was doubtful about it."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from cellcolor.arrays import Array, Index
from cellcolor.configurations.components import components_of, cut_apart, twice
from cellcolor.configurations.matching import (
    CIRCLE,
    DoubtfulPair,
    Linked,
    Nearest,
    farthest,
    stays_within,
)
from cellcolor.data.plan import JointPlan
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.memory import chunks

MAX_STEP = pi / 4
"""rad or m. A longer step between neighboring vertices is never clear."""

FAR = 10.0
"""A part that is as many times as large as the arm's reach is taken to be in millimetres."""

MOST_TURNS = 10
"""More full circles than this are taken to be an angle in degrees."""

TOLERANCE = 1e-3
"""rad or m. A configuration of a plan that is no farther from one of the vertex is that one."""

SAME = 1e-4
"""rad or m. Configurations of a vertex that are no farther apart are one, found twice."""

_MANY = 5  # vertices or pairs that are named

Conflicts = Literal["refuse", "cut"]


@dataclass(frozen=True, slots=True, eq=False)
class Labelling:
    """A labelled surface made from configurations.

    Attributes:
        surface: its colors are the components of configurations that belong together.
        joints: (n, s, joints) the configurations of each vertex in the order given, rad or m; NaN
            where there are fewer.
        periods: (joints,) after which each joint comes back.
        color_of: for each vertex the color of each of its configurations, in the order given; -1
            for one outside the joint limits.
        doubtful: the pairs of configurations of which it is not clear whether they belong together.
        edges: how many mesh edges there are.
        cut: how many matches were cut, so that no color has two configurations of a vertex.
        outside: how many configurations are outside the joint limits.
    """

    surface: LabelledSurface
    joints: Array
    periods: Array
    color_of: tuple[Index, ...]
    doubtful: tuple[DoubtfulPair, ...]
    edges: int
    cut: int
    outside: int

    @property
    def doubtful_edges(self) -> tuple[tuple[int, int], ...]:
        """The mesh edges with a doubtful pair, ascending."""
        return tuple(sorted({(pair.i, pair.j) for pair in self.doubtful}))

    @property
    def doubtful_share(self) -> float:
        """The share of mesh edges with a doubtful pair."""
        return len(self.doubtful_edges) / max(1, self.edges)

    def colors_of(self, plan: JointPlan, tolerance: float = TOLERANCE) -> tuple[int | None, ...]:
        """The colors that a plan in joint angles shows, for ``cellcolor.judge``.

        Neighbors in one color without a crack between them are one motion, so the judge counts the
        lift-offs of the plan, and finds vertices that it leaves out.

        Args:
            plan: a configuration for each vertex, in rad or m.
            tolerance: how far a joint may be from the vertex's own configuration, rad or m.

        Returns:
            For each vertex the color of the configuration that is nearest; None without contact.

        Raises:
            InputError: a configuration is none of its vertex, or outside the joint limits; names
                the vertex.
        """
        vertices, _, joints = self.joints.shape
        if plan.joints.shape != (vertices, joints):
            message = f"has shape {plan.joints.shape}, must be ({vertices}, {joints})"
            raise InputError(None, "joints", message)
        off = farthest(plan.joints[:, None], self.joints, self.periods)
        off[np.isnan(off)] = np.inf
        colors: list[int | None] = []
        for vertex, own in enumerate(off):
            if np.isnan(plan.joints[vertex, 0]):
                colors.append(None)
                continue
            nearest = int(np.argmin(own)) if len(own) else -1
            if not own.min(initial=np.inf) <= tolerance:
                place = ", ".join(f"{x:.3f}" for x in self.surface.vertices[vertex])
                message = f"is no configuration of vertex {vertex}, at ({place}) m"
                if np.isfinite(own.min(initial=np.inf)):
                    message += f": the nearest is {own.min():.3g} away"
                raise InputError(None, f"joints[{vertex}]", message)
            color = int(self.color_of[vertex][nearest])
            if color < 0:
                raise InputError(None, f"joints[{vertex}]", "is outside the joint limits")
            colors.append(color)
        return tuple(colors)

    def __str__(self) -> str:
        lines = [str(self.surface)]
        if self.outside:
            lines.append(f"{count(self.outside, 'configuration')} outside the joint limits")
        if self.cut:
            lines.append(
                f"{count(self.cut, 'match', 'matches')} cut where a color had two configurations "
                "of a vertex"
            )
        doubtful = self.doubtful_edges
        if doubtful:
            lines.append(
                f"{len(doubtful)} of {count(self.edges, 'mesh edge')} doubtful "
                f"({self.doubtful_share:.1%}): whatever is proved is proved of this labelling"
            )
            lines += [f"  {pair}" for pair in self.doubtful[:_MANY]]
            if len(self.doubtful) > _MANY:
                lines.append(f"  and {len(self.doubtful) - _MANY} more")
        return "\n".join(lines)


def from_configurations(
    vertices: ArrayLike,
    faces: ArrayLike,
    configurations: Sequence[ArrayLike],
    *,
    names: Sequence[Sequence[str]] | None = None,
    limits: ArrayLike | None = None,
    periods: ArrayLike = CIRCLE,
    linked: Linked | None = None,
    max_step: float = MAX_STEP,
    conflicts: Conflicts = "refuse",
    reach_m: float | None = None,
    name: str = "configurations",
    deadline: Deadline = NEVER,
) -> Labelling:
    """A labelled surface from the configurations that reach each vertex, without a robot.

    Configurations at the two ends of a mesh edge belong together if they are clearly the nearest to
    each other (:mod:`cellcolor.configurations.matching`). The components of what belongs together
    are the colors (section III of the paper). Where two configurations of one color are not matched
    along a mesh edge, it has a crack of that color. What is proved of the surface is proved of this
    labelling: whether the matches are what the arm does is for the caller to say.

    Args:
        vertices: (n, 3) in m.
        faces: (m, 3), counter-clockwise seen from outside.
        configurations: for each vertex an array (k, joints) in rad or m, in any order, any number;
            none where the arm does not reach. One that is there twice counts once.
        names: for each vertex the name of each of its configurations, such as "elbow up", each
            once. Only configurations of one name are matched. None: only distance tells them apart.
        limits: (2, joints), the lower and the upper end of each joint's range. Configurations
            outside are left out, and motions that leave the range are no match. None: no limits.
        periods: after which a joint comes back, for all joints or for each; ``inf`` for a joint
            that never does, such as a prismatic one.
        linked: says where it is not clear whether the arm moves continuously along mesh edge (i, j)
            from configuration a to configuration b: ``linked(i, a, j, b)``. Without it the nearest
            are matched, unless their step is too long, and listed as doubtful.
        max_step: a longer step is never clear, rad or m.
        conflicts: what becomes of a color with two configurations of a vertex: ``refuse`` it, or
            ``cut`` it where matches are weakest.
        reach_m: of the arm. A part far larger than that is refused: it will be in millimetres.
        name: of the surface.
        deadline: when to give up.

    Returns:
        The labelled surface, and what was doubtful.

    Raises:
        InputError: a configuration or an argument is not what it should be; names the vertex. Or a
            color has two configurations of a vertex.
        OutOfTime: the deadline came first.
    """
    if conflicts not in ("refuse", "cut"):
        raise InputError(None, "conflicts", f"must be 'refuse' or 'cut', is {conflicts!r}")
    if not max_step > 0:
        raise InputError(None, "max_step", f"must be above 0, is {max_step}")
    bare = LabelledSurface(name, (), vertices, faces, tuple(() for _ in configurations))  # type: ignore[arg-type]
    joints, sizes = _table(configurations)
    circles = _per_joint(periods, joints.shape[2], "periods")
    if not (circles > 0).all():
        raise InputError(None, "periods", "must be above 0")
    _check_size(bare, reach_m)
    if (far := np.argwhere(np.abs(joints) > MOST_TURNS * circles)).size:
        vertex, number, joint = far[0].tolist()
        message = f"is {joints[vertex, number, joint]:g}: are the angles in degrees?"
        raise InputError(None, f"configurations[{vertex}][{number}][{joint}]", message)
    branch = _branches(names, sizes, joints.shape[1])
    span = None if limits is None else _limits(limits, joints.shape[2])
    there = np.asarray(np.isfinite(joints).all(axis=2))
    outside = 0
    if span is not None:
        still = np.zeros_like(joints)
        inside = there & stays_within(span, joints, still, still, circles)
        outside = int((there & ~inside).sum())
        there = inside
    first = _first_of_same(joints, branch, circles)
    there &= first == np.arange(joints.shape[1])
    usable = np.where(there[:, :, None], joints, np.nan)
    edges = np.asarray(bare.mesh.edges)
    matching = Nearest(usable, there, branch, circles, span, max_step, linked)
    pairs, strength = matching.along(edges, deadline)
    kept = pairs
    color = components_of(there, edges, pairs)
    if len(repeated := twice(color)):
        if conflicts == "refuse":
            at = np.unique(repeated[:, 0]).tolist()
            raise InputError(None, f"configurations[{at[0]}]", _refusal(at))
        kept = cut_apart(there, edges, pairs, strength)
        color = components_of(there, edges, kept)
    doubtful = tuple(matching.noted)
    unclear = sorted({(pair.i, pair.j) for pair in doubtful})
    surface = LabelledSurface(
        name,
        _color_names(names, color),
        bare.vertices,
        bare.faces,
        tuple(tuple(own[own >= 0].tolist()) for own in color),
        _cracks(edges, color, kept),
        {"doubtful_edges": list(map(list, unclear))} if unclear else {},
    )
    of_each = np.take_along_axis(color, first, axis=1)
    of_vertex = tuple(own[:size] for own, size in zip(of_each, sizes, strict=True))
    cut = len(pairs) - len(kept)
    return Labelling(surface, joints, circles, of_vertex, doubtful, len(edges), cut, outside)


def _refusal(vertices: list[int]) -> str:
    named = ", ".join(map(str, vertices[:_MANY])) + (", …" if len(vertices) > _MANY else "")
    return (
        f"one color has two configurations of a vertex (vertices {named}): matches lead from one "
        "to the other around a way of mesh edges; mesh finer, or say what is linked and lower "
        "max_step, so that you are asked, or have the weakest cut (conflicts='cut')"
    )


def _table(configurations: Sequence[ArrayLike]) -> tuple[Array, list[int]]:
    """All configurations (n, s, joints), NaN where a vertex has fewer, and how many each has."""
    found: list[Array] = []
    width: int | None = None
    for vertex, given in enumerate(configurations):
        field = f"configurations[{vertex}]"
        try:
            own = np.asarray(given, dtype=float)
        except (TypeError, ValueError):
            message = "is no array (k, joints) of numbers, all of one length"
            raise InputError(None, field, message) from None
        if own.size == 0:
            own = own.reshape(0, width or 0)
        if own.ndim != 2:
            raise InputError(None, field, f"has {own.ndim} dimensions, must be (k, joints)")
        if len(own):
            if width is not None and own.shape[1] != width:
                message = f"has {own.shape[1]} joints, those before have {width}"
                raise InputError(None, field, message)
            width = own.shape[1]
            bad = np.argwhere(~np.isfinite(own))
            if len(bad):
                place = "".join(f"[{number}]" for number in bad[0])
                raise InputError(None, f"{field}{place}", "is not a finite number")
        found.append(own)
    if not width:
        raise InputError(None, "configurations", "no vertex has any: nothing can be reached")
    sizes = [len(own) for own in found]
    table = np.full((len(found), max(sizes), width), np.nan)
    for vertex, own in enumerate(found):
        if len(own):
            table[vertex, : len(own)] = own
    return table, sizes


def _per_joint(given: ArrayLike, joints: int, field: str) -> Array:
    found = np.asarray(given, dtype=float)
    if found.shape not in ((), (joints,)):
        raise InputError(None, field, f"has shape {found.shape}, there are {joints} joints")
    if np.isnan(found).any():
        raise InputError(None, field, "is not a number")
    return np.broadcast_to(found, (joints,))


def _limits(given: ArrayLike, joints: int) -> tuple[Array, Array]:
    span = np.asarray(given, dtype=float)
    if span.shape != (2, joints):
        raise InputError(None, "limits", f"has shape {span.shape}, must be (2, {joints})")
    bad = np.flatnonzero(~(span[0] < span[1]))
    if len(bad):
        lower, upper = span[:, bad[0]]
        raise InputError(None, f"limits[:, {bad[0]}]", f"go from {lower:g} to {upper:g}")
    return span[0], span[1]


def _check_size(surface: LabelledSurface, reach_m: float | None) -> None:
    if reach_m is None or not len(surface.vertices):
        return
    size = float(np.ptp(surface.vertices, axis=0).max())
    if not reach_m > 0:
        raise InputError(None, "reach_m", f"must be above 0, is {reach_m:g}")
    if size > FAR * reach_m:
        message = f"extend over {size:g} m, and the arm reaches {reach_m:g} m: are they in mm?"
        raise InputError(None, "vertices", message)


def _first_of_same(joints: Array, branch: Index, periods: Array) -> Index:
    """The first configuration (n, s) of the vertex that each one is the same as."""
    slots = joints.shape[1]
    found = np.tile(np.arange(slots), (len(joints), 1))
    for part in chunks(len(joints), slots):
        own, named = joints[part], branch[part]
        same = farthest(own[:, :, None], own[:, None], periods) <= SAME
        same &= named[:, :, None] == named[:, None]
        same |= np.eye(slots, dtype=bool)
        found[part] = same.argmax(axis=2)
    return found


def _branches(names: Sequence[Sequence[str]] | None, sizes: Sequence[int], slots: int) -> Index:
    """A number for the name of each configuration (n, s)."""
    found = np.zeros((len(sizes), slots), dtype=np.int64)
    if names is None:
        return found
    if len(names) != len(sizes):
        message = f"has {len(names)} entries for {len(sizes)} vertices"
        raise InputError(None, "names", message)
    number: dict[str, int] = {}
    for vertex, (own, size) in enumerate(zip(names, sizes, strict=True)):
        if len(own) != size:
            message = f"has {len(own)} names for {size} configurations"
            raise InputError(None, f"names[{vertex}]", message)
        if len(set(own)) != len(own):
            raise InputError(None, f"names[{vertex}]", "has a name twice")
        found[vertex, :size] = [number.setdefault(each, len(number)) for each in own]
    return found


def _color_names(names: Sequence[Sequence[str]] | None, color: Index) -> tuple[str, ...]:
    """The name of each color: that of its configurations, numbered where several have it."""
    colors = int(color.max(initial=-1)) + 1
    if names is None:
        return tuple(f"color {number}" for number in range(1, colors + 1))
    base: dict[int, str] = {}
    for own, found in zip(names, color, strict=True):
        base |= {number: each for each, number in zip(own, found.tolist(), strict=False)}
    base.pop(-1, None)
    times = Counter(base.values())
    taken = {name for name, often in times.items() if often == 1}
    made = []
    for number in range(colors):
        name, tries = base[number], itertools.count(1)
        while times[base[number]] > 1 and (name == base[number] or name in taken):
            name = f"{base[number]} {next(tries)}"
        taken.add(name)
        made.append(name)
    return tuple(made)


def _cracks(edges: Index, color: Index, matched: Index) -> tuple[Crack, ...]:
    """Where both ends of a mesh edge have a color and its configurations are not matched."""
    i, j = edges.T
    torn: dict[int, list[int]] = {}
    for part in chunks(len(edges), color.shape[1]):
        here, there = color[i[part]], color[j[part]]
        same = (here[:, :, None] == there[:, None]) & (here >= 0)[:, :, None]
        own = matched[(part.start <= matched[:, 0]) & (matched[:, 0] < part.stop)]
        same[own[:, 0] - part.start, own[:, 1], own[:, 2]] = False
        for row, a, _ in np.argwhere(same).tolist():
            torn.setdefault(part.start + row, []).append(int(here[row, a]))
    return tuple(
        Crack(int(i[row]), int(j[row]), tuple(sorted(own))) for row, own in sorted(torn.items())
    )
