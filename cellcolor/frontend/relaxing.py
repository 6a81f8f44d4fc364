"""Restrictions of an arm in a scene, and the scene with one limit, obstacle or test less.

Each kind of :class:`Relaxation` takes one thing out of a prepared scene. Whatever was valid before
is valid after it, so only candidates that failed for its reason are tested again
(:mod:`~cellcolor.frontend.judging_again`). :func:`relaxations_of` lists all of a scene.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from itertools import compress
from math import degrees
from typing import ClassVar, Self

import numpy as np

from cellcolor.frontend.arm.shape import Shape
from cellcolor.frontend.contact.tip import Tip
from cellcolor.frontend.prepared import PreparedScene, named
from cellcolor.frontend.reach.prepared_arm import prepare_arm


@dataclass(frozen=True)
class Relaxation(ABC):
    """One restriction of a scene, which can be left out or weakened.

    Attributes:
        amount: by how much it is weakened, in units; infinite if it is left out.
        reasons: the tests that it can make a candidate fail. None if bodies change, so that
            everything has to be tested again.
        unit: of amounts, ``None`` where the thing is there or not.
        most: the largest amount worth trying.
        finest: the smallest share of the most to try, and the halvings between enough and too
            little.
    """

    amount: float = field(default=np.inf, kw_only=True)
    reasons: ClassVar[frozenset[str] | None]
    unit: ClassVar[str | None] = None
    most: ClassVar[float] = 0.0
    finest: ClassVar[tuple[int, int]] = (512, 4)

    @property
    @abstractmethod
    def name(self) -> str:
        """For people, as in "without the ground"."""

    @property
    @abstractmethod
    def key(self) -> str:
        """Where scene, setup or URDF define it."""

    @abstractmethod
    def applied(self, prepared: PreparedScene) -> PreparedScene:
        """The scene without it."""

    def by(self, amount: float) -> Self:
        """The same, relaxed by an amount only."""
        return self if self.unit is None else replace(self, amount=amount)

    def said_of(self, amount: float) -> str:
        """An amount in words, as in "limits of joint_4 wider by 12°"."""
        return f"{self.name}: {amount:.3g} {self.unit}"

    def parts(self, prepared: PreparedScene) -> tuple[Relaxation, ...]:  # noqa: ARG002
        """Its parts, if it can be split."""
        return ()


class _WholeTest(Relaxation):
    """A restriction that is a test, left out."""

    reasons: ClassVar[frozenset[str]]

    def applied(self, prepared: PreparedScene) -> PreparedScene:
        return replace(prepared, left_out=prepared.left_out | self.reasons)


@dataclass(frozen=True)
class JointRange(Relaxation):
    """The limits of one joint, which then turns or slides as far as it has to."""

    joint: str
    reasons = frozenset({"joint limits"})
    unit = "rad"
    most = 2 * np.pi  # a full circle on both sides

    @property
    def name(self) -> str:
        return f"limits of {self.joint}"

    @property
    def key(self) -> str:
        return f"joint[{self.joint}].limit"

    def said_of(self, amount: float) -> str:
        return f"{self.name} wider by {degrees(amount):.3g}° on both sides"

    def applied(self, prepared: PreparedScene) -> PreparedScene:
        robot = prepared.robot
        here = np.array([name == self.joint for name in robot.joint_names])
        lower = np.where(here, robot.lower - self.amount, robot.lower)
        upper = np.where(here, robot.upper + self.amount, robot.upper)
        arm = replace(prepared.arm, robot=replace(robot, lower=lower, upper=upper))
        return named(replace(prepared, arm=arm))


@dataclass(frozen=True)
class LinkContact(Relaxation):
    """Two links that may not touch each other, or all that may not."""

    pair: tuple[str, str] | None
    reasons = frozenset({"self collision"})
    key = "robot.may_touch"

    @property
    def name(self) -> str:
        return "contact between " + (" and ".join(self.pair) if self.pair else "links")

    def applied(self, prepared: PreparedScene) -> PreparedScene:
        robot = prepared.robot
        pairs = tuple(
            (i, j)
            for i, j in robot.tested_pairs
            if self.pair and {robot.bodies[i].link, robot.bodies[j].link} != set(self.pair)
        )
        arm = replace(prepared.arm, robot=replace(robot, tested_pairs=pairs))
        return named(replace(prepared, arm=arm))

    def parts(self, prepared: PreparedScene) -> tuple[LinkContact, ...]:
        """Each pair of links of a scene."""
        robot = prepared.robot
        links = [(robot.bodies[i].link, robot.bodies[j].link) for i, j in robot.tested_pairs]
        return tuple(LinkContact(pair) for pair in dict.fromkeys(links))


@dataclass(frozen=True)
class Torques(_WholeTest):
    """The efforts of the joints: the constraint ``force``."""

    reasons = frozenset({"torque"})
    name = "joint torques"
    key = "constraints.force"


_OF_THRESHOLD = {
    "min_manipulability": "manipulability",
    "min_task_determinant": "task determinant",
}


@dataclass(frozen=True)
class Threshold(Relaxation):
    """A threshold of conditioning, as a share or in m^3 (``given``)."""

    threshold: str
    given: str
    unit = "%"
    most = 100.0

    @property
    def reasons(self) -> frozenset[str]:  # type: ignore[override]
        """The test that it belongs to."""
        return frozenset({_OF_THRESHOLD[self.threshold]})

    @property
    def name(self) -> str:
        return f"threshold of the {_OF_THRESHOLD[self.threshold]}"

    @property
    def key(self) -> str:
        return f"thresholds.{self.given}"

    def said_of(self, amount: float) -> str:
        return f"{self.name} lower by {amount:.3g} %"

    def applied(self, prepared: PreparedScene) -> PreparedScene:
        least = prepared.arm.conditioning
        kept = max(1 - self.amount / 100, 0.0)
        lowered = {self.threshold: kept * getattr(least, self.threshold)}
        arm = replace(prepared.arm, conditioning=replace(least, **lowered))
        return named(replace(prepared, arm=arm))


@dataclass(frozen=True)
class GroundPlane(Relaxation):
    """The ground."""

    reasons = frozenset({"ground", "tip blocked"})
    unit = "m"
    most = 1.0  # few arms reach farther down
    name = "ground"
    key = "ground"

    def said_of(self, amount: float) -> str:
        return f"ground lower by {1e3 * amount:.3g} mm"

    def applied(self, prepared: PreparedScene) -> PreparedScene:
        ground = prepared.ground
        if ground is not None:
            lower = replace(ground, offset_m=ground.offset_m - self.amount)
            ground = lower if np.isfinite(self.amount) else None
        return _amid(replace(prepared, ground=ground))


@dataclass(frozen=True)
class ObstacleBody(Relaxation):
    """One of the obstacles, numbered from 1; gone, or farther from the part."""

    number: int
    kind: str
    unit = "m"
    most = 0.5  # beyond that distance it might as well be gone

    @property
    def reasons(self) -> frozenset[str] | None:  # type: ignore[override]
        """A moved obstacle may block configurations that were valid before."""
        return frozenset({"obstacle collision", "tip blocked"}) if self.amount == np.inf else None

    @property
    def name(self) -> str:
        """With the kind that the scene's file gives it."""
        return f"obstacle {self.number} ({self.kind})"

    @property
    def key(self) -> str:
        return f"obstacle[{self.number - 1}]"

    def said_of(self, amount: float) -> str:
        return f"{self.name} {1e3 * amount:.3g} mm farther from the part"

    def applied(self, prepared: PreparedScene) -> PreparedScene:
        """Without it, or with it moved straight away from the middle of the part's surface."""
        scene, here = prepared.scene, self.number - 1
        moved: tuple[Shape, ...] = ()
        if self.amount < np.inf:
            obstacle = scene.obstacle[here]
            vertices, _ = obstacle.shell(scene.folder)
            middle = obstacle.placed(vertices).mean(axis=0)
            away = middle - np.average(
                prepared.surface.vertices, axis=0, weights=prepared.surface.vertex_areas()
            )
            step = self.amount * away / max(float(np.linalg.norm(away)), 1e-9)
            position = tuple((np.array(obstacle.position_m) + step).tolist())
            there = obstacle.model_copy(update={"position_m": position})
            moved = (there.solid(scene.folder),)
        left = (*prepared.obstacles[:here], *moved, *prepared.obstacles[here + 1 :])
        return _amid(replace(prepared, obstacles=left))


