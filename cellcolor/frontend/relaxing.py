"""Restrictions of an arm in a scene, and the build of the scene with one of them less.

Each :class:`Relaxation` takes one thing out of a prepared scene; :func:`relaxations_of` lists all.
Whatever was valid before is valid after it, so only candidates that failed for its reason are
tested again, on the same surface. The results are those of
:func:`~cellcolor.frontend.build.build_prepared`, but for full circles of joints without limits, and
raise the same.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from copy import deepcopy
from dataclasses import dataclass, field, replace
from itertools import compress
from math import degrees
from typing import Any

import numpy as np

from cellcolor.frontend.build import BuildResult, StageClock, colored
from cellcolor.frontend.contact.tip import Tip
from cellcolor.frontend.links import continuous_along, valid_along
from cellcolor.frontend.prepared import PreparedScene, named
from cellcolor.frontend.reach.prepared_arm import prepare_arm

Apply = Callable[[PreparedScene, float], PreparedScene]
"""A scene, and by how much the restriction is weakened, infinite if it is left out: the scene with
that."""


@dataclass(frozen=True)
class Relaxation:
    """One restriction of a scene, which can be left out or weakened.

    Attributes:
        name: for people, as in "without the ground".
        key: where scene, setup or URDF define it.
        apply: the scene without it.
        reasons: the tests that it can make a candidate fail. None if bodies change, so that
            everything has to be tested again.
        most: the largest amount worth trying, in rad, m or %; 0 where the thing is there or not.
        said_of: an amount in words, as in "ground lower by 12 mm".
        moves: whether what is weakened may block what was valid before.
        finest: the smallest share of the most to try, and the halvings between enough and too
            little.
        parts: what it can be split into.
        amount: by how much it is weakened; infinite if it is left out.
    """

    name: str
    key: str
    apply: Apply = field(compare=False, repr=False)
    reasons: frozenset[str] | None = field(compare=False)
    most: float = 0.0
    said_of: Callable[[float], str] = field(default=str, compare=False, repr=False)
    moves: bool = False
    finest: tuple[int, int] = (512, 4)
    parts: tuple[Relaxation, ...] = field(default=(), compare=False, repr=False)
    amount: float = np.inf

    def by(self, amount: float) -> Relaxation:
        """The same, weakened by an amount only."""
        return replace(self, amount=amount, reasons=None if self.moves else self.reasons)


def without(prepared: PreparedScene, what: Iterable[Relaxation]) -> PreparedScene:
    """The scene without several things."""
    # The tool comes last: the tip learns of its surroundings from the bodies of the tool.
    for one in sorted(what, key=lambda each: each.reasons is None):
        prepared = one.apply(prepared, one.amount)
    return prepared


def relaxations_of(prepared: PreparedScene) -> tuple[Relaxation, ...]:
    """All that can be taken out of a scene, one by one; all contacts between links are one."""
    robot, on = prepared.robot, prepared.setup.constraints
    found: list[Relaxation] = []
    if on.collision:
        found += [_obstacle(prepared, number) for number in range(len(prepared.obstacles))]
        found += [] if prepared.ground is None else [_GROUND]
        found.append(_test("object collision", "contact of arm and tool with the part", "object"))
        found += [_tool_body(robot.tool_links)] if robot.tool_links else []
        limited = np.isfinite(robot.lower) | np.isfinite(robot.upper)
        found += map(_joint_range, compress(robot.joint_names, limited))
        found += [_contact_of_links(prepared)] if robot.tested_pairs else []
        margins = prepared.setup.margins
        found += [_distance(key) for key in type(margins).model_fields if getattr(margins, key)]
    if on.force:
        found.append(_test("torque", "joint torques", "constraints.force"))
    if on.conditioning:
        for name in ("min_manipulability", "min_task_determinant"):
            given = getattr(prepared.setup.thresholds, name) is not None
            if getattr(prepared.arm.conditioning, name):
                found.append(_threshold(name, name if given else f"{name}_m3"))
    names = dict.fromkeys(test.name for test in prepared.scene.validity_test)
    return (*found, *(_test(name, f"test of {name}", "validity_test") for name in names))


def _test(test: str, name: str, key: str) -> Relaxation:
    """A restriction that is a whole test."""

    def applied(prepared: PreparedScene, _: float) -> PreparedScene:
        return replace(prepared, left_out=prepared.left_out | {test})

    return Relaxation(name, key, applied, frozenset({test}))


def _with_arm(prepared: PreparedScene, **changes: Any) -> PreparedScene:
    return named(replace(prepared, arm=replace(prepared.arm, **changes)))


def _with_room(prepared: PreparedScene, **changes: Any) -> PreparedScene:
    """The scene with other surroundings, of which the room at the tool's tip is told."""
    there = replace(prepared, **changes)
    tip = Tip(there.robot, there.tip.body.radius, there.obstacles, there.ground)
    return named(replace(there, tip=tip))


