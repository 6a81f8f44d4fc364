"""All that a scene's files say, read and put in place: robot, surface, solids, tests."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.arm.conditioning import Conditioning, conditioning
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot, load_robot
from cellcolor.frontend.arm.ur import BRANCHES, UrGeometry, solve_inverse, ur_geometry
from cellcolor.frontend.contact.collision import body_ends
from cellcolor.frontend.contact.solids import Solid, mesh_solid, primitive_solid
from cellcolor.frontend.contact.tip import Tip
from cellcolor.frontend.reach.coarse import too_coarse
from cellcolor.frontend.reach.validity import Judge
from cellcolor.frontend.scene import MeshObstacle, Scene, Setup, load_scene, load_setup
from cellcolor.frontend.sizes import check_points
from cellcolor.frontend.target.mesh_file import load_mesh
from cellcolor.frontend.target.shapes import make_surface
from cellcolor.frontend.target.surface import Surface

__all__ = ["Stage", "prepare"]

_AT_ONCE = 20_000  # points; inverse kinematics keeps some kilobytes for each


@dataclass(frozen=True)
class Stage:
    """A scene, ready for questions about configurations.

    Attributes:
        surface: what has to be covered, in the world.
        conditioning: the thresholds for this arm.
        judge: the tests.
        tip: where the tool works.
        coarse: what could stand unnoticed between two vertices, a sentence; None if nothing.
        deadline: when to give up.
    """

    scene: Scene
    setup: Setup
    robot: Robot
    geometry: UrGeometry
    conditioning: Conditioning
    surface: Surface
    judge: Judge
    tip: Tip
    coarse: str | None
    deadline: Deadline

    def inverse(self, points: Array, directions: Array) -> Array:
        """All branches (n, 8, 6) in rad; see :func:`~cellcolor.frontend.arm.ur.solve_inverse`."""
        found = np.empty((len(points), len(BRANCHES), len(self.robot.axis)))
        locked = self.setup.robot.locked_joint_6_rad
        for first in range(0, len(points), _AT_ONCE):
            self.deadline.check()
            rows = slice(first, first + _AT_ONCE)
            found[rows] = solve_inverse(self.geometry, points[rows], directions[rows], locked)
        return found

    def follow(self, points: Array, directions: Array, branches: NDArray[np.intp]) -> Array:
        """One branch for each point, (n, 6) in rad, NaN where it has no solution."""
        locked = self.setup.robot.locked_joint_6_rad
        return solve_inverse(self.geometry, points, directions, locked, branches)[:, 0]


def prepare(scene_path: Path, deadline: Deadline = NEVER) -> Stage:
    """Read a scene, its setup and all that they name.

    Raises:
        InputError: a file cannot be used, the object stands in a link that cannot move, or the
            scene asks for more vertices or points than fit; names file and field.
        OutOfTime: the deadline came first.
    """
    scene = load_scene(scene_path)
    setup_path = scene_path.parent / scene.setup
    setup = load_setup(setup_path)
    robot = _load_robot(setup, setup_path)
    geometry = ur_geometry(robot)
    if geometry.reach > abs(geometry.a2) + abs(geometry.a3):
        raise InputError(
            str(robot.files[1]),
            f"link[{setup.robot.tip_link}]",
            f"the tool is longer than the arm: tip {geometry.reach:.3f} m from the wrist",
        )
    try:
        surface = make_surface(scene.object, scene_path.parent, deadline).placed(scene.placement)
        lengths = surface.lengths(surface.edges())
        _check_spacings(setup, setup_path, lengths)
        limits = conditioning(setup, geometry)
        solids = _solids(robot, setup, scene, surface, scene_path.parent, deadline)
    except InputError as error:
        if error.file:
            raise
        raise error.in_file(str(scene_path)) from error
    height = None if scene.ground is None else scene.ground.height_m
    tip = Tip(robot, setup.task.contact_radius_m, solids[0], height)
    judge = Judge(robot, setup, limits, scene, *solids, tip, deadline)
    coarse = None
    if setup.constraints.collision:
        coarse = too_coarse(robot, solids[0], float(lengths.max()))
    return Stage(scene, setup, robot, geometry, limits, surface, judge, tip, coarse, deadline)


def _check_spacings(setup: Setup, setup_path: Path, lengths: Array) -> None:
    try:
        for key in ("probe_spacing_m", "validity_spacing_m"):
            spacing = getattr(setup.continuity, key)
            if spacing is not None:
                check_points(lengths, spacing, f"continuity.{key}")
    except InputError as error:
        raise error.in_file(str(setup_path)) from error


def _load_robot(setup: Setup, setup_path: Path) -> Robot:
    files = setup.robot
    folder = setup_path.parent
    robot = load_robot(
        folder / files.arm_urdf, files.flange_link, folder / files.tool_urdf, files.tip_link
    )
    if not robot.lower[5] <= files.locked_joint_6_rad <= robot.upper[5]:
        raise InputError(
            str(setup_path), "robot.locked_joint_6_rad", "outside the limits of the sixth joint"
        )
    unknown = set(files.may_touch_ground) - {body.link for body in robot.bodies}
    if unknown:
        raise InputError(
            str(setup_path), "robot.may_touch_ground", f"no solid link {min(unknown)!r}"
        )
    return robot


def _solids(
    robot: Robot, setup: Setup, scene: Scene, surface: Surface, base: Path, deadline: Deadline
) -> tuple[list[Solid], Solid]:
    """The obstacles and the object, in the world."""
    obstacles = []
    for obstacle in scene.obstacle:
        if isinstance(obstacle, MeshObstacle):
            file = base / obstacle.file
            mesh = load_mesh(file, obstacle.meters_per_unit, deadline=deadline).placed(obstacle)
            obstacles.append(mesh_solid(mesh.vertices, mesh.faces, deadline))
        else:
            obstacles.append(primitive_solid(obstacle))
    body = surface
    if scene.collision_object is not None:
        body = make_surface(scene.collision_object, base, deadline).placed(scene.placement)
    target = mesh_solid(body.vertices, body.faces, deadline)
    at_zero = body_ends(robot, forward(robot, np.zeros((1, len(robot.axis)))))
    blocked = target.touched_by_fixed(robot, at_zero)
    if blocked is not None and setup.constraints.collision:
        raise InputError(None, "placement", f"the object stands in the robot's {blocked!r}")
    return obstacles, target
