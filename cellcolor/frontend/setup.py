"""Setups: robot, tool, thresholds and continuity, which scenes share."""

from __future__ import annotations

import itertools
import math
import re
from typing import Annotated, Literal, Self

from pydantic import Field, FiniteFloat, model_validator

from cellcolor.frontend.tables import (
    IN_RADIANS,
    Angles,
    FileTable,
    JointAngle,
    NotNegative,
    Position,
    Positive,
    Table,
    Vector,
)

MeshCollision = Literal["hull", "exact"]
"""What stands for a link's mesh: its convex hull, or nothing but itself."""


class RobotFiles(Table):
    """Arm and tool, the family of the arm, and the joint that the task leaves free.

    ``kinematics`` names a family of arms, see :mod:`cellcolor.frontend.arm.inverse`; the locked
    joint is asked for by the families ``ur`` and ``eaik``. ``arm_urdf`` and ``tool_urdf`` are names
    of files, or URDF texts themselves, which begin with ``<``.

    ``mount_position_m`` and ``mount_rpy_rad`` are the pose of the tool's root link in the frame of
    the flange link. ``fixed_joints`` has positions of joints that do not move, in rad, or in m of
    prismatic ones. Pairs of links that ``may_touch`` are not tested against each other, as
    neighbors are not. What collides in the place of a link's mesh is its convex ``hull``, the mesh
    itself (``exact``), for single links by ``mesh_collision_of``.
    ``package://`` is looked for in ``package_folders`` first.
    """

    NEWER = (
        "kinematics",
        "may_touch",
        "mount_position_m",
        "mount_rpy_rad",
        "fixed_joints",
        "package_folders",
        "mesh_collision",
        "mesh_collision_of",
    )

    arm_urdf: str
    flange_link: str
    tool_urdf: str
    tip_link: str
    kinematics: str = "ur"
    locked_joint_6_rad: JointAngle | None = None
    may_touch_ground: tuple[str, ...] = ()
    may_touch: tuple[tuple[str, str], ...] = ()
    mount_position_m: Vector = (0.0, 0.0, 0.0)
    mount_rpy_rad: Angles = (0.0, 0.0, 0.0)
    fixed_joints: dict[str, FiniteFloat] = Field(default_factory=dict)
    package_folders: tuple[str, ...] = ()
    mesh_collision: MeshCollision = "hull"
    mesh_collision_of: dict[str, MeshCollision] = Field(default_factory=dict)


_SAME_TURN_DEG = 1e-6  # turns nearer than this, modulo a full circle, are one
_MOST_TURNS = 360
_Degrees = Annotated[FiniteFloat, Field(ge=-360, le=360)]


class Turn(Table):
    """The turn of the tool about its axis, where it is given (``docs/frontend.md``, "The task").

    The tool's x axis points ``along`` a vector of the world or ``towards_m`` a point of it, as far
    as it can across the surface's normal. With ``turns`` equally spaced ones or a list
    ``turns_deg`` the arm has a choice; they are counted from there about the tool's z axis.
    """

    NEWER = ("along", "towards_m", "turns", "turns_deg")  # as in a file: what is given

    along: Vector | None = None
    towards_m: Position | None = None
    turns: Annotated[int, Field(ge=1, le=_MOST_TURNS)] | None = None
    turns_deg: Annotated[tuple[_Degrees, ...], Field(min_length=1)] | None = None

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if (self.along is None) == (self.towards_m is None):
            raise ValueError("give either along or towards_m")
        if self.along is not None and not 1e-150 < math.hypot(*self.along) < 1e150:
            raise ValueError("along must have a direction: it is zero")
        if self.turns is not None and self.turns_deg is not None:
            raise ValueError("give either turns or turns_deg")
        around = sorted(degrees % 360.0 for degrees in self.degrees)
        gaps = [after - before for before, after in itertools.pairwise(around)]
        if len(around) > 1 and min(*gaps, 360.0 - around[-1] + around[0]) < _SAME_TURN_DEG:
            raise ValueError("turns_deg has a turn twice, modulo 360 degrees")
        if len(around) > _MOST_TURNS:
            raise ValueError(f"turns_deg has {len(around)} turns, at most {_MOST_TURNS} fit")
        return self

    @property
    def is_choice(self) -> bool:
        """Whether a set of turns is given, even a set of one: then colors are named after them."""
        return self.turns is not None or self.turns_deg is not None

    @property
    def degrees(self) -> tuple[float, ...]:
        """The turns that the arm may choose from."""
        if self.turns_deg is not None:
            return self.turns_deg
        count = self.turns or 1
        return tuple(360.0 * number / count for number in range(count))