def _joint_range(joint: str) -> Relaxation:
    """The limits of one joint, which then turns or slides as far as it has to."""

    def applied(prepared: PreparedScene, amount: float) -> PreparedScene:
        robot = prepared.robot
        here = np.array([name == joint for name in robot.joint_names])
        lower = np.where(here, robot.lower - amount, robot.lower)
        upper = np.where(here, robot.upper + amount, robot.upper)
        return _with_arm(prepared, robot=replace(robot, lower=lower, upper=upper))

    return Relaxation(
        f"limits of {joint}",
        f"joint[{joint}].limit",
        applied,
        frozenset({"joint limits"}),
        2 * np.pi,  # a full circle on both sides
        lambda amount: f"limits of {joint} wider by {degrees(amount):.3g}° on both sides",
    )


def _contact_of_links(
    prepared: PreparedScene, pair: frozenset[str] | None = None, words: str = "links"
) -> Relaxation:
    """Two links that may not touch each other, or all that may not, with each pair as a part."""

    def links(here: PreparedScene) -> list[tuple[str, str]]:
        bodies = here.robot.bodies
        return [(bodies[i].link, bodies[j].link) for i, j in here.robot.tested_pairs]

    def applied(here: PreparedScene, _: float) -> PreparedScene:
        kept = [pair is not None and set(each) != pair for each in links(here)]
        pairs = tuple(compress(here.robot.tested_pairs, kept))
        return _with_arm(here, robot=replace(here.robot, tested_pairs=pairs))

    parts = () if pair else dict.fromkeys(links(prepared))
    return Relaxation(
        f"contact between {words}",
        "robot.may_touch",
        applied,
        frozenset({"self collision"}),
        parts=tuple(_contact_of_links(prepared, frozenset(p), " and ".join(p)) for p in parts),
    )


def _threshold(threshold: str, given: str) -> Relaxation:
    """A threshold of conditioning, as a share or in m^3 (``given``)."""

    def applied(prepared: PreparedScene, amount: float) -> PreparedScene:
        least, kept = prepared.arm.conditioning, max(1 - amount / 100, 0.0)
        lowered = replace(least, **{threshold: kept * getattr(least, threshold)})
        return _with_arm(prepared, conditioning=lowered)

    test = threshold.removeprefix("min_").replace("_", " ")
    return Relaxation(
        f"threshold of the {test}",
        f"thresholds.{given}",
        applied,
        frozenset({test}),
        100.0,
        lambda amount: f"threshold of the {test} lower by {amount:.3g} %",
    )


def _lowered(prepared: PreparedScene, amount: float) -> PreparedScene:
    ground = prepared.ground
    if ground is None or not np.isfinite(amount):
        return _with_room(prepared, ground=None)
    lower = ground.moved(np.eye(3), -amount * ground.rotation[:, 2])
    return _with_room(prepared, ground=lower)


_GROUND = Relaxation(
    "ground",
    "ground",
    _lowered,
    frozenset({"ground", "tip blocked"}),
    1.0,  # few arms reach farther down
    lambda amount: f"ground lower by {1e3 * amount:.3g} mm",
)


