"""A scene prepared: all that it names read and put in place, robot, surface, solids, tests."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.arm.conditioning import conditioning, task_determinants
from cellcolor.frontend.arm.inverse import KINEMATICS, InverseKinematics
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.last_joint import is_tool_on_last_axis, pose_at_zero
from cellcolor.frontend.arm.robot import Robot, Shapes, load_robot
from cellcolor.frontend.arm.task_space import TaskSpace
from cellcolor.frontend.arm.tool_turn import turn_at
from cellcolor.frontend.arm.turned_kinematics import TurnedKinematics
from cellcolor.frontend.arm.urdf import Urdf, load_urdf, parse_urdf
from cellcolor.frontend.contact.collision import body_ends
from cellcolor.frontend.contact.solids import Solid, mesh_solid
from cellcolor.frontend.contact.tip import Tip
from cellcolor.frontend.contact.wider import wider
from cellcolor.frontend.likely_units import check_part, check_setup, notes_on_units
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.reach.always_touching import always_touching
from cellcolor.frontend.reach.coarse import too_coarse
from cellcolor.frontend.reach.postures import Workplace
from cellcolor.frontend.reach.smooth import Measure
from cellcolor.frontend.reach.tracking import Tracker
from cellcolor.frontend.reach.validity import Judge
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Setup
from cellcolor.frontend.sizes import check_points
from cellcolor.frontend.tables import in_file

__all__ = ["PreparedScene", "family_of", "kinematics_of", "prepare", "robot_of"]

_AT_ONCE = 20_000  # points; inverse kinematics keeps some kilobytes for each


@dataclass(frozen=True)
class PreparedScene:
    """A scene, ready for questions about configurations.

    Attributes:
        workplace: the arm, and what stands around it.
        kinematics: the arm's inverse kinematics.
        surface: what has to be covered, in the world.
        judge: the tests.
        notes: what is probably not meant of robot and mesh, a sentence each.
    """

    scene: Scene
    workplace: Workplace
    kinematics: InverseKinematics
    surface: Surface
    judge: Judge
    notes: tuple[str, ...]

    def __reduce__(self) -> tuple[Any, ...]:
        # Solids of python-fcl cannot be pickled: where it is unpickled the scene is read again.
        return _prepared_on, (self.scene, self.surface)

    @property
    def setup(self) -> Setup:
        """The scene's."""
        return self.scene.setup

    @property
    def robot(self) -> Robot:
        """Arm and tool."""
        return self.workplace.robot

    def inverse(self, points: Array, directions: Array, deadline: Deadline = NEVER) -> Array:
        """All branches (n, branches, joints) in rad, or all solutions if they have no names.

        See :class:`~cellcolor.frontend.arm.inverse.InverseKinematics`.

        Raises:
            OutOfTime: the deadline came first.
        """
        parts = []
        for first in range(0, len(points), _AT_ONCE):
            deadline.check()
            rows = slice(first, first + _AT_ONCE)
            parts.append(self.kinematics.solve(points[rows], directions[rows]))
        most = max([1, *(part.shape[1] for part in parts)])
        found = np.full((len(points), most, self.robot.joints), np.nan)
        for number, part in enumerate(parts):
            first = number * _AT_ONCE
            found[first : first + len(part), : part.shape[1]] = part
        return found

    @property
    def measure(self) -> Measure:
        """By what motions along mesh edges are measured."""
        near_singular = self.workplace.conditioning.near_singular_determinant
        policy, own, slides = self.setup.continuity, self.kinematics, self.robot.slides
        if not slides.any():
            return Measure(policy, near_singular, own.lever)
        return Measure(policy, near_singular, own.lever, slides, own.reach)

    def tracker(self, deadline: Deadline = NEVER) -> Tracker:
        """Follows solutions that have no names, until a deadline (OutOfTime)."""
        limits = self.workplace.conditioning if self.setup.constraints.conditioning else None
        solve = partial(self.inverse, deadline=deadline)
        return Tracker(self.robot, solve, self.measure, limits)

    def check_named(self) -> None:
        """Refuse an arm whose solutions have no names.

        Raises:
            InputError: it has no branches.
        """
        if not self.kinematics.branches:
            raise InputError(
                None,
                "robot.kinematics",
                "the solutions of this arm have no names: its colors can be found and its minimum "
                "solved, but without names nothing is painted, planned or judged on the arm",
            )

    def without_turn(self, points: Array, directions: Array) -> Mask:
        """Where the setup gives the tool's turn by a rule that says nothing there, (n,)."""
        turn = self.setup.task.turn
        if turn is None:
            return np.zeros(len(points), dtype=bool)
        taken = self.kinematics.taken(directions)
        from_behind = np.isnan(taken[:, 0]) & ~np.isnan(directions[:, 0])
        return np.isnan(turn_at(turn, points, taken)[:, 0]) & ~from_behind

    def follow(self, points: Array, directions: Array, branches: NDArray[np.intp]) -> Array:
        """One branch for each point, (n, joints) in rad, NaN where it has no solution."""
        return self.kinematics.solve(points, directions, branches)[:, 0]

    def probe(
        self,
        points: Array,
        directions: Array,
        branches: NDArray[np.intp],
        deadline: Deadline = NEVER,
    ) -> tuple[Array, Array]:
        """Well-conditioned configurations; see :data:`~cellcolor.frontend.reach.smooth.Probe`.

        Raises:
            OutOfTime: the deadline came first.
        """
        deadline.check()
        found = self.follow(points, directions, branches)
        limits = self.workplace.conditioning if self.setup.constraints.conditioning else None
        return found, task_determinants(self.robot, found, limits)

    def test(
        self,
        points: Array,
        directions: Array,
        branches: NDArray[np.intp],
        deadline: Deadline = NEVER,
    ) -> tuple[Mask, Array]:
        """Is a branch valid there; see :data:`~cellcolor.frontend.reach.between.Test`.

        Raises:
            OutOfTime: the deadline came first.
        """
        verdicts = self.judge(self.follow(points, directions, branches), deadline)
        return np.asarray(verdicts.reasons == VALID), verdicts.tracked