_Tilt = Annotated[FiniteFloat, Field(ge=-1.2, le=1.2), IN_RADIANS]  # further, the tool lies flat


class Task(Table):
    """What the tool has to do on each point, and how much room it needs there.

    Without ``turn`` the tool's turn about its axis is free. The normals of a mesh are rounded over
    ``edge_radius_m``; without it that is ``contact_radius_m``, the tool's footprint.

    The tip link may stay off the surface by ``stand_off_m``, and the tool's axis off the normal by
    ``tilt_rad`` and ``lead_rad`` (``docs/frontend.md``, "Stand-off and tilt").
    """

    NEWER = ("edge_radius_m", "turn", "stand_off_m", "lead_rad", "tilt_rad")

    normal_force_n: NotNegative
    contact_radius_m: Annotated[FiniteFloat, Field(ge=0.001)] = 0.005
    edge_radius_m: NotNegative | None = None
    gravity_m_per_s2: Vector
    turn: Turn | None = None
    stand_off_m: Annotated[FiniteFloat, Field(ge=0, le=10)] = 0.0
    lead_rad: _Tilt = 0.0
    tilt_rad: _Tilt = 0.0

    @model_validator(mode="after")
    def _tilted_some_way(self) -> Self:
        if self.turn is None and (self.lead_rad or self.tilt_rad):
            raise ValueError(
                "lead_rad and tilt_rad need the tool's turn (task.turn): without it nothing says "
                "to which side the tool is tilted"
            )
        return self

    @property
    def rounding_m(self) -> float:
        """The radius over which the normals of a mesh are rounded."""
        return self.contact_radius_m if self.edge_radius_m is None else self.edge_radius_m


def _one_of_each(table: Table, *names: str) -> None:
    """Hold a table to give each threshold once: as a share of reach^3, or in m^3 as NAME_m3."""
    for name in names:
        given = [key for key in (name, f"{name}_m3") if getattr(table, key) is not None]
        if len(given) != 1:
            raise ValueError(f"give either {name} or {name}_m3")


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
    """When two configurations on neighboring vertices are joined by a continuous motion."""

    base_step_rad: Annotated[FiniteFloat, Field(gt=0), IN_RADIANS]
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


class Constraints(Table):
    """The paper's three constraints (section III-A); each can be left out."""

    collision: bool = True
    force: bool = True
    conditioning: bool = True


class Margins(Table):
    """How far arm and tool stay from everything, at least; without any, they only must not touch.

    The region where the tool works has its own room, ``contact_radius_m`` of the task.
    """

    to_object_m: NotNegative = 0.0
    to_obstacles_m: NotNegative = 0.0
    to_ground_m: NotNegative = 0.0
    between_links_m: NotNegative = 0.0


class Slivers(Table):
    """What happens to small cells; both thresholds are shares of the surface's area."""

    simplify_below_share: Share = 0.0
    uncover_below_share: Share = 0.0


class Motion(Table):
    """How the tool covers a segment, and how the arm moves; only planning a motion asks for it.

    Lists of joints go from base to tool, with m in the place of rad for prismatic ones.

    Attributes:
        tool_radius_m: of the tool's footprint.
        spacing_m: between neighboring passes.
        overlap_m: by how much the passes of two segments that meet overlap.
        speed_m_per_s: of the tool on the surface; slower where joints limit it.
        joint_velocities_rad_per_s: lower limits than the URDF's.
        joint_accelerations_rad_per_s2: limits, of which a URDF has none.
        joint_jerks_rad_per_s3: for judging: trajectories may not change accelerations faster.
            Planned ones are not made to keep it.
        lead_m: how far a tool that stands off goes straight on before and after each stroke.
        approach_speed_m_per_s: of the tool within 10 mm of a contact at most; ``speed_m_per_s``
            without it.
        transfer_speed_m_per_s: of the tip between strokes at most.
        even_feed: slow a stroke down as a whole to a feed that it can keep.
        least_feed: the share of ``speed_m_per_s`` below which the judge finds a fault.
        retract_m: along the normal, before a move to another stroke.
        clearance_m: distance from everything between strokes.
        home_rad: where the arm begins and ends, nowhere in particular without it; ``free`` asks for
            a free position, which is found.
    """

    NEWER = ("lead_m", "transfer_speed_m_per_s", "even_feed", "least_feed")

    tool_radius_m: Positive = 0.015
    spacing_m: Positive = 0.01
    overlap_m: NotNegative = 0.0
    speed_m_per_s: Positive = 0.05
    joint_velocities_rad_per_s: tuple[Positive, ...] | None = None
    joint_accelerations_rad_per_s2: tuple[Positive, ...]
    joint_jerks_rad_per_s3: tuple[Positive, ...] | None = None
    lead_m: NotNegative = 0.0
    approach_speed_m_per_s: Positive | None = None
    transfer_speed_m_per_s: Positive | None = None
    even_feed: bool = False
    least_feed: Annotated[FiniteFloat, Field(gt=0, le=1)] | None = None
    retract_m: Positive = 0.05
    clearance_m: NotNegative = 0.005
    home_rad: tuple[JointAngle, ...] | Literal["free"] | None = None

    @property
    def home(self) -> tuple[float, ...] | None:
        """``home_rad`` if it is a position."""
        return None if isinstance(self.home_rad, str) else self.home_rad


