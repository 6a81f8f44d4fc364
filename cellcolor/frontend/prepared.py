"""A prepared scene: arm, part, obstacles and tests, read and put in place.

The arm (`PreparedArm`), its surroundings and the part are kept separately, the part in its own
frame. So the same part can be tested in another place (:meth:`PreparedScene.at`) without reading
or building anything again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from os import PathLike
from typing import Any

import numpy as np

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError, naming
from cellcolor.frontend.arm.far_shapes import notes_on_shapes, too_large
from cellcolor.frontend.arm.inverse import InverseKinematics
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.shape import Shape
from cellcolor.frontend.contact.engine import Contacts, pairs_of
from cellcolor.frontend.contact.tip import Tip
from cellcolor.frontend.likely_units import check_part, check_setup, notes_on_units
from cellcolor.frontend.parts.inspection import note_on_crossings
from cellcolor.frontend.parts.placement import Placement
from cellcolor.frontend.parts.rounding import note_on_triangles
from cellcolor.frontend.parts.sides import note_on_shell
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.reach.always_touching import always_touching
from cellcolor.frontend.reach.prepared_arm import PreparedArm, prepare_arm
from cellcolor.frontend.reach.sheets import in_sheets
from cellcolor.frontend.reach.validity import Judge
from cellcolor.frontend.reach.validity_tests import Workplace
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Setup
from cellcolor.frontend.sizes import check_points


@dataclass(frozen=True, eq=False)
class PreparedPart:
    """A part in its own frame, wherever it stands.

    Attributes:
        surface: the surface to be covered.
        body: the shape that must not be hit.
        open: whether that has a border, so that nothing but its faces says which side is outside.
    """

    surface: Surface
    body: Shape
    open: bool


@dataclass(frozen=True, eq=False)
class PreparedScene:
    """A scene, ready for questions about configurations.

    Attributes:
        workplace: the arm and its surroundings.
        part: in its own frame.
        surface: the surface to be covered, in the world.
        judge: the tests.
        notes: likely mistakes in robot and mesh, one sentence each.
    """

    scene: Scene
    workplace: Workplace
    part: PreparedPart
    surface: Surface
    judge: Judge
    notes: tuple[str, ...]

    def __reduce__(self) -> tuple[Any, ...]:
        # Models of Pinocchio's cannot be pickled: where it is unpickled the scene is read again.
        return _prepared_on, (self.scene, self.surface)

    @property
    def setup(self) -> Setup:
        """The scene's."""
        return self.scene.setup

    @property
    def arm(self) -> PreparedArm:
        """The arm and its task, without its surroundings."""
        return self.workplace.arm

    @property
    def robot(self) -> Robot:
        """Arm and tool."""
        return self.arm.robot

    @property
    def kinematics(self) -> InverseKinematics:
        """The arm's inverse kinematics."""
        return self.arm.kinematics

    def at(self, placement: Placement) -> PreparedScene:
        """The same scene with the part standing elsewhere; only the part is moved.

        Raises:
            InputError: the part stands in a link that cannot move, or much too far away.
        """
        return self._standing(self.scene.varied(placement=placement), self.workplace)

    def amid(self, scene: Scene) -> PreparedScene:
        """The same arm and part in a scene that differs in placement, obstacles and ground only.

        Raises:
            InputError: an obstacle cannot be used, or the part stands in a link that cannot move,
                or much too far away.
        """
        return self._standing(scene, _around(scene, self.arm, self.part, NEVER))

    def _standing(self, scene: Scene, around: Workplace) -> PreparedScene:
        surface, workplace = _in_place(scene, self.part, around)
        check_part(surface, scene, self.kinematics.reach, self.robot.base_frame(None)[:3, 3])
        judge = Judge(workplace, scene.validity_test)
        return named(PreparedScene(scene, workplace, self.part, surface, judge, self.notes))

    def displaced(self) -> list[PreparedScene]:
        """The scene without its tolerance, with the part wherever its sample puts it.

        The surface to be covered goes with the part, refined or not.

        Raises:
            InputError: the part stands in a link that cannot move.
        """
        tolerance = self.scene.tolerance
        if tolerance is None:
            return []
        own = self.part.surface.placed(self.scene.placement).vertices
        center = (own.min(axis=0) + own.max(axis=0)) / 2
        exact = replace(self, scene=self.scene.varied(tolerance=None))
        found = []
        for placement in tolerance.displaced(self.scene.placement, center):
            there = exact.at(placement)
            surface = self.surface.taken_along(self.scene.placement, placement)
            found.append(replace(there, surface=surface))
        return found


def prepare(scene: Scene | str | PathLike[str], deadline: Deadline = NEVER) -> PreparedScene:
    """Read what a scene and its setup name, and put it in place.

    Args:
        scene: a scene, or the name of its file.

    Raises:
        InputError: a file cannot be used, the object stands in a link that cannot move, or the
            scene asks for more vertices or points than fit; names file and field.
    """
    if not isinstance(scene, Scene):
        scene = Scene.read(scene)
    with naming(scene.file):
        return _prepared(scene, deadline)