def prepare(scene: Scene | str | PathLike[str], deadline: Deadline = NEVER) -> PreparedScene:
    """Read what a scene and its setup name, and put it in place.

    Args:
        scene: a scene, or the name of its file.
        deadline: when to give up.

    Raises:
        InputError: a file cannot be used, the object stands in a link that cannot move, or the
            scene asks for more vertices or points than fit; names file and field.
        OutOfTime: the deadline came first.
    """
    if not isinstance(scene, Scene):
        scene = Scene.read(scene)
    with in_file(scene.file):
        return _prepared(scene, deadline)


def _prepared(scene: Scene, deadline: Deadline) -> PreparedScene:
    setup = scene.setup
    with in_file(setup.file):
        robot = _robot(setup)
        kinematics = kinematics_of(setup, robot)
    surface = scene.covered(deadline)
    check_part(surface, scene, kinematics.reach)
    lengths = surface.lengths(surface.edges())
    with in_file(setup.file):
        check_setup(setup, surface, scene, kinematics.reach)
        _check_spacings(setup, lengths)
    obstacles, target = _solids(robot, scene, surface, deadline)
    ground = None if scene.ground is None else scene.ground.half_space
    tip = Tip(robot, setup.task.contact_radius_m, obstacles, ground)
    with in_file(setup.file):
        limits = conditioning(setup, kinematics.reach, robot)
    workplace = Workplace(robot, setup, limits, ground, tuple(obstacles), target, tip)
    judge = Judge(workplace, scene.validity_test)
    notes = robot.warnings + notes_on_units(scene, kinematics.reach)
    if setup.constraints.collision:
        notes += _notes_on_contacts(workplace, float(lengths.max()))
    return PreparedScene(scene, workplace, kinematics, surface, judge, notes)


def _prepared_on(scene: Scene, surface: Surface) -> PreparedScene:
    """The scene again, with a surface that may have been refined."""
    return replace(prepare(scene), surface=surface)


def _notes_on_contacts(place: Workplace, longest: float) -> tuple[str, ...]:
    """What of the collision shapes is probably not meant; ``longest`` edge of the mesh in m."""
    robot, found = place.robot, []
    coarse = too_coarse(robot, list(place.obstacles), longest)
    if coarse is not None:
        found.append(coarse)
    if robot.has_solids:
        if not place.tip.body.length:
            found.append(
                "a collision shape of the last link or the tool reaches as far as the tool's tip, "
                "so it touches the object wherever the tip does"
            )
        found += [
            f"{first!r} and {second!r} overlap in all of 100 configurations, so nothing will be "
            "valid: are their shapes too large (robot.mesh_collision_of), or may they touch "
            "(robot.may_touch)?"
            for first, second in always_touching(place.near_itself)
        ]
    return tuple(found)


