"""An arm, its tool and its task, read once from a setup; no part is needed yet."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.configurations.matching import CIRCLE
from cellcolor.data.wording import looks_like_millimeters
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError, naming
from cellcolor.frontend.arm.inverse import KINEMATICS, InverseKinematics, is_tool_on_last_axis
from cellcolor.frontend.arm.kinematics import Conditioning, conditioning
from cellcolor.frontend.arm.loading import load_robot
from cellcolor.frontend.arm.newton import stacked
from cellcolor.frontend.arm.robot import Robot, TaskSpace
from cellcolor.frontend.arm.turned import TurnedKinematics, turn_at
from cellcolor.frontend.arm.urdf import Urdf, load_urdf, parse_urdf
from cellcolor.frontend.parts.placement import rotation_from_rpy
from cellcolor.frontend.reach.smooth import Measure, Tracker
from cellcolor.frontend.setup import Setup
from cellcolor.memory import chunks

_LONGEST = 100.0  # m; of an arm
_MOST_SOLUTIONS = 16  # of six revolute joints


@dataclass(frozen=True, eq=False)
class PreparedArm:
    """An arm and its task: what can be asked without any part, obstacle or ground.

    Attributes:
        conditioning: the thresholds for this arm.
        own: None, or if the branches are sheets over a surface
            (:mod:`cellcolor.frontend.reach.sheets`), the kinematics whose solutions have no names.
    """

    setup: Setup
    robot: Robot
    kinematics: InverseKinematics
    conditioning: Conditioning
    own: InverseKinematics | None = None

    @property
    def named(self) -> bool:
        """Whether the arm's family names the solutions: no sheets are needed then."""
        return self.own is None and bool(self.kinematics.branches)

    @property
    def bare(self) -> PreparedArm:
        """The arm without sheets: with the kinematics of its family."""
        return self if self.own is None else replace(self, kinematics=self.own, own=None)

    def inverse(self, points: Array, directions: Array, deadline: Deadline = NEVER) -> Array:
        """All branches (n, branches, joints) in rad, or all solutions if they have no names.

        See :class:`~cellcolor.frontend.arm.inverse.InverseKinematics`.
        """
        parts = [np.empty((0, 1, self.robot.joints))]
        for rows in chunks(len(points), self.slots):
            deadline.check()
            parts.append(self.kinematics.solve(points[rows], directions[rows]))
        return stacked(parts)

    @property
    def slots(self) -> int:
        """How many solutions a pose may have."""
        turn = self.setup.task.turn
        unnamed = _MOST_SOLUTIONS * (1 if turn is None else len(turn.degrees))
        return len(self.kinematics.branches) or unnamed

    @property
    def measure(self) -> Measure:
        """How motions along mesh edges are measured."""
        near_singular = self.conditioning.near_singular_determinant
        own, slides = self.kinematics, self.robot.slides
        periods, units = np.where(slides, np.inf, CIRCLE), np.where(slides, own.reach, 1.0)
        return Measure(self.setup.continuity, near_singular, own.lever, periods, units)

    def without_turn(self, points: Array, directions: Array) -> Mask:
        """Where the setup's rule for the tool's turn gives no turn, (n,)."""
        turn = self.setup.task.turn
        if turn is None:
            return np.zeros(len(points), dtype=bool)
        taken = self.kinematics.taken(directions)
        from_behind = np.isnan(taken[:, 0]) & ~np.isnan(directions[:, 0])
        return np.isnan(turn_at(turn, points, taken)[:, 0]) & ~from_behind

    def follow(self, points: Array, directions: Array, branches: NDArray[np.intp]) -> Array:
        """One branch for each point, (n, joints) in rad, NaN where it has no solution."""
        found = np.empty((len(points), self.robot.joints))
        for rows in chunks(len(points)):
            found[rows] = self.kinematics.solve(points[rows], directions[rows], branches[rows])[
                :, 0
            ]
        return found

    def probe(
        self,
        points: Array,
        directions: Array,
        branches: NDArray[np.intp],
        deadline: Deadline = NEVER,
    ) -> tuple[Array, Array]:
        """Well-conditioned configurations; see :data:`~cellcolor.frontend.reach.smooth.Probe`."""
        deadline.check()
        found = self.follow(points, directions, branches)
        limits = self.conditioning if self.setup.constraints.conditioning else None
        known = Tracker(self.robot, self.measure, limits).described(found)
        return found, np.where(known.good, np.abs(known.determinants), np.nan)


