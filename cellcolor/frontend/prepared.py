"""A prepared scene: arm, part, obstacles and tests, read and put in place.

The part is kept in its own frame as well. So the same part can be tested in another place
(:meth:`PreparedScene.at`) without reading or building anything again.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from os import PathLike
from typing import Any

import numpy as np

from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError, naming
from cellcolor.frontend.arm.body import Shape
from cellcolor.frontend.arm.notes import notes_on_shapes, too_large
from cellcolor.frontend.contact.engine import Contacts, always_touching, pairs_of, width
from cellcolor.frontend.contact.tip import Tip
from cellcolor.frontend.likely_units import check_part, check_setup, notes_on_units
from cellcolor.frontend.parts.cover import note_on_shell
from cellcolor.frontend.parts.inspection import note_on_crossings
from cellcolor.frontend.parts.rounding import note_on_triangles
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.reach.prepared_arm import PreparedArm, prepare_arm
from cellcolor.frontend.reach.sheets import in_sheets
from cellcolor.frontend.reach.validity_tests import Judge, Workplace
from cellcolor.frontend.scene import Scene

_MOST_POINTS = 20_000_000  # on all mesh edges; each is tested for up to eight branches
_MOST_ON_AN_EDGE = 500_000  # they are tested together


@dataclass(frozen=True, eq=False)
class PreparedScene(Workplace):
    """A scene, ready for questions about configurations.

    Attributes:
        own_surface, own_body: the surface to be covered and the shape that must not be hit, in the
            part's own frame.
        surface: the surface to be covered, in the world.
        notes: likely mistakes in robot and mesh, one sentence each.
    """

    scene: Scene
    own_surface: Surface
    own_body: Shape
    surface: Surface
    notes: tuple[str, ...] = ()
    left_out: frozenset[str] = frozenset()

    def __reduce__(self) -> tuple[Any, ...]:
        # Models of Pinocchio's cannot be pickled: where it is unpickled the scene is read again.
        return _prepared_on, (self.scene, self.surface)

    @property
    def judge(self) -> Judge:
        """The tests."""
        return Judge(self, self.scene.validity_test, self.left_out)

    def asking(self, tests: Collection[str]) -> PreparedScene:
        """The same scene, of whose tests only these are made, by their names."""
        others = frozenset(self.judge.reason_names) - frozenset(tests)
        return replace(self, left_out=self.left_out | others)

    def at(self, scene: Scene) -> PreparedScene:
        """The same arm and part in a scene that differs in placement, obstacles and ground only.

        Raises:
            InputError: an obstacle cannot be used, or the part stands in a link that cannot move,
                or much too far away.
        """
        same = (scene.obstacle, scene.ground) == (self.scene.obstacle, self.scene.ground)
        around = {} if same else _surroundings(scene, self.arm, NEVER)
        return named(_in_place(replace(self, scene=scene, **around)))

    def displaced(self) -> list[PreparedScene]:
        """The scene without its tolerance, with the part wherever its sample puts it.

        The surface to be covered goes with the part, refined or not.

        Raises:
            InputError: the part stands in a link that cannot move.
        """
        tolerance = self.scene.tolerance
        if tolerance is None:
            return []
        own = self.own_surface.placed(self.scene.placement).vertices
        center = (own.min(axis=0) + own.max(axis=0)) / 2
        found = []
        for placement in tolerance.displaced(self.scene.placement, center):
            there = self.at(self.scene.varied(tolerance=None, placement=placement))
            surface = self.surface.taken_along(self.scene.placement, placement)
            found.append(replace(there, surface=surface))
        return found


def prepare(scene: Scene | str | PathLike[str], deadline: Deadline = NEVER) -> PreparedScene:
    """Read what a scene and its setup name, and put it in place.

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
    surface, reach = covered.placed(scene.placement), arm.kinematics.reach
    check_part(surface, scene, reach, arm.robot.base_frame(None)[:3, 3])
    lengths = surface.lengths(surface.mesh.edges)
    with naming(setup.file):
        check_setup(setup, surface, scene, reach)
        for key in ("probe_spacing_m", "validity_spacing_m"):
            counts = np.ceil(lengths / (getattr(setup.continuity, key) or np.inf))
            total = float(counts.sum())
            if total > _MOST_POINTS or counts.max() > _MOST_ON_AN_EDGE:
                message = (
                    f"puts {total:.2g} points on the mesh's edges, {counts.max():.2g} on the "
                    f"longest; at most {_MOST_POINTS:,} and {_MOST_ON_AN_EDGE:,} are tested"
                )
                raise InputError(None, f"continuity.{key}", message)
    shape = covered
    if scene.solid_object is not None:
        shape = scene.solid_object.surface(scene.folder, deadline)
    body = Shape("mesh", vertices=shape.vertices, faces=shape.faces)
    around = _surroundings(scene, arm, deadline)
    prepared = PreparedScene(
        arm=arm,
        target=body,
        scene=scene,
        own_surface=covered,
        own_body=body,
        surface=surface,
        **around,
    )
    prepared = _in_place(prepared)
    notes = arm.robot.warnings + notes_on_shapes(arm.robot) + notes_on_units(scene, reach)
    if covered.faceted:  # a shape is made without
        notes += note_on_crossings(covered.mesh) + note_on_shell(covered)
        notes += note_on_triangles(surface, setup.task.rounding_m)
    if setup.constraints.collision:
        notes += tuple(_notes_on_contacts(prepared, float(lengths.max())))
    return named(replace(prepared, notes=notes), deadline)


