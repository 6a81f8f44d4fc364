"""Scene and setup files: TOML, every key known, units in the names.

A scene says where an object stands; robot, tool, thresholds and continuity come from a setup
file that scenes share. File names are relative to the file that has them.
"""

from __future__ import annotations

import re
import tomllib
from os import PathLike
from typing import Annotated, Literal, Self, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from cellcolor.errors import InputError
from cellcolor.files.documents import read_text
from cellcolor.frontend.sizes import MOST_VERTICES

__all__ = [
    "BoxObstacle",
    "CapObject",
    "Constraints",
    "Continuity",
    "CylinderObstacle",
    "Ground",
    "MeshObject",
    "MeshObstacle",
    "Object",
    "Obstacle",
    "PipeObject",
    "Placement",
    "RectangleObject",
    "RobotFiles",
    "Scene",
    "Setup",
    "Slivers",
    "SphereObstacle",
    "Task",
    "Thresholds",
    "load_scene",
    "load_setup",
]

Positive = Annotated[FiniteFloat, Field(gt=0)]
NotNegative = Annotated[FiniteFloat, Field(ge=0)]
Vector = tuple[FiniteFloat, FiniteFloat, FiniteFloat]
# Far beyond what an arm covers, well within what distances can be computed of.
Length = Annotated[FiniteFloat, Field(ge=1e-6, le=1e6)]
Coordinate = Annotated[FiniteFloat, Field(ge=-1e6, le=1e6)]
Position = tuple[Coordinate, Coordinate, Coordinate]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class _Sampled(_Table):
    target_vertices: Annotated[int, Field(ge=7, le=MOST_VERTICES)]
    jitter: Annotated[FiniteFloat, Field(ge=0, le=0.25)] = 0.0
    seed: Annotated[int, Field(ge=0)] = 0


class CapObject(_Sampled):
    """A spherical cap about +z, the sphere's center at the object's origin."""

    kind: Literal["spherical-cap"]
    radius_m: Length
    half_angle_rad: Annotated[FiniteFloat, Field(gt=0, lt=3.1)]


class PipeObject(_Sampled):
    """Part of a pipe's outside: its axis along y through the origin, its crown at +z."""

    kind: Literal["pipe"]
    radius_m: Length
    length_m: Length
    arc_rad: Annotated[FiniteFloat, Field(gt=0, lt=6.2)]


class RectangleObject(_Sampled):
    """A flat rectangle in z = 0, centered on the origin, its outside at +z."""

    kind: Literal["rectangle"]
    size_x_m: Length
    size_y_m: Length


class MeshObject(_Table):
    """A triangle mesh from a file (STL, OBJ, PLY)."""

    kind: Literal["mesh"]
    file: str
    meters_per_unit: Positive
    max_edge_m: Positive | None = None
    repair: bool = False


class Placement(_Table):
    """Pose of the object in the world; angles extrinsic x, y, z."""

    position_m: Position
    rpy_rad: Vector = (0.0, 0.0, 0.0)


class Ground(_Table):
    """The half space below a height."""

    height_m: Coordinate


class BoxObstacle(Placement):
    """A solid box, centered on its position."""

    kind: Literal["box"]
    size_m: tuple[Length, Length, Length]


class CylinderObstacle(Placement):
    """A solid cylinder about its own z axis, centered on its position."""

    kind: Literal["cylinder"]
    radius_m: Length
    height_m: Length


class SphereObstacle(Placement):
    """A solid sphere, centered on its position."""

    kind: Literal["sphere"]
    radius_m: Length


class MeshObstacle(Placement):
    """A mesh file as a shell, its origin on the position."""

    kind: Literal["mesh"]
    file: str
    meters_per_unit: Positive


Object = CapObject | PipeObject | RectangleObject | MeshObject
Obstacle = BoxObstacle | CylinderObstacle | SphereObstacle | MeshObstacle


class Scene(_Table):
    """An object, where it stands, and what else is there: ground and obstacles.

    ``object`` is what has to be covered. It is what must not be hit as well, unless
    ``collision_object`` is given, in the same frame.
    """

    name: Annotated[str, Field(min_length=1)]
    setup: str
    object: Annotated[Object, Field(discriminator="kind")]
    collision_object: Annotated[Object, Field(discriminator="kind")] | None = None
    placement: Placement
    ground: Ground | None = None
    obstacle: tuple[Annotated[Obstacle, Field(discriminator="kind")], ...] = ()


class RobotFiles(_Table):
    """Arm and tool, and the joint that the task leaves free."""

    arm_urdf: str
    flange_link: str
    tool_urdf: str
    tip_link: str
    locked_joint_6_rad: FiniteFloat
    may_touch_ground: tuple[str, ...] = ()


