"""Ways around obstacles, found by sampling: RRT-Connect of OMPL.

Kuffner and LaValle, RRT-Connect: an efficient approach to single-query path planning, 2000.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.joint_space import JointSpace

_BRANCH = 1.0  # rad, the longest new branch of a tree


def sampled_way(
    start: Array,
    end: Array,
    limits: JointSpace,
    free: Callable[[Array], Mask],
    step: float,
    rounds: int,
    seed: int,
    deadline: Deadline,
) -> Array | None:
    """Corners (c, joints) of a way, joined by straight joint moves; None if none was found.

    Args:
        start, end: (joints,) both free.
        limits: the joints and their limits.
        free: which of configurations (k, joints) are free, (k,).
        step: the most that a joint moves between two tested configurations of a way, rad or
            units of a slide.
        rounds: of the planner; a number, so that the result does not depend on the time.
        seed: the same way for the same seed.
        deadline: when to give up.
    """
    from ompl import base, geometric, util

    util.setLogLevel(util.LogLevel.LOG_NONE)
    util.RNG.setSeed(seed + 1)  # 0 would be one that the clock chooses
    joints = len(start)

    def array(state: Any) -> Array:
        return np.array([state[joint] for joint in range(joints)])

    class Straight(base.MotionValidator):  # type: ignore[misc]
        """Many configurations of a straight way are tested at once."""

        def checkMotion(self, first: Any, second: Any, *_: Any) -> bool:
            one, other = array(first), array(second)
            count = max(1, int(np.ceil(limits.largest(other - one) / step)))
            way = one + np.linspace(0.0, 1.0, count + 1)[1:, None] * (other - one)
            return bool(free(way).all())

    space = base.RealVectorStateSpace(joints)
    bounds = base.RealVectorBounds(joints)
    for joint in range(joints):
        # Farther than half a circle beyond both ends no way round anything leads.
        least, most = sorted((start[joint], end[joint]))
        more = np.pi * float(limits.units[joint])
        bounds.setLow(joint, max(float(limits.lower[joint]), float(least) - more))
        bounds.setHigh(joint, min(float(limits.upper[joint]), float(most) + more))
    space.setBounds(bounds)
    information = base.SpaceInformation(space)
    information.setStateValidityChecker(lambda state: bool(free(array(state)[None])[0]))
    information.setMotionValidator(Straight(information))
    information.setup()
    problem = base.ProblemDefinition(information)
    ends = []
    for configuration in (start, end):
        state = space.allocState()
        for joint in range(joints):
            state[joint] = float(configuration[joint])
        ends.append(state)
    problem.setStartAndGoalStates(*ends)
    planner = geometric.RRTConnect(information)
    planner.setRange(_BRANCH)
    planner.setProblemDefinition(problem)
    planner.setup()
    left = iter(range(rounds))
    planner.solve(
        base.PlannerTerminationCondition(lambda: next(left, None) is None or deadline.over)
    )
    if not problem.hasExactSolution():
        return None
    path = problem.getSolutionPath()
    geometric.PathSimplifier(information).simplifyMax(path)
    return np.array([array(path.getState(number)) for number in range(path.getStateCount())])