class Prefer(Table):
    """Which posture is preferred among divisions with as few segments (docs/motion.md, "Posture").

    ``near-home`` is the usual one if ``motion.home_rad`` is a position, else ``well-conditioned``.
    ``branch`` has words of the names of branches that come first, such as ``shoulder-left``.
    """

    posture: Literal["near-home", "well-conditioned"] | None = None
    branch: str | None = None


_NAME = re.compile(r"[A-Za-z]\w{0,31}", re.ASCII)
_NUMBERED = ("krl", "fanuc")  # languages in which tools and work objects are numbered


class Controller(Table):
    """The arm's controller, for which ``plan`` writes programs.

    The controller shows for an axis its ``signs`` times the URDF's angle, plus ``offsets_deg``;
    for the third one less ``j23_factor`` times the second, which is 1 on FANUC's arms unless it is
    given. Its frame is that of ``base_link``. ``tool`` and ``work_object`` are names, in KRL and on
    FANUC's controllers numbers.
    """

    language: Literal["urscript", "rapid", "krl", "fanuc"]
    signs: Annotated[tuple[Literal[-1, 1], ...], Field(min_length=6, max_length=6)] = (1,) * 6
    offsets_deg: Annotated[tuple[_Degrees, ...], Field(min_length=6, max_length=6)] = (0.0,) * 6
    j23_factor: Literal[-1, 0, 1] | None = None
    base_link: str | None = None
    tool: str | int | None = None
    work_object: str | int | None = None

    @model_validator(mode="after")
    def _named_as_there(self) -> Self:
        for key in ("tool", "work_object"):
            given, numbered = getattr(self, key), self.language in _NUMBERED
            fits = type(given) is int and 1 <= given <= 32
            if not numbered:
                fits = isinstance(given, str) and _NAME.fullmatch(given) is not None
            if given is not None and not fits:
                what = "a number from 1 to 32" if numbered else "a name of letters and digits"
                raise ValueError(f"{key} must be {what} in {self.language}")
        return self

    @property
    def frames(self) -> tuple[str | int, str | int]:
        """The tool and the work object."""
        usual = (1, 1) if self.language in _NUMBERED else ("cellcolor_tool", "cellcolor_part")
        return self.tool or usual[0], self.work_object or usual[1]

    @property
    def counts_as_urdf(self) -> bool:
        """Whether the controller shows the URDF's angles."""
        return set(self.signs) == {1} and not any(self.offsets_deg) and not self.coupling

    @property
    def coupling(self) -> int:
        """``j23_factor`` as it is or would be."""
        return int(self.language == "fanuc") if self.j23_factor is None else self.j23_factor


class Setup(FileTable):
    """Robot, task, thresholds, continuity, slivers, motion, preference, controller."""

    NEWER = ("margins", "prefer", "controller")

    robot: RobotFiles
    task: Task
    thresholds: Thresholds
    continuity: Continuity
    constraints: Constraints = Constraints()
    margins: Margins = Margins()
    slivers: Slivers | None = None
    motion: Motion | None = None
    prefer: Prefer = Prefer()
    controller: Controller | None = None

    @model_validator(mode="after")
    def _home_is_known(self) -> Self:
        if self.prefer.posture == "near-home" and (self.motion is None or self.motion.home is None):
            raise ValueError("prefer.posture 'near-home' needs a position as motion.home_rad")
        return self