@dataclass(frozen=True)
class PartBody(_WholeTest):
    """The part itself, as a body that links and tool must not hit."""

    reasons = frozenset({"object collision"})
    name = "contact of arm and tool with the part"
    key = "object"


@dataclass(frozen=True)
class ToolBody(Relaxation):
    """The tool's body; where the tool works is kept free as before."""

    links: frozenset[str]
    reasons = None
    name = "tool's body"
    key = "robot.tool_urdf"

    def applied(self, prepared: PreparedScene) -> PreparedScene:
        robot = prepared.robot
        kept = [i for i, body in enumerate(robot.bodies) if body.link not in self.links]
        number = {old: new for new, old in enumerate(kept)}
        slim = replace(
            robot,
            bodies=tuple(robot.bodies[i] for i in kept),
            tested_pairs=tuple(
                (number[i], number[j]) for i, j in robot.tested_pairs if {i, j} <= number.keys()
            ),
        )
        arm = replace(prepared.arm, robot=slim)
        return named(replace(prepared, arm=arm))


@dataclass(frozen=True)
class ToolLength(Relaxation):
    """A longer tool: the tip farther along the tool's axis, the tool's body as it is.

    The tip's room reaches from the body to the tip, so it grows with the tool. What was valid need
    not be valid with another tool.
    """

    amount: float = field(default=0.04, kw_only=True)
    reasons = None
    unit = "m"
    finest = (8, 1)  # each amount takes a whole build
    name = "length of the tool"
    key = "task.stand_off_m"
    most = 0.04

    def said_of(self, amount: float) -> str:
        return f"tool {1e3 * amount:.3g} mm longer"

    def applied(self, prepared: PreparedScene) -> PreparedScene:
        """With a larger stand-off, which is where the tip link ends."""
        longer = prepared.setup.task.stand_off_m + self.amount
        setup = prepared.setup.varied(task={"stand_off_m": longer})
        scene = prepared.scene.with_setup(setup)
        return _amid(replace(prepared, scene=scene, arm=prepare_arm(setup)))