class Task(_Table):
    """What the tool has to do on each point, and how much room it needs there."""

    normal_force_n: NotNegative
    contact_radius_m: Annotated[FiniteFloat, Field(ge=0.001)] = 0.005
    gravity_m_per_s2: Vector


def _one_of_each(table: _Table, *names: str) -> None:
    """Hold a table to give each threshold once: as a share of reach^3, or in m^3 as NAME_m3."""
    for name in names:
        given = [key for key in (name, f"{name}_m3") if getattr(table, key) is not None]
        if len(given) != 1:
            message = f"give either {name} or {name}_m3"
            raise PydanticCustomError("one_of_each", "{message}", {"message": message})


class Thresholds(_Table):
    """What counts as well conditioned, as shares of the cube of the arm's reach or in m^3."""

    min_manipulability: NotNegative | None = None
    min_manipulability_m3: NotNegative | None = None
    min_task_determinant: NotNegative | None = None
    min_task_determinant_m3: NotNegative | None = None

    @model_validator(mode="after")
    def _complete(self) -> Self:
        _one_of_each(self, "min_manipulability", "min_task_determinant")
        return self


class Continuity(_Table):
    """When two configurations on neighboring vertices are joined by a continuous motion."""

    base_step_rad: Positive
    step_per_length_rad_per_m: NotNegative
    near_singular_determinant: NotNegative | None = None
    near_singular_determinant_m3: NotNegative | None = None
    probe_spacing_m: Positive
    validity_spacing_m: Positive | None = None

    @model_validator(mode="after")
    def _complete(self) -> Self:
        _one_of_each(self, "near_singular_determinant")
        return self


Share = Annotated[FiniteFloat, Field(ge=0, lt=1)]


class Constraints(_Table):
    """The paper's three constraints (section III-A); each can be left out."""

    collision: bool = True
    force: bool = True
    conditioning: bool = True


class Slivers(_Table):
    """What happens to small cells; both thresholds are shares of the surface's area."""

    simplify_below_share: Share = 0.0
    uncover_below_share: Share = 0.0


class Setup(_Table):
    """Robot, task, thresholds, continuity and sliver policy, shared by scenes."""

    robot: RobotFiles
    task: Task
    thresholds: Thresholds
    continuity: Continuity
    constraints: Constraints = Constraints()
    slivers: Slivers | None = None


_Model = TypeVar("_Model", bound=BaseModel)


def load_scene(file: str | PathLike[str]) -> Scene:
    """Read a scene file.

    Raises:
        InputError: unreadable, not TOML, an unknown or missing key, a value of the wrong type
            or out of range; names the file and the key.
    """
    return _load(file, Scene)


def load_setup(file: str | PathLike[str]) -> Setup:
    """Read a setup file; raises like :func:`load_scene`."""
    return _load(file, Setup)


def _load(file: str | PathLike[str], model: type[_Model]) -> _Model:
    text = read_text(file)
    if _LONG_KEY.search(text):  # tomllib takes memory with the square of a key's parts
        raise InputError(str(file), None, "not usable TOML: a key of more than 50 parts")
    try:
        # Strict validation takes no list for a tuple, and TOML's arrays are lists.
        return model.model_validate(_tuples(tomllib.loads(text)))
    except tomllib.TOMLDecodeError as error:
        raise InputError(str(file), None, f"not TOML: {error}") from error
    except RecursionError as error:
        raise InputError(str(file), None, "not usable TOML: nested too deeply") from error
    except ValidationError as error:
        first = error.errors()[0]
        message = "unknown key" if first["type"] == "extra_forbidden" else first["msg"]
        raise InputError(str(file), _key(first["loc"]), message) from error
    except ValueError as error:
        message = "not usable TOML: a number with too many digits"
        raise InputError(str(file), None, message) from error


_LONG_KEY = re.compile(r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){50}""")


def _tuples(value: object) -> object:
    if isinstance(value, dict):
        return {key: _tuples(item) for key, item in value.items()}
    return tuple(map(_tuples, value)) if isinstance(value, list) else value


def _key(location: tuple[int | str, ...]) -> str:
    """``("object", "spherical-cap", "radius_m")`` as ``object.radius_m``: no variant tags."""
    text = ""
    for part in location:
        if isinstance(part, int):
            text += f"[{part}]"
        elif part not in _KINDS:
            text += f".{part}" if text else part
    return text


_KINDS = {
    kind
    for variant in (*get_args(Object), *get_args(Obstacle))
    for kind in get_args(variant.model_fields["kind"].annotation)
}