def _obstacle(prepared: PreparedScene, here: int) -> Relaxation:
    """One of the obstacles, gone, or moved straight away from the middle of the part's surface."""
    obstacle, body = prepared.scene.obstacle[here], prepared.obstacles[here]
    name = f"obstacle {here + 1} ({getattr(obstacle, 'kind', type(obstacle).__name__)})"

    def applied(there: PreparedScene, amount: float) -> PreparedScene:
        kept = [each for each in there.obstacles if each is not body]
        if np.isfinite(amount):
            vertices, _ = obstacle.shell(there.scene.folder)
            surface, middle = there.surface, obstacle.placed(vertices).mean(axis=0)
            away = middle - np.average(surface.vertices, axis=0, weights=surface.mesh.vertex_areas)
            step = amount * away / max(float(np.linalg.norm(away)), 1e-9)
            position = tuple((np.array(obstacle.position_m) + step).tolist())
            moved = obstacle.model_copy(update={"position_m": position})
            kept.insert(here, moved.solid(there.scene.folder))
        return _with_room(there, obstacles=tuple(kept))

    return Relaxation(
        name,
        f"obstacle[{here}]",
        applied,
        frozenset({"obstacle collision", "tip blocked"}),
        0.5,  # beyond that distance it might as well be gone
        lambda amount: f"{name} {1e3 * amount:.3g} mm farther from the part",
        moves=True,
    )


def _tool_body(links: frozenset[str]) -> Relaxation:
    """The tool's body; where the tool works is kept free as before."""

    def applied(prepared: PreparedScene, _: float) -> PreparedScene:
        robot = prepared.robot
        kept = [i for i, body in enumerate(robot.bodies) if body.link not in links]
        number = {old: new for new, old in enumerate(kept)}
        pairs = tuple(
            (number[i], number[j]) for i, j in robot.tested_pairs if {i, j} <= number.keys()
        )
        bodies = tuple(robot.bodies[i] for i in kept)
        return _with_arm(prepared, robot=replace(robot, bodies=bodies, tested_pairs=pairs))

    return Relaxation("tool's body", "robot.tool_urdf", applied, None)


def _distance(margin: str) -> Relaxation:
    """A distance that arm and tool keep (``margins`` of the setup), down to a touch."""

    def applied(prepared: PreparedScene, _: float) -> PreparedScene:
        return _with_arm(prepared, setup=prepared.setup.varied(margins={margin: 0.0}))

    name = f"distance {margin.removesuffix('_m').replace('_', ' ')}"
    return Relaxation(name, f"margins.{margin}", applied, None)


def _longer(prepared: PreparedScene, amount: float) -> PreparedScene:
    """With a larger stand-off, which is where the tip link ends."""
    longer = prepared.setup.task.stand_off_m + amount
    setup = prepared.setup.varied(task={"stand_off_m": longer})
    scene = prepared.scene.with_setup(setup)
    return _with_room(prepared, scene=scene, arm=prepare_arm(setup))


TOOL_LENGTH = Relaxation(
    "length of the tool",
    "task.stand_off_m",
    _longer,
    None,
    0.04,
    lambda amount: f"tool {1e3 * amount:.3g} mm longer",
    finest=(8, 1),  # each amount takes a whole build
    amount=0.04,
)
"""A longer tool: the tip farther along the tool's axis, the tool's body as it is.

The tip's room reaches from the body to the tip, so it grows with the tool. What was valid need not
be valid with another tool.
"""


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
    deadline, edges = clock.deadline, prepared.surface.mesh.edges
    codes = [prepared.judge.reason_names.index(reason) for reason in reasons]
    clock.begin("validity at the vertices")
    known, refused = before.verdicts, np.isin(before.reasons, codes)
    found = prepared.judge(known.configurations[refused], deadline)
    verdicts = deepcopy(known)
    verdicts.configurations[refused] = found.configurations
    verdicts.reasons[refused] = found.reasons
    verdicts.determinants[refused] = found.determinants
    verdicts.tracked[:, refused] = found.tracked
    clock.begin("continuity")
    continuous = before.continuous.copy()
    rows = np.flatnonzero((verdicts.valid[edges].all(axis=1) & ~continuous).any(axis=1))
    continuous[rows] |= continuous_along(prepared, edges[rows], verdicts, deadline)
    clock.begin("validity between vertices")
    linked = valid_along(
        prepared, verdicts, continuous, deadline, (before.all_colors.linked, known.valid)
    )
    return colored(prepared, verdicts, continuous, linked, clock)
