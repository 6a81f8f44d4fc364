"""A scene prepared: all that it names read and put in place, robot, surface, solids, tests."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.arm.conditioning import conditioning, task_determinants
from cellcolor.frontend.arm.inverse import KINEMATICS, InverseKinematics
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot, load_robot
from cellcolor.frontend.arm.urdf import Urdf, load_urdf, parse_urdf
from cellcolor.frontend.contact.collision import body_ends
from cellcolor.frontend.contact.solids import Solid, mesh_solid
from cellcolor.frontend.contact.tip import Tip
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.reach.coarse import too_coarse
from cellcolor.frontend.reach.postures import Workplace
from cellcolor.frontend.reach.validity import Judge
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Setup
from cellcolor.frontend.sizes import check_points
from cellcolor.frontend.tables import in_file

__all__ = ["PreparedScene", "family_of", "prepare", "robot_of"]

_AT_ONCE = 20_000  # points; inverse kinematics keeps some kilobytes for each


@dataclass(frozen=True)
class PreparedScene:
    """A scene, ready for questions about configurations.

    Attributes:
        workplace: the arm, and what stands around it.
        kinematics: the arm's inverse kinematics.
        surface: what has to be covered, in the world.
        judge: the tests.
        coarse: what could stand unnoticed between two vertices, a sentence; None if nothing.
        deadline: when to give up.
    """

    scene: Scene
    workplace: Workplace
    kinematics: InverseKinematics
    surface: Surface
    judge: Judge
    coarse: str | None
    deadline: Deadline

    @property
    def setup(self) -> Setup:
        """The scene's."""
        return self.scene.setup

    @property
    def robot(self) -> Robot:
        """Arm and tool."""
        return self.workplace.robot

    def inverse(self, points: Array, directions: Array) -> Array:
        """All branches (n, branches, joints) in rad.

        See :class:`~cellcolor.frontend.arm.inverse.InverseKinematics`.
        """
        found = np.empty((len(points), len(self.kinematics.branches), self.robot.joints))
        for first in range(0, len(points), _AT_ONCE):
            self.deadline.check()
            rows = slice(first, first + _AT_ONCE)
            found[rows] = self.kinematics.solve(points[rows], directions[rows])
        return found

    def follow(self, points: Array, directions: Array, branches: NDArray[np.intp]) -> Array:
        """One branch for each point, (n, joints) in rad, NaN where it has no solution."""
        return self.kinematics.solve(points, directions, branches)[:, 0]

    def probe(
        self, points: Array, directions: Array, branches: NDArray[np.intp]
    ) -> tuple[Array, Array]:
        """Well-conditioned configurations; see :data:`~cellcolor.frontend.reach.smooth.Probe`."""
        self.deadline.check()
        found = self.follow(points, directions, branches)
        limits = self.workplace.conditioning if self.setup.constraints.conditioning else None
        return found, task_determinants(self.robot, found, limits)

    def test(
        self, points: Array, directions: Array, branches: NDArray[np.intp]
    ) -> tuple[Mask, Array]:
        """Is a branch valid there; see :data:`~cellcolor.frontend.reach.between.Test`."""
        verdicts = self.judge(self.follow(points, directions, branches))
        return np.asarray(verdicts.reasons == VALID), verdicts.ends


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
        kinematics = family_of(setup)(robot, setup.robot)
    surface = scene.object.surface(scene.folder, deadline).placed(scene.placement)
    lengths = surface.lengths(surface.edges())
    with in_file(setup.file):
        _check_spacings(setup, lengths)
    obstacles, target = _solids(robot, scene, surface, deadline)
    height = None if scene.ground is None else scene.ground.height_m
    tip = Tip(robot, setup.task.contact_radius_m, obstacles, height)
    limits = conditioning(setup, kinematics.reach)
    workplace = Workplace(robot, setup, limits, height, tuple(obstacles), target, tip)
    judge = Judge(workplace, scene.validity_test, deadline)
    coarse = None
    if setup.constraints.collision:
        coarse = too_coarse(robot, obstacles, float(lengths.max()))
    return PreparedScene(scene, workplace, kinematics, surface, judge, coarse, deadline)


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
    joints = family_of(setup).joints
    robot = load_robot(arm, files.flange_link, tool, files.tip_link, joints)
    unknown = set(files.may_touch_ground) - {body.link for body in robot.bodies}
    if unknown:
        raise InputError(None, "robot.may_touch_ground", f"no solid link {min(unknown)!r}")
    return robot


def _urdf(named: str, key: str, folder: Path) -> Urdf:
    """The URDF in a file, or the one that is there itself; then errors name the key."""
    if named.lstrip().startswith("<"):
        return parse_urdf(named, Path(key))
    return load_urdf(folder / named)


def _solids(
    robot: Robot, scene: Scene, surface: Surface, deadline: Deadline
) -> tuple[list[Solid], Solid]:
    """The obstacles and the object, in the world."""
    obstacles = [obstacle.solid(scene.folder, deadline) for obstacle in scene.obstacle]
    body = surface
    if scene.collision_object is not None:
        body = scene.collision_object.surface(scene.folder, deadline).placed(scene.placement)
    target = mesh_solid(body.vertices, body.faces, deadline)
    at_zero = body_ends(robot, forward(robot, np.zeros((1, robot.joints))))
    blocked = target.touched_by_fixed(robot, at_zero)
    if blocked is not None and scene.setup.constraints.collision:
        raise InputError(None, "placement", f"the object stands in the robot's {blocked!r}")
    return obstacles, target
