"""Scenes: an object, where it stands, and what else is there; a file or a value in Python."""

from __future__ import annotations

from functools import partial
from os import PathLike
from typing import Annotated, Any, Self

import numpy as np
from pydantic import (
    BeforeValidator,
    Field,
    PlainValidator,
    SerializeAsAny,
    SerializerFunctionWrapHandler,
    ValidationInfo,
    field_serializer,
    field_validator,
    model_validator,
)

from cellcolor.arrays import unit
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError, naming
from cellcolor.frontend.arm.body import Shape
from cellcolor.frontend.arm.kinematics import frames_along
from cellcolor.frontend.contact.obstacle import OBSTACLES, Obstacle
from cellcolor.frontend.parts.cover import Cover
from cellcolor.frontend.parts.mesh import ArraysObject
from cellcolor.frontend.parts.placement import Placement, Tolerance, rotation_from_rpy
from cellcolor.frontend.parts.rounding import rounded
from cellcolor.frontend.parts.surface import PARTS, Part, Surface
from cellcolor.frontend.reach.validity_tests import STANDARD_REASONS, VALIDITY_TESTS, ValidityTest
from cellcolor.frontend.setup import Setup
from cellcolor.frontend.tables import Coordinate, FileTable, Table, Vector, of_kind

_UPRIGHT = (0.0, 0.0, 1.0)
_LEAST_RISE = 0.01  # of a normal of length 1; a steeper ground is a wall


class Ground(Table):
    """The half space below a height, or below a plane through that height over the origin.

    Attributes:
        height_m: of the ground over the world's origin, m.
        normal: (3,) out of the ground, of any length; it points up, if only a little.
    """

    NEWER = ("normal",)

    height_m: Coordinate
    normal: Vector = _UPRIGHT

    @field_validator("normal")
    @classmethod
    def _upward(cls, normal: Vector) -> Vector:
        """What faces sideways or down is a wall or a ceiling: an obstacle."""
        if not normal[2] > _LEAST_RISE * float(np.linalg.norm(normal)):
            raise ValueError("must point up; a wall or a ceiling is an obstacle, a half-space")
        return normal

    @property
    def half_space(self) -> Shape:
        """The ground, in the world."""
        normal = unit(np.array(self.normal))
        foot = normal[2] * self.height_m * normal  # of the perpendicular from the origin
        return Shape("half-space", rotation=frames_along(normal[None])[0], origin=foot)

    def seen_from(self, frame: Placement) -> Ground:
        """The same ground in an upright frame that stands in the world itself."""
        plane, turn = self.half_space, rotation_from_rpy(*frame.rpy_rad)
        below = float(plane.heights(np.array(frame.position_m)) / plane.rotation[2, 2])
        return Ground(height_m=-below, normal=tuple((np.array(self.normal) @ turn).tolist()))

    @property
    def tilt_rad(self) -> float:
        """The angle between the normal and the world's z axis, rad."""
        return float(np.arctan2(np.hypot(*self.normal[:2]), self.normal[2]))


def _setup(content: Any, info: ValidationInfo) -> Any:
    """A setup by its file's name is read."""
    if isinstance(content, str) and "folder" in info.data:
        return Setup.read(info.data["folder"] / content)
    return content


AnyPart = Annotated[SerializeAsAny[Part], PlainValidator(partial(of_kind, PARTS))]
AnyTest = Annotated[SerializeAsAny[ValidityTest], PlainValidator(partial(of_kind, VALIDITY_TESTS))]
AnyObstacle = Annotated[SerializeAsAny[Obstacle], PlainValidator(partial(of_kind, OBSTACLES))]