def prepare_arm(setup: Setup) -> PreparedArm:
    """Read the URDFs that a setup names.

    Raises:
        InputError: one cannot be used, or a key of the setup does not fit it; names the file.
    """
    with naming(setup.file):
        family = KINEMATICS.find(setup.robot.kinematics, "robot.kinematics")
        robot = _robot(setup, family)
        turn = setup.task.turn
        if turn is None:
            kinematics = family(robot, setup.robot)
        else:
            kinematics = TurnedKinematics(family, robot, setup.robot, turn)
        if family.prismatic and not kinematics.branches:
            why = "with a prismatic joint that moves the solutions of an arm need names (branches)"
            raise InputError(None, "robot.kinematics", why)
        reach = float(f"{kinematics.reach:.4g}")
        if kinematics.reach > _LONGEST:
            message = f"the arm reaches {reach} m: {looks_like_millimeters(reach)}"
            raise InputError(str(robot.files[0]), "robot", message)
        limits = conditioning(setup, kinematics.reach, robot)
    return PreparedArm(setup, robot, kinematics, limits)


def _robot(setup: Setup, family: type[InverseKinematics]) -> Robot:
    files, folder = setup.robot, setup.folder
    arm = _urdf(files.arm_urdf, "arm_urdf", folder)
    tool = _urdf(files.tool_urdf, "tool_urdf", folder)
    force = setup.constraints.force
    robot = load_robot(
        arm, tool, files, family.joints, family.prismatic, folder=folder, force=force
    )
    # The frame on the surface, z into it, is ahead of the tip link, and turned back.
    contact, task = np.eye(4), setup.task
    contact[2, 3] = task.stand_off_m
    contact[:3, :3] = rotation_from_rpy(task.tilt_rad, task.lead_rad, 0.0).T
    robot = replace(robot, task=_task(setup, family), tip=robot.tip @ contact)
    _check_last_joint(robot)
    unknown = set(files.may_touch_ground) - {body.link for body in robot.bodies}
    if unknown:
        raise InputError(None, "robot.may_touch_ground", f"no solid link {min(unknown)!r}")
    return robot


def _task(setup: Setup, family: type[InverseKinematics]) -> TaskSpace:
    """The task of an arm of the family; refused if its joints are too few or too many for it."""
    name, joints, given = setup.robot.kinematics, family.joints, setup.task.turn is not None
    task = family.given_turn if given else family.free_turn
    if task is None:
        message = (
            f"arms of the family {name!r} are redundant if the tool's turn is free: give it "
            "(task.turn), or fix the joint that makes it ([robot.fixed_joints]) and name a family "
            "without that joint: 'planar-2r' for 'planar-3r', 'scara-rrp' for 'scara'"
        )
        raise InputError(None, "robot.kinematics", message)
    if given and joints < task.joints:
        message = (
            f"with the tool's turn given the task has {task.dimensions} dimensions, and arms of "
            f"the family {name!r} have {joints} joints: leave the turn free"
        )
        raise InputError(None, "task.turn", message)
    if joints > task.most_joints:
        message = (
            f"arms of the family {name!r} are redundant: {joints} joints, at most "
            f"{task.most_joints} for a task of {task.dimensions} dimensions; those that are too "
            "many can be fixed ([robot.fixed_joints]), for a family of fewer joints"
        )
        raise InputError(None, "robot.kinematics", message)
    return task


def _check_last_joint(robot: Robot) -> None:
    """Refuse a last joint that only turns the tool, where its turn is free and it is not locked."""
    task = robot.task
    turns_tool = task.most_joints > task.joints >= robot.joints
    if turns_tool and not robot.slides[-1] and is_tool_on_last_axis(robot):
        name = robot.joint_names[-1]
        message = (
            "the arm is redundant: this joint only turns the tool about its axis, and that turn is "
            f"free; fix it ([robot.fixed_joints], as {name} = 0.0) and name a family without it"
        )
        raise robot.refused(-1, message)


def _urdf(named: str, key: str, folder: Path) -> Urdf:
    """The URDF of a file, or the URDF given as text; errors then name the key."""
    if named.lstrip().startswith("<"):
        return parse_urdf(named, Path(key), folder)
    return load_urdf(folder / named)