def named(prepared: PreparedScene, deadline: Deadline = NEVER) -> PreparedScene:
    """The scene with an arm whose solutions have names: sheets over its surface, if need be.

    Raises:
        InputError: the arm is cuspidal on the part, or there are too many sheets.
    """
    if prepared.arm.named:
        return prepared
    arm = in_sheets(prepared.arm, prepared.surface, prepared.judge, deadline)
    return replace(prepared, arm=arm)


def _surroundings(scene: Scene, arm: PreparedArm, deadline: Deadline) -> dict[str, Any]:
    """What stands around an arm: obstacles, ground, and the room that they leave the tip."""
    obstacles = tuple(obstacle.solid(scene.folder, deadline) for obstacle in scene.obstacle)
    ground = None if scene.ground is None else scene.ground.half_space
    tip = Tip(arm.robot, scene.setup.task.contact_radius_m, obstacles, ground)
    return {"obstacles": obstacles, "ground": ground, "tip": tip}


def _in_place(prepared: PreparedScene) -> PreparedScene:
    """The part where its scene has it."""
    scene, robot = prepared.scene, prepared.robot
    surface = prepared.own_surface.placed(scene.placement)
    check_part(surface, scene, prepared.arm.kinematics.reach, robot.base_frame(None)[:3, 3])
    body = scene.placement.standing(prepared.own_body)
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
    return replace(prepared, surface=surface, target=body)


def _prepared_on(scene: Scene, surface: Surface) -> PreparedScene:
    """The scene again, with a surface that may have been refined."""
    return replace(prepare(scene), surface=surface)


def _notes_on_contacts(place: PreparedScene, longest: float) -> Iterator[str]:
    """Likely mistakes in the collision shapes; ``longest`` edge of the mesh in m."""
    robot = place.robot
    widths = [
        (2 * body.radius, f"the body of {body.link!r}")
        for body in robot.bodies
        if body.joint == robot.joints
    ]
    widths += [(width(solid), f"obstacle[{k}]") for k, solid in enumerate(place.obstacles)]
    wide, name = min(widths, default=(longest, ""))
    if longest > wide:  # a vertex says nothing of what is far from it
        yield (
            f"the object's edges are up to {longest:.3g} m long and {name} is {wide:.3g} m wide: "
            "between vertices something can stand unnoticed (max_edge_m, target_vertices)"
        )
    if not robot.has_solids:
        return
    if not place.tip.body.length:
        yield (
            "a collision shape of the last link or the tool reaches as far as the tool's tip, so "
            "it touches the object wherever the tip does"
        )
    pairs = pairs_of(robot, place.setup.margins.between_links_m)
    for first, second in always_touching(robot, pairs):
        yield (
            f"{first!r} and {second!r} overlap in all of 100 configurations, so none will be "
            "valid: are their shapes too large (robot.mesh_collision_of), or may they touch "
            "(robot.may_touch)?"
        )