@dataclass(frozen=True)
class Distance(Relaxation):
    """A distance that arm and tool keep (``margins`` of the setup), down to a touch."""

    margin: str
    reasons = None

    @property
    def name(self) -> str:
        return f"distance {self.margin.removesuffix('_m').replace('_', ' ')}"

    @property
    def key(self) -> str:
        return f"margins.{self.margin}"

    def applied(self, prepared: PreparedScene) -> PreparedScene:
        setup = prepared.arm.setup.varied(margins={self.margin: 0.0})
        arm = replace(prepared.arm, setup=setup)
        return named(replace(prepared, arm=arm))


@dataclass(frozen=True)
class AddedTest(_WholeTest):
    """A test of validity that the scene adds."""

    test: str
    key = "validity_test"

    @property
    def reasons(self) -> frozenset[str]:  # type: ignore[override]
        """Its own."""
        return frozenset({self.test})

    @property
    def name(self) -> str:
        return f"test of {self.test}"


def _amid(prepared: PreparedScene) -> PreparedScene:
    """The scene, the room at the tool's tip told what stands around."""
    radius = prepared.tip.body.radius
    tip = Tip(prepared.robot, radius, prepared.obstacles, prepared.ground)
    return named(replace(prepared, tip=tip))


def relaxations_of(prepared: PreparedScene) -> tuple[Relaxation, ...]:
    """All that can be taken out of a scene, one by one; all contacts between links are one."""
    robot, on = prepared.robot, prepared.setup.constraints
    found: list[Relaxation] = []
    if on.collision:
        found += [
            ObstacleBody(number, str(getattr(one, "kind", type(one).__name__)))
            for number, one in enumerate(prepared.scene.obstacle, 1)
        ]
        found += [] if prepared.ground is None else [GroundPlane()]
        found.append(PartBody())
        found += [ToolBody(robot.tool_links)] if robot.tool_links else []
        limited = np.isfinite(robot.lower) | np.isfinite(robot.upper)
        found += map(JointRange, compress(robot.joint_names, limited))
        found += [LinkContact(None)] if robot.tested_pairs else []
        margins = prepared.setup.margins
        found += [Distance(key) for key in type(margins).model_fields if getattr(margins, key)]
    if on.force:
        found.append(Torques())
    if on.conditioning:
        least = prepared.setup.thresholds
        found += [
            Threshold(name, name if getattr(least, name) is not None else f"{name}_m3")
            for name in _OF_THRESHOLD
            if getattr(prepared.arm.conditioning, name)
        ]
    names = dict.fromkeys(test.name for test in prepared.scene.validity_test)
    return (*found, *(AddedTest(name) for name in names))


def without(prepared: PreparedScene, what: Iterable[Relaxation]) -> PreparedScene:
    """The scene without several things; obstacles are numbered as the scene has them."""
    # From the last obstacle to the first, so that the numbers of those left stay. The tool comes
    # last: the tip learns of its surroundings from the bodies of the tool.
    for one in sorted(what, key=lambda each: (each.reasons is None, -getattr(each, "number", 0))):
        prepared = one.applied(prepared)
    return prepared
