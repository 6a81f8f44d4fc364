"""Where the arm may move between strokes: inside its limits, and clear of everything."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.kinematics import Poses, bytes_of_poses, forward
from cellcolor.frontend.arm.robot import Robot, wider, wider_body
from cellcolor.frontend.contact.collision import body_ends, hits_ground, hits_itself
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.always_touching import always_touching
from cellcolor.memory import chunks
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
            prepared: the scene.
            clearance: what is kept from everything besides the setup's margins, m.
            share: how much of that is kept after all. What is free for a share is free for a
                smaller one.
            leaving: see the class.
        """
        place = prepared.workplace
        self._place, self._on = place, prepared.setup.constraints.collision
        self.space = joint_space(prepared)
        self._leaving, margins = leaving, prepared.setup.margins
        tip, last = place.tip.body, _last(place.robot)
        if last is not None:
            tip = replace(tip, link=place.robot.bodies[last].link)

        def keeping(room: float, margin: float) -> Robot:
            """The robot with room around it, and a margin that the tip's region does not have."""
            around = wider(place.robot, room + margin)
            return around if leaving else _with_tip(around, wider_body(tip, room))

        room = share * clearance
        self._near_obstacles = keeping(room, margins.to_obstacles_m)
        self._near_object = keeping(room, margins.to_object_m)
        self._near_ground = keeping(room, margins.to_ground_m)
        # Two bodies that keep a distance from each other keep half of it each. Links that are never
        # so far apart, as a tool on a short flange and the link behind it, keep only the margin.
        whole = keeping(clearance / 2, margins.between_links_m / 2)
        half = keeping(room / 2, margins.between_links_m / 2)
        never = {frozenset(pair) for pair in always_touching(whole)} if clearance else set()

        def of_pairs(robot: Robot, apart: bool) -> Robot:
            bodies = robot.bodies
            return replace(
                robot,
                tested_pairs=tuple(
                    (i, j)
                    for i, j in robot.tested_pairs
                    if (frozenset((bodies[i].link, bodies[j].link)) not in never) == apart
                ),
            )

        margin = keeping(0.0, margins.between_links_m / 2)
        self._halves = (of_pairs(half, True), *([of_pairs(margin, False)] if never else []))

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
        clear = np.ones(len(configurations), dtype=bool)
        each = bytes_of_poses(self._place.robot.joints)
        for rows in chunks(len(configurations) if self._on else 0, each):
            clear[rows] = ~self._touching(configurations[rows])
        return clear

    def touched(self, configuration: Array) -> list[str]:
        """What one configuration (joints,) touches: the names of both bodies of each contact."""
        if not self._on:
            return []
        place, found = self._place, []
        poses = forward(place.robot, configuration[None])

        def name(robot: Robot, body: int) -> str:
            return "the tool's tip" if body == len(place.robot.bodies) else robot.bodies[body].link

        def alone(robot: Robot) -> list[tuple[str, Robot]]:
            return [
                (name(robot, number), replace(robot, bodies=(body,), tested_pairs=()))
                for number, body in enumerate(robot.bodies)
            ]

        if place.ground is not None:
            exempt = place.setup.robot.may_touch_ground
            for link, body in alone(self._near_ground):
                if hits_ground(body, body_ends(body, poses), place.ground, exempt, poses)[0]:
                    found.append(f"{link} and the ground")
        solids = [
            (self._near_obstacles, f"obstacle[{number}]", solid)
            for number, solid in enumerate(place.obstacles)
        ]
        for around, what, solid in (*solids, (self._near_object, "the object", place.target)):
            for link, body in alone(around):
                if solid.hits(body, body_ends(body, poses), poses)[0]:
                    found.append(f"{link} and {what}")
        found += [
            " and ".join(name(half, body) for body in pair)
            for half in self._halves
            for pair in half.tested_pairs
            if hits_itself(replace(half, tested_pairs=(pair,)), body_ends(half, poses), poses)[0]
        ]
        return list(dict.fromkeys(found))

    def _touching(self, configurations: Array) -> Mask:
        place = self._place
        poses = forward(place.robot, configurations)
        hit = np.zeros(len(configurations), dtype=bool)
        if place.ground is not None:
            exempt, around = place.setup.robot.may_touch_ground, self._near_ground
            hit |= hits_ground(around, body_ends(around, poses), place.ground, exempt, poses)
        if self._leaving:
            hit |= place.tip.blocked(poses.tip, poses.tool_axis)
        near = [(self._near_obstacles, solid) for solid in place.obstacles]
        for around, solid in (*near, (self._near_object, place.target)):
            left = np.flatnonzero(~hit)
            hit[left] = solid.hits(around, body_ends(around, poses)[:, :, left], poses.take(left))
        if self._leaving:
            left = np.flatnonzero(~hit)
            hit[left] = self._tip_through_object(poses.take(left))
        for half in self._halves:
            left = np.flatnonzero(~hit)
            hit[left] = hits_itself(half, body_ends(half, poses)[:, :, left], poses.take(left))
        return hit

    def _tip_through_object(self, poses: Poses) -> Mask:
        """Whether the tool's axis passes through the object between the tip and the tool's body."""
        length = self._place.tip.body.length
        if length <= _TOUCHING:
            return np.zeros(len(poses.tip), dtype=bool)
        end = np.array([0.0, 0.0, length - _TOUCHING])
        axis = Body("tool tip", 0, np.zeros(3), end, _THIN, False)
        ends = np.stack([poses.tip - far * poses.tool_axis for far in (_TOUCHING, length)])
        return np.asarray(self._place.target.touched_by(axis, ends))


def _with_tip(robot: Robot, tip: Body) -> Robot:
    """The robot with the region at its tip as one more body of the tool."""
    number, last = len(robot.bodies), _last(robot)
    pairs = tuple((i, number) for i, j in robot.tested_pairs if j == last)
    return replace(robot, bodies=(*robot.bodies, tip), tested_pairs=robot.tested_pairs + pairs)


def _last(robot: Robot) -> int | None:
    """The number of the last body that the chain of joints carries; None of an arm without any.

    Bodies on frames beside the chain (:attr:`Robot.followers`) may stand after the tool's.
    """
    carried = [k for k, body in enumerate(robot.bodies) if body.joint <= robot.joints]
    return max(carried, default=len(robot.bodies) - 1 if robot.bodies else None)
