"""Setups: robot, tool, thresholds and continuity, which scenes share."""

from __future__ import annotations

from typing import Annotated, Any, Self

from pydantic import (
    Field,
    FiniteFloat,
    SerializerFunctionWrapHandler,
    model_serializer,
    model_validator,
)
from pydantic_core import PydanticCustomError

from cellcolor.frontend.tables import FileTable, NotNegative, Positive, Table, Vector

__all__ = [
    "Constraints",
    "Continuity",
    "Motion",
    "RobotFiles",
    "Setup",
    "Slivers",
    "Task",
    "Thresholds",
]


class RobotFiles(Table):
    """Arm and tool, the family of the arm, and the joint that the task leaves free.

    ``kinematics`` names a family of arms, see :mod:`cellcolor.frontend.arm.inverse`; the locked
    joint is asked for by the family ``ur``. ``arm_urdf`` and ``tool_urdf`` are names of files, or
    URDF texts themselves, which begin with ``<``.
    """

    arm_urdf: str
    flange_link: str
    tool_urdf: str
    tip_link: str
    kinematics: str = "ur"
    locked_joint_6_rad: FiniteFloat | None = None
    may_touch_ground: tuple[str, ...] = ()

    @model_serializer(mode="wrap")
    def _family_if_another(self, whole: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Surfaces of before there were other families stay the same to the byte."""
        content: dict[str, Any] = whole(self)
        if self.kinematics == "ur":
            del content["kinematics"]
        return content


class Task(Table):
    """What the tool has to do on each point, and how much room it needs there."""

    normal_force_n: NotNegative
    contact_radius_m: Annotated[FiniteFloat, Field(ge=0.001)] = 0.005
    gravity_m_per_s2: Vector


def _one_of_each(table: Table, *names: str) -> None:
    """Hold a table to give each threshold once: as a share of reach^3, or in m^3 as NAME_m3."""
    for name in names:
        given = [key for key in (name, f"{name}_m3") if getattr(table, key) is not None]
        if len(given) != 1:
            message = f"give either {name} or {name}_m3"
            raise PydanticCustomError("one_of_each", "{message}", {"message": message})


class Thresholds(Table):
    """What counts as well conditioned, as shares of the cube of the arm's reach or in m^3."""

    min_manipulability: NotNegative | None = None
    min_manipulability_m3: NotNegative | None = None
    min_task_determinant: NotNegative | None = None
    min_task_determinant_m3: NotNegative | None = None

    @model_validator(mode="after")
    def _complete(self) -> Self:
        _one_of_each(self, "min_manipulability", "min_task_determinant")
        return self


class Continuity(Table):
    """When two configurations on neighboring vertices are joined by a continuous motion.

    With ``border_length_m`` longer mesh edges are bisected where colors end or have a crack.
    """

    base_step_rad: Positive
    step_per_length_rad_per_m: NotNegative
    near_singular_determinant: NotNegative | None = None
    near_singular_determinant_m3: NotNegative | None = None
    probe_spacing_m: Positive
    validity_spacing_m: Positive | None = None
    border_length_m: Positive | None = None

    @model_validator(mode="after")
    def _complete(self) -> Self:
        _one_of_each(self, "near_singular_determinant")
        return self

    @model_serializer(mode="wrap")
    def _border_length_if_any(self, whole: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Surfaces of before borders could be refined stay the same to the byte."""
        content: dict[str, Any] = whole(self)
        if self.border_length_m is None:
            del content["border_length_m"]
        return content


Share = Annotated[FiniteFloat, Field(ge=0, lt=1)]


class Constraints(Table):
    """The paper's three constraints (section III-A); each can be left out."""

    collision: bool = True
    force: bool = True
    conditioning: bool = True


class Slivers(Table):
    """What happens to small cells; both thresholds are shares of the surface's area."""

    simplify_below_share: Share = 0.0
    uncover_below_share: Share = 0.0


class Motion(Table):
    """How the tool covers a segment, and how the arm moves; only planning a motion asks for it.

    ``tool_radius_m`` is that of the tool's footprint, ``spacing_m`` the distance between
    neighboring passes. The tool retracts by ``retract_m`` along the normal; between segments the
    arm keeps ``clearance_m`` from everything. A URDF has velocities, which
    ``joint_velocities_rad_per_s`` may lower, but no accelerations. Lists of joints go from base to
    tool; ``home_rad`` is where the arm begins and ends, nowhere in particular without it.
    """

    tool_radius_m: Positive = 0.015
    spacing_m: Positive = 0.01
    speed_m_per_s: Positive = 0.05
    joint_velocities_rad_per_s: tuple[Positive, ...] | None = None
    joint_accelerations_rad_per_s2: tuple[Positive, ...]
    retract_m: Positive = 0.05
    clearance_m: NotNegative = 0.005
    home_rad: tuple[FiniteFloat, ...] | None = None


class Setup(FileTable):
    """Robot, task, thresholds, continuity, sliver policy and motion, shared by scenes."""

    robot: RobotFiles
    task: Task
    thresholds: Thresholds
    continuity: Continuity
    constraints: Constraints = Constraints()
    slivers: Slivers | None = None
    motion: Motion | None = None