def _prepared(scene: Scene, deadline: Deadline) -> PreparedScene:
    setup = scene.setup
    arm = prepare_arm(setup)
    covered = scene.covered(deadline)
    surface = covered.placed(scene.placement)
    check_part(surface, scene, arm.kinematics.reach, arm.robot.base_frame(None)[:3, 3])
    lengths = surface.lengths(surface.edges())
    with naming(setup.file):
        check_setup(setup, surface, scene, arm.kinematics.reach)
        _check_spacings(setup, lengths)
    shape = covered
    if scene.solid_object is not None:
        shape = scene.solid_object.surface(scene.folder, deadline)
    body = Shape("mesh", vertices=shape.vertices, faces=shape.faces)
    part = PreparedPart(covered, body, bool(shape.mesh.border.any()))
    _, workplace = _in_place(scene, part, _around(scene, arm, part, deadline))
    judge = Judge(workplace, scene.validity_test)
    notes = arm.robot.warnings + notes_on_shapes(arm.robot)
    notes += notes_on_units(scene, arm.kinematics.reach)
    if covered.faceted:  # a shape is made without
        notes += note_on_crossings(covered.mesh) + note_on_shell(covered)
        notes += note_on_triangles(surface, setup.task.rounding_m)
    if setup.constraints.collision:
        notes += _notes_on_contacts(workplace, float(lengths.max()))
    return named(PreparedScene(scene, workplace, part, surface, judge, notes), deadline)


def named(prepared: PreparedScene, deadline: Deadline = NEVER) -> PreparedScene:
    """The scene with an arm whose solutions have names: sheets over its surface, if need be.

    Raises:
        InputError: the arm is cuspidal on the part, or there are too many sheets.
    """
    if prepared.arm.named:
        return prepared
    arm = in_sheets(prepared.arm, prepared.surface, prepared.judge, deadline)
    return replace(prepared, workplace=replace(prepared.workplace, arm=arm))


def _around(scene: Scene, arm: PreparedArm, part: PreparedPart, deadline: Deadline) -> Workplace:
    """An arm with obstacles and ground; the part is in its own frame yet."""
    obstacles = [obstacle.solid(scene.folder, deadline) for obstacle in scene.obstacle]
    ground = None if scene.ground is None else scene.ground.half_space
    tip = Tip(arm.robot, scene.setup.task.contact_radius_m, obstacles, ground)
    return Workplace(arm, ground, tuple(obstacles), part.body, tip)


def _in_place(scene: Scene, part: PreparedPart, around: Workplace) -> tuple[Surface, Workplace]:
    """A part where its scene has it: what has to be covered, and the workplace with its body."""
    surface = part.surface.placed(scene.placement)
    body, robot = scene.placement.standing(part.body), around.robot
    margin = scene.setup.margins.to_object_m
    fixed = [each for each in robot.bodies if each.joint == 0 and scene.setup.constraints.collision]
    for each in fixed:
        if Contacts([(each, body, margin)], robot)(np.zeros((1, robot.joints)))[0]:
            why = too_large(robot, each)
            if why is not None:
                raise InputError(str(robot.files[0]), f"link[{each.link}].collision", why)
            wider = f", or nearer than {margin:g} m (margins.to_object_m)" if margin else ""
            message = f"the object stands in the robot's {each.link!r}{wider}"
            raise InputError(None, "placement", message)
    return surface, replace(around, target=body)


def _prepared_on(scene: Scene, surface: Surface) -> PreparedScene:
    """The scene again, with a surface that may have been refined."""
    return replace(prepare(scene), surface=surface)


def _notes_on_contacts(place: Workplace, longest: float) -> tuple[str, ...]:
    """Likely mistakes in the collision shapes; ``longest`` edge of the mesh in m."""
    robot, found = place.robot, []
    margin = place.setup.margins.between_links_m
    coarse = _too_coarse(robot, place.obstacles, longest)
    if coarse is not None:
        found.append(coarse)
    if robot.has_solids:
        if not place.tip.body.length:
            found.append(
                "a collision shape of the last link or the tool reaches as far as the tool's tip, "
                "so it touches the object wherever the tip does"
            )
        found += [
            f"{first!r} and {second!r} overlap in all of 100 configurations, so none will be "
            "valid: are their shapes too large (robot.mesh_collision_of), or may they touch "
            "(robot.may_touch)?"
            for first, second in always_touching(robot, pairs_of(robot, margin))
        ]
    return tuple(found)


def _too_coarse(robot: Robot, obstacles: tuple[Shape, ...], longest: float) -> str | None:
    """A warning where the longest mesh edge (m) is longer than the tool or an obstacle is wide.

    A vertex says nothing of what is far from it.
    """
    widths = [
        (2 * body.radius, f"the body of {body.link!r}")
        for body in robot.bodies
        if body.joint == robot.joints
    ]
    widths += [(solid.width, f"obstacle[{k}]") for k, solid in enumerate(obstacles)]
    width, name = min(widths, default=(longest, ""))
    if longest <= width:
        return None
    return (
        f"the object's edges are up to {longest:.3g} m long and {name} is {width:.3g} m wide: "
        "between vertices something can stand unnoticed (max_edge_m, target_vertices)"
    )


def _check_spacings(setup: Setup, lengths: Array) -> None:
    for key in ("probe_spacing_m", "validity_spacing_m"):
        spacing = getattr(setup.continuity, key)
        if spacing is not None:
            check_points(lengths, spacing, f"continuity.{key}")