class Scene(FileTable):
    """An object, where it stands, and what else is there: ground and obstacles.

    ``object`` is what has to be covered, or those of its faces that ``cover`` chooses. It is what
    must not be hit as well, unless ``collision_object`` is given, in the same frame. A
    ``validity_test`` is made after the standard ones. With a ``tolerance``, colors hold wherever
    the object may stand by it, as far as a sample tells. A scene is a value: what varies it makes a
    new one, and holds it to the same rules as a file.
    """

    NEWER = ("validity_test", "cover", "tolerance")

    name: Annotated[str, Field(min_length=1)]
    setup: Annotated[Setup, BeforeValidator(_setup)]
    object: AnyPart
    cover: Cover | None = None
    collision_object: AnyPart | None = None
    placement: Placement
    tolerance: Tolerance | None = None
    ground: Ground | None = None
    obstacle: tuple[AnyObstacle, ...] = ()
    validity_test: tuple[AnyTest, ...] = ()

    @model_validator(mode="before")
    @classmethod
    def _no_setup(cls, content: Any) -> Any:
        """Say what is wrong with a setup that is taken for a scene, not that it lacks a name."""
        if isinstance(content, dict) and "robot" in content and "setup" not in content:
            message = "is a robot's setup, not a scene; a scene names it as its 'setup'"
            raise InputError(None, None, message)
        return content

    @field_serializer("setup", mode="wrap")
    def _setup_by_name(self, setup: Setup, whole: SerializerFunctionWrapHandler) -> Any:
        """A setup that was read from a file is named as the scene's file names it."""
        if setup.file is None:
            return whole(setup)
        within = setup.file.is_relative_to(self.folder)
        return (setup.file.relative_to(self.folder) if within else setup.file).as_posix()

    @model_validator(mode="after")
    def _tests_of_other_names(self) -> Self:
        for number, test in enumerate(self.validity_test):
            if test.name in STANDARD_REASONS:
                message = f"there is a reason {test.name!r} already"
                raise InputError(None, f"validity_test[{number}]", message)
        return self

    @property
    def solid_object(self) -> Part | None:
        """What must not be hit in the object's place, where that is not what is covered."""
        if self.collision_object is None and self.cover is not None:
            return self.object
        return self.collision_object

    def covered(self, deadline: Deadline = NEVER) -> Surface:
        """What has to be covered, in the object's own frame; of a mesh with its normals rounded.

        Raises:
            InputError: there is no such surface.
        """
        surface = self.object.surface(self.folder, deadline)
        if self.cover is not None:
            surface = self.cover.patch(surface, deadline)
        if surface.faceted:
            with naming(self.setup.file):
                surface = rounded(surface, self.setup.task.rounding_m, deadline)
        return surface

    def __str__(self) -> str:
        place = ", ".join(f"{number:g}" for number in self.placement.position_m)
        kind = getattr(self.object, "kind", type(self.object).__name__)
        parts = [f"{'part of a ' if self.cover else ''}{kind} at ({place}) m"]
        if self.ground is not None:
            tilt = np.degrees(self.ground.tilt_rad)
            tilted = f", tilted by {tilt:g} degrees" if tilt else ""
            parts.append(f"ground at {self.ground.height_m:g} m{tilted}")
        if self.obstacle:
            parts.append(count(len(self.obstacle), "obstacle"))
        if self.validity_test:
            parts.append(count(len(self.validity_test), "more validity test"))
        return f"{self.name}: {', '.join(parts)}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self}>"

    def moved(self, **placement: Any) -> Self:
        """The same scene with the object standing elsewhere.

        Args:
            **placement: ``position_m`` (3,) in m, ``rpy_rad`` (3,) in rad; what is not given stays.

        Raises:
            InputError: names the key.
        """
        return self.varied(placement=placement)

    def seen_from(self, base: Placement) -> Self:
        """The scene as the arm sees it from another place: the base is moved, the world is not.

        Part, obstacles and ground are given in the frame of the moved base. The arm stands in the
        origin of every scene, so this is how its base is moved. It stays upright.

        Args:
            base: of the arm, in the world of this scene.

        Raises:
            InputError: the base is tilted, or something is bound to the world that is not moved: a
                turn of the tool, a validity test, or a gravity that is not vertical.
        """
        task, bound = self.setup.task, "belongs to the world, so the arm's base cannot be moved"
        if any(base.rpy_rad[:2]):
            raise InputError(None, "rpy_rad", "the arm's base can be turned by its yaw only")
        if self.validity_test:
            raise InputError(None, "validity_test[0]", bound)
        with naming(self.setup.file):
            if task.turn is not None:
                raise InputError(None, "task.turn", bound)
            if any(task.gravity_m_per_s2[:2]):
                raise InputError(None, "task.gravity_m_per_s2", f"is not vertical: it {bound}")
        obstacles = tuple(each.seen_from(base) for each in self.obstacle)
        changes: dict[str, Any] = {"obstacle": obstacles} if obstacles else {}
        if self.ground is not None:
            changes["ground"] = self.ground.seen_from(base)
        return self.varied(placement=self.placement.seen_from(base), **changes)

    def with_object(self, part: Any, collision_object: Any = None) -> Self:
        """Another object in the same place.

        Args:
            part: a part, a ``trimesh.Trimesh``, or vertices (n, 3) in m and faces (m, 3).
            collision_object: what must not be hit instead, the same kinds; None: the part.

        Raises:
            InputError: it is none of these.
        """
        solid = None if collision_object is None else _as_part(collision_object)
        return self.varied(object=_as_part(part), collision_object=solid)

    def with_obstacle(self, *obstacles: Obstacle) -> Self:
        """The same scene with more obstacles in it."""
        return self.varied(obstacle=(*self.obstacle, *obstacles))

    def with_setup(self, setup: Setup | str | PathLike[str]) -> Self:
        """The same scene for another setup, a value or the name of its file."""
        return self.varied(setup=setup if isinstance(setup, Setup) else Setup.read(setup))


def _as_part(part: Any) -> Part:
    return part if isinstance(part, Part) else ArraysObject.of(part)
