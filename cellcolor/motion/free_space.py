"""Where the arm may move between strokes: inside its limits, and clear of everything."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.frontend.arm.body import Body, Shape
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.contact.engine import Contacts, Pair, always_touching, pairs_of, poses_along
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.motion.following import joint_space

_TOUCHING = 0.001  # m; so far the tip of a tool that leaves the object may be in it
_THIN = 1e-4  # m; radius of the axis of the tool's tip


class FreeSpace:
    """Tests of configurations without contact: joint limits, ground, the arm itself, solids.

    Force and conditioning are not tested. The region at the tool's tip is tested against everything
    like a body of the arm, including the object. Where ``leaving`` says that the tool is only
    leaving the object or approaching it, its tip may touch the object, but not pass through it.

    Attributes:
        space: of the joints, with their limits.
    """

    def __init__(
        self,
        prepared: PreparedScene,
        clearance: float,
        share: float = 1.0,
        *,
        leaving: bool = False,
    ) -> None:
        """Widen the arm's bodies by what they keep clear.

        Args:
            clearance: what is kept from everything besides the setup's margins, m.
            share: how much of that is kept after all. What is free for a share is free for a
                smaller one.
            leaving: see the class.
        """
        place, robot = prepared, prepared.robot
        self._place, self._on = place, prepared.setup.constraints.collision
        self.space = joint_space(prepared)
        self._leaving, margins, room = leaving, prepared.setup.margins, share * clearance
        last, tip = len(robot.bodies) - 1, place.tip.body
        if robot.bodies:
            tip = replace(tip, link=robot.bodies[last].link)
        self._tip = tip
        moving = [body for body in reversed(robot.bodies) if body.joint > 0]
        exempt = place.setup.robot.may_touch_ground
        free = [body for body in robot.bodies if body.link not in exempt]
        own_tip = [] if leaving else [tip]  # no link that may touch the ground
        self._things = {id(place.target): "the object"}
        pairs: list[Pair] = []

        def keep(thing: Shape, bodies: list[Body], margin: float) -> None:
            """Room around bodies, and a margin that the tip's region does not have."""
            pairs.extend((body, thing, room + margin) for body in bodies)
            pairs.extend((body, thing, room) for body in own_tip)

        if place.ground is not None:
            ground = place.ground
            self._things[id(ground)] = "the ground"
            keep(ground, free, margins.to_ground_m)
        for number, obstacle in enumerate(place.obstacles):
            self._things[id(obstacle)] = f"obstacle[{number}]"
            keep(obstacle, moving, margins.to_obstacles_m)
        keep(place.target, moving, margins.to_object_m)
        # Links that are never so far apart, as a tool on a short flange and the link behind it,
        # keep only the margin.
        between = pairs_of(robot, margins.between_links_m)
        between += [
            (robot.bodies[i], tip, margins.between_links_m / 2)
            for i, j in robot.tested_pairs
            if j == last and not leaving
        ]
        apart = [(one, other, margin + clearance) for one, other, margin in between]
        never = {frozenset(pair) for pair in always_touching(robot, apart)} if clearance else set()
        pairs += [
            (one, other, margin if frozenset((one.link, other.link)) in never else margin + room)
            for one, other, margin in between
        ]
        self._contacts = Contacts(pairs, robot)
        # The tool's axis between the tip and the tool's body, in a frame on the tip.
        start, end = (np.array([0.0, 0.0, -far]) for far in (_TOUCHING, tip.length))
        through = [(Body("tool tip", 1, start, end, _THIN, False), place.target, 0.0)]
        self._through = Contacts(through if leaving and tip.length > _TOUCHING else [])

    def __call__(self, configurations: Array) -> Mask:
        """Which of configurations (k, joints), taken as they are, are free, (k,)."""
        free = self.inside(configurations)
        rows = np.flatnonzero(free)
        free[rows] = self.clear(configurations[rows])
        return free

    def inside(self, configurations: Array) -> Mask:
        """Which of them are inside the joint limits, (k,)."""
        lower, upper = self.space.limits
        return np.asarray(((configurations >= lower) & (configurations <= upper)).all(axis=1))

    def clear(self, configurations: Array) -> Mask:
        """Which of them touch nothing, whatever the limits, (k,)."""
        if not self._on:
            return np.ones(len(configurations), dtype=bool)
        clear = ~self._contacts(configurations)
        if self._leaving:
            left = np.flatnonzero(clear)
            poses = forward(self._place.robot, configurations[left])
            blocked = self._place.tip.blocked(poses.tip, poses.tool_axis)
            clear[left] = ~(blocked | self._through(poses_along(poses.tip, poses.tool_axis)))
        return clear

    def touched(self, configuration: Array) -> list[str]:
        """What one configuration (joints,) touches: the names of both bodies of each contact."""
        pairs = self._contacts.touching(configuration) if self._on else []
        both = (f"{self._name(one)} and {self._name(other)}" for one, other, _ in pairs)
        return list(dict.fromkeys(both))

    def _name(self, thing: Body | Shape) -> str:
        if isinstance(thing, Shape):
            return self._things[id(thing)]
        return "the tool's tip" if thing is self._tip else thing.link