def kinematics_of(setup: Setup, robot: Robot) -> InverseKinematics:
    """The arm's inverse kinematics for the task of its setup.

    Raises:
        InputError: the arm is not of the family that the setup names.
    """
    family, turn = family_of(setup), setup.task.turn
    kinematics = (
        family(robot, setup.robot)
        if turn is None
        else TurnedKinematics(family, robot, setup.robot, turn)
    )
    if family.prismatic and not kinematics.branches:
        message = "with a prismatic joint that moves the solutions of an arm need names (branches)"
        raise InputError(None, "robot.kinematics", message)
    return kinematics


def _check_spacings(setup: Setup, lengths: Array) -> None:
    for key in ("probe_spacing_m", "validity_spacing_m"):
        spacing = getattr(setup.continuity, key)
        if spacing is not None:
            check_points(lengths, spacing, f"continuity.{key}")


def robot_of(setup: Setup) -> Robot:
    """The arm and tool that a setup names.

    Raises:
        InputError: a URDF cannot be used, or a key of the setup does not fit it.
    """
    with in_file(setup.file):
        return _robot(setup)


def family_of(setup: Setup) -> type[InverseKinematics]:
    """The family of arms that a setup names.

    Raises:
        InputError: there is no such family, or it cannot be imported.
    """
    try:
        return KINEMATICS.find(setup.robot.kinematics)
    except InputError as error:
        raise InputError(None, "robot.kinematics", error.message) from error


def _robot(setup: Setup) -> Robot:
    files, folder = setup.robot, setup.folder
    arm = _urdf(files.arm_urdf, "arm_urdf", folder)
    tool = _urdf(files.tool_urdf, "tool_urdf", folder)
    family = family_of(setup)
    robot = load_robot(
        arm,
        files.flange_link,
        tool,
        files.tip_link,
        family.joints,
        mounted=(files.mount_position_m, files.mount_rpy_rad),
        fixed_joints=files.fixed_joints,
        shapes=Shapes(
            files.mesh_collision,
            files.mesh_collision_of,
            tuple(folder / name for name in files.package_folders),
        ),
        may_touch=files.may_touch,
        force=setup.constraints.force,
        prismatic=family.prismatic,
    )
    robot = replace(robot, task=_task(setup, family))
    _check_last_joint(robot)
    unknown = set(files.may_touch_ground) - {body.link for body in robot.bodies}
    if unknown:
        raise InputError(None, "robot.may_touch_ground", f"no solid link {min(unknown)!r}")
    return robot


def _task(setup: Setup, family: type[InverseKinematics]) -> TaskSpace:
    """What is asked of an arm of the family: no less than its joints can do, and no more."""
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
    """Refuse a joint that only turns the tool where its turn is free, and no joint is locked.

    Raises:
        InputError: the arm is redundant.
    """
    task = robot.task
    turns_tool = task.most_joints > task.joints >= robot.joints
    if turns_tool and not robot.slides[-1] and is_tool_on_last_axis(pose_at_zero(robot)):
        name = robot.joint_names[-1]
        raise InputError(
            str(robot.files[0]),
            f"joint[{name}]",
            "the arm is redundant: this joint only turns the tool about its axis, and that turn is "
            f"free; fix it ([robot.fixed_joints], as {name} = 0.0) and name a family without it",
        )


def _urdf(named: str, key: str, folder: Path) -> Urdf:
    """The URDF in a file, or the one that is there itself; then errors name the key."""
    if named.lstrip().startswith("<"):
        return parse_urdf(named, Path(key), folder)
    return load_urdf(folder / named)


def _solids(
    robot: Robot, scene: Scene, surface: Surface, deadline: Deadline
) -> tuple[list[Solid], Solid]:
    """The obstacles and the object, in the world."""
    obstacles = [obstacle.solid(scene.folder, deadline) for obstacle in scene.obstacle]
    body = surface
    if scene.solid_object is not None:
        body = scene.solid_object.surface(scene.folder, deadline).placed(scene.placement)
    target = mesh_solid(body.vertices, body.faces, deadline)
    margin = scene.setup.margins.to_object_m
    around, at_zero = wider(robot, margin), forward(robot, np.zeros((1, robot.joints)))
    blocked = target.touched_by_fixed(around, body_ends(around, at_zero), at_zero)
    if blocked is not None and scene.setup.constraints.collision:
        near = f", or nearer than {margin:g} m (margins.to_object_m)" if margin else ""
        raise InputError(None, "placement", f"the object stands in the robot's {blocked!r}{near}")
    return obstacles, target
