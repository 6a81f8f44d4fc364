"""What ``cellcolor.new`` chooses: the flange, joints that stand still, the side, place and home."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Literal

import numpy as np

from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import Deadline
from cellcolor.errors import InputError

if TYPE_CHECKING:
    from cellcolor.arrays import Array, Index, Mask
    from cellcolor.frontend.arm.urdf import Urdf
    from cellcolor.frontend.prepared import PreparedScene
    from cellcolor.frontend.reach.validity import Verdicts
    from cellcolor.frontend.scene import Scene
    from cellcolor.mesh.triangle_mesh import TriangleMesh

Outside = Literal["toward", "away", "flip"]
CoverChoice = Literal["largest", "all"]

_TOWARD = np.array([-1.0, 0.0, 1.0]) / np.sqrt(2)  # the part lies before the robot: up and back
_ALONG = 1e-3  # rad; an axis so near to another one is along it
_OFF, _MOST_OFF = 1e-6, 1e-3  # m; a flange so far beside the last axis was measured, not meant
_UPRIGHT, _AWRY = 0.5, 0.35  # how far the mean of normals leans; rad: less is not turned
_ANY_WAY = 0.2  # the mean of the unit normals of what faces every way is shorter
_LARGER = 1.02  # times the inner side's area has a shell's outer one, if it is bent
_ABOVE = (0.1, 0.15, 0.05, 0.2)  # m; so far over the part the arm waits, the first that is free
_MOST_ASKED = 300  # vertices of the part, wherever it is tried
_FARTHER, _HIGHER = (0.45, 0.6, 0.75), (0.02, 0.2, 0.4)
"""Places that are tried: of the part's middle before the robot, and of its lowest point above the
ground, as shares of the arm's reach."""
_UP, _BELOW = 0.6, (0.8, 0.6, 0.4)
"""An arm whose first joint is higher than the first share hangs, or stands on something. Then the
part's highest point lies so far below that joint."""
_WORST = 0.1  # of the points count for how well they are reached
_NEARLY = 0.9  # of what the best posture covers


def mount_line(arm: Urdf, flange: str, still: Mapping[str, float]) -> str:
    """The setup's lines that put the tool's z axis onto the last joint's, if it is not there.

    Some vendors' flanges have their x axis along that of the joint, or lie a little beside it.

    Args:
        still: the positions of joints that stand still.
    """
    from cellcolor.frontend.arm.assembly import last_axis
    from cellcolor.frontend.parts.placement import rpy_from_rotation

    (x, y, z), beside = last_axis(arm, flange, still)
    lines = ""
    off = float(np.linalg.norm(beside))
    if _OFF < off < _MOST_OFF:
        back = [round(-along, 9) + 0.0 for along in beside.tolist()]
        lines = (
            f"mount_position_m = {back}   # the flange is {1e3 * off:.3g} mm off the last axis\n"
        )
    along = np.hypot(x, y) < _ALONG
    if along and z > 0:
        return lines
    # Turned about the axis across both.
    cross = np.array([[0, 0, x], [0, 0, y], [-x, -y, 0]])
    onto = np.diag([1, -1, -1]) if along else np.eye(3) + cross + cross @ cross / (1 + z)
    angles = [round(angle, 9) + 0.0 for angle in rpy_from_rotation(onto)]
    return f"{lines}mount_rpy_rad = {angles}   # turns the tool's z axis onto the last joint's\n"


def fixed_of(arm: Urdf, flange: str, given: Mapping[str, float]) -> dict[str, float]:
    """The positions of joints that stand still: those given, rails, and what is beside the chain.

    Where none is given, the one nearest to zero.
    """
    from cellcolor.frontend.arm.urdf import PRISMATIC

    in_chain = [arm.above[link] for link in arm.chain(flange)[1:]]
    fixed = dict(given)
    for name, joint in arm.leading.items():
        if name not in fixed and (joint.kind == PRISMATIC or joint not in in_chain):
            fixed[name] = float(np.clip(0.0, joint.lower, joint.upper))
    return fixed


def fixed_line(fixed: Mapping[str, float]) -> str:
    """The setup's line on joints that stand still, if there are any."""
    if not fixed:
        return ""
    joints = ", ".join(f"{json.dumps(name)} = {position!r}" for name, position in fixed.items())
    return f"fixed_joints = {{ {joints} }}   # joints that stand still, rad or m\n"


def _chosen(
    keys: dict[str, str], note: str, mean: Array | None = None, outside: Outside | None = None
) -> tuple[dict[str, str], str]:
    """Keys and note of a side, and how far it is turned about the vertical to face the robot.

    Args:
        mean: of its normals (3,), if it has to face the robot; not if it is to face ``away``.
    """
    yaw = 0.0
    if mean is not None and outside != "away" and np.hypot(mean[0], mean[1]) > _UPRIGHT:
        yaw = round(float(np.angle(-(mean[0] - 1j * mean[1]))), 4) + 0.0
        if abs(yaw) > _AWRY:
            note += f"; turned by {np.degrees(yaw):.0f} degrees, it faces the robot"
        else:
            yaw = 0.0
    return keys | {"rpy": json.dumps([0.0, 0.0, yaw])}, note


def side_of(
    mesh: TriangleMesh, outside: Outside | None, cover: CoverChoice | None
) -> tuple[dict[str, str], str]:
    """The side that is asked for, or the likely one.

    Of a shell that is the outer one, or the one that faces up; of any other part all of it, as its
    faces are wound.

    Args:
        mesh: the part as its file has it, m.

    Returns:
        What is filled into the scene's text, and what to say.

    Raises:
        InputError: the part has no such side.
    """
    from cellcolor.frontend.parts.cover import facing, pieces, shell_sides, thickness

    thick = thickness(mesh)
    sides = None if thick is None else shell_sides(mesh)
    if thick is not None and sides is not None and cover != "all":
        number, name, other = _side(mesh, sides, outside)
        return _chosen(
            {"flip": "", "cover": _cover(mesh, sides[number])},
            f"the part is a shell, {1e3 * thick:.2g} mm thick: its {name} is covered ({other} for "
            "the other one, --cover all for both)",
            facing(mesh, sides[number]),
            outside,
        )
    flip = _flipped(mesh, outside)
    mean = facing(mesh) * (-1 if flip else 1)
    note = "all of the part is covered"
    turned = "flip = true                         # the other side is the outside\n"
    keys = {"flip": turned if flip else "", "cover": ""}
    if cover == "largest":
        largest = pieces(mesh)[0]
        if not largest.all():
            keys["cover"] = _cover(mesh, largest)
            note = "the largest piece between sharp edges is covered"
    if mesh.border.any():
        wound = "turned over, its outside" if flip else "as its faces are wound, its outside"
        other = "without --outside" if flip else "--outside flip"
        note += f"; {wound} faces {_way(mean)} ({other} for the other side)"
    elif thick is not None:
        note += f", both sides of a shell {1e3 * thick:.2g} mm thick ([cover] chooses one)"
    return _chosen(keys, note, mean if mesh.border.any() else None, outside)


def _side(mesh: TriangleMesh, sides: list[Mask], outside: Outside | None) -> tuple[int, str, str]:
    """Which of the two sides of a shell is covered, its name, and how to ask for the other one.

    Without a wish that is the outer one; of a flat shell the one that faces up and to the robot.
    """
    from cellcolor.frontend.parts.cover import facing

    first, second = (facing(mesh, side) for side in sides)
    areas = [float(mesh.areas[side].sum()) for side in sides]
    bent = areas[0] > _LARGER * areas[1]
    toward = int(second @ _TOWARD > first @ _TOWARD)
    usual = 0 if bent else toward
    chosen = {None: usual, "toward": toward, "away": 1 - toward, "flip": 1 - usual}[outside]
    name = ("outer side", "inner side")[chosen] if bent else "side"
    name += f", which faces {_way((first, second)[chosen])},"
    return chosen, name, "--outside flip" if chosen == usual else "without --outside"


def _flipped(mesh: TriangleMesh, outside: Outside | None) -> bool:
    """Whether the faces of an open part have to be turned over.

    Raises:
        InputError: it is closed, or faces every way.
    """
    from cellcolor.frontend.parts.cover import facing

    if outside is None:
        return False
    if not mesh.border.any():
        message = "the part is closed and no shell: its outside is where its volume is not"
        raise InputError(None, "--outside", message)
    if outside == "flip":
        return True
    mean = facing(mesh)
    if np.linalg.norm(mean) < _ANY_WAY:
        raise InputError(None, "--outside", "the part faces every way: flip turns it over")
    return bool((mean @ _TOWARD > 0) != (outside == "toward"))


def _cover(mesh: TriangleMesh, faces: Mask) -> str:
    """The scene's table for one side."""
    from cellcolor.frontend.parts.cover import SHARP_RAD, inner_point

    seed = [round(x, 6) + 0.0 for x in inner_point(mesh, faces).tolist()]
    return (
        "\n# The faces around a point, up to sharp edges; the rest must only not be hit.\n"
        f"[cover]\nregion = {{ seed_m = {json.dumps(seed)}, sharp_rad = {SHARP_RAD} }}\n"
    )


def _way(mean: Array) -> str:
    """Where a mean of normals points, for one who stands at the robot."""
    names = ("towards the robot", "away from it", "left", "right", "up", "down")
    ways = np.array([[-1, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
    if np.linalg.norm(mean) < _ANY_WAY:
        return "every way"
    return names[int(np.argmax(ways @ mean))]


def _home_over(prepared: PreparedScene) -> tuple[list[float], str] | None:
    """A free, well-conditioned position over the part's middle, rad, and its posture in words.

    The tool points at the part. Of the postures that cover nearly as much as the best one, the one
    whose joints are nearest to the middle of their limits. None if there is none.
    """
    from cellcolor.motion.free_space import FreeSpace
    from cellcolor.motion.limits import motion_of

    surface, arm = prepared.surface, prepared.arm
    step = -(-len(surface.vertices) // _MOST_ASKED)
    solved = arm.inverse(surface.vertices[::step], -surface.normals[::step])
    verdicts = prepared.judge(solved.reshape(-1, solved.shape[2]))
    covers = (verdicts.reasons == VALID).reshape(solved.shape[:2]).mean(axis=0)
    middle = (surface.vertices.min(axis=0) + surface.vertices.max(axis=0)) / 2
    nearest: Index = np.argsort(np.linalg.norm(surface.vertices - middle, axis=1))[:3]
    free = FreeSpace(prepared, motion_of(prepared).clearance_m)
    lower, upper = (np.clip(limit, -np.pi, np.pi) for limit in free.space.limits)
    names = prepared.arm.kinematics.branches if arm.named else ()
    for above in _ABOVE:
        points = surface.vertices[nearest] + above * surface.normals[nearest]
        found = arm.inverse(points, -surface.normals[nearest])
        branch = np.tile(np.arange(found.shape[1]), len(nearest))
        tried = np.round(found.reshape(-1, found.shape[2]), 2)
        good = ~np.isnan(tried[:, 0])
        if names:
            good &= (covers >= _NEARLY * covers.max())[branch]
        rows = np.flatnonzero(good)
        rows = rows[prepared.judge(tried[rows]).reasons == VALID]
        rows = rows[free(tried[rows])]
        if len(rows):
            best = rows[np.argmin(free.space.largest(tried[rows] - (lower + upper) / 2))]
            where = f"{1e3 * above:g} mm over the part"
            posture = f"{names[branch[best]]}, {where}" if names else where
            return [float(angle) + 0.0 for angle in tried[best]], posture
    return None


def home_of(prepared: PreparedScene) -> tuple[list[float] | None, str]:
    """A free position over the part, or near the middle of the joints' limits, rad; and which."""
    from cellcolor.motion.free_space import FreeSpace
    from cellcolor.motion.limits import free_near, motion_of

    over = _home_over(prepared)
    if over is not None:
        return over[0], f"the arm begins and ends {over[1]}"
    robot = prepared.robot
    lower = np.where(np.isfinite(robot.lower), robot.lower, -np.pi)
    upper = np.where(np.isfinite(robot.upper), robot.upper, np.pi)
    free = FreeSpace(prepared, motion_of(prepared).clearance_m)
    home = free_near(free, np.round((lower + upper) / 2, 2))
    if home is None:
        return None, "no free home position was found: the motion may begin and end anywhere"
    return home, "the arm begins and ends near the middle of its limits: none over the part is free"


def best_place(
    scene: Scene, reach: float, base_m: tuple[float, float, float], deadline: Deadline
) -> tuple[PreparedScene, float]:
    """The scene with the part where the arm reaches it best, and the share of it that is reached.

    Of nine places before the robot that is the one where most of the part can be reached, then most
    of it in one posture, then where this posture is farthest from limits and singularities at the
    worst tenth of the points.

    Args:
        scene: with the part's file in the origin.
        reach: of the arm, m.
        base_m: its first joint in the world.

    Raises:
        InputError: nothing of it can be reached anywhere.
    """
    from cellcolor.frontend.prepared import prepare

    vertices = scene.placement.placed(scene.object.surface(scene.folder, deadline).vertices)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    middle = (low + high) / 2
    tried: list[_Reached] = []
    prepared: PreparedScene | None = None
    fault: InputError | None = None
    failed: Counter[str] = Counter()
    x, y, z = base_m
    heights = [share * reach - low[2] for share in _HIGHER]
    if z > _UP * reach:
        heights = [max(z - share * reach - high[2], -low[2]) for share in _BELOW]
    for far, height in product(_FARTHER, heights):
        position = x + far * reach - middle[0], y - middle[1], height
        try:
            place = scene.placement.varied(position_m=(np.round(position, 3) + 0.0).tolist())
            if prepared is None:
                prepared = prepare(scene.varied(placement=place), deadline)
            else:
                prepared = prepared.at(place)
        except InputError as error:  # such as a part that would stand in the robot
            fault = error
            continue
        surface = prepared.surface
        step = -(-len(surface.vertices) // _MOST_ASKED)
        solved = prepared.arm.inverse(surface.vertices[::step], -surface.normals[::step], deadline)
        verdicts = prepared.judge(solved.reshape(-1, prepared.robot.joints), deadline)
        failed.update(prepared.judge.reason_names[code] for code in verdicts.reasons.tolist())
        tried.append(_Reached.of(prepared, verdicts, solved.shape[:2]))
    if not tried:
        assert fault is not None
        raise fault
    greatest = max(float(one.determinants.max(initial=0.0)) for one in tried)
    best = max(tried, key=lambda one: one.merit(greatest))  # the first of several
    if not best.valid.any():
        message = (
            "nothing of the part can be reached at any of nine places before the robot; most often "
            f"a posture fails by {failed.most_common(1)[0][0]!r}: does the part's outside face the "
            "robot (--outside flip), and is its size one for this arm?"
        )
        raise InputError(None, None, "; ".join([message, *best.prepared.robot.warnings]))
    return best.prepared, float(best.valid.any(axis=1).mean())


@dataclass(frozen=True, eq=False)
class _Reached:
    """How well the arm reaches a sample of the part's vertices in one place, in each posture.

    Attributes:
        prepared: the scene with the part there.
        valid: (n, branches) whether the arm may be on that vertex.
        determinants: (n, branches) of the task, m³; 0 where it may not.
        room: (n, branches) to the joint limits, 0 to 1.
    """

    prepared: PreparedScene
    valid: Mask
    determinants: Array
    room: Array

    @classmethod
    def of(cls, prepared: PreparedScene, verdicts: Verdicts, shape: tuple[int, int]) -> _Reached:
        """From the verdicts on the candidates of all vertices."""
        from cellcolor.motion.posture import joint_room

        valid = verdicts.reasons == VALID
        room = joint_room(prepared.robot, np.where(valid[:, None], verdicts.configurations, 0.0))
        determinants = np.where(valid, verdicts.determinants, 0.0)
        own = (valid.reshape(shape), determinants.reshape(shape), room.reshape(shape))
        return cls(prepared, *own)

    def merit(self, greatest: float) -> tuple[float, float, float]:
        """What a better place has more of: reach, reach in one posture, and distance to limits.

        Args:
            greatest: determinant of all places, m³.
        """
        valid = self.valid
        good = np.where(valid, np.minimum(self.determinants / (greatest or 1.0), self.room), 0.0)
        if not self.prepared.arm.named:  # columns are no postures
            valid, good = np.array([valid.any(axis=1)]).T, np.array([good.max(axis=1)]).T
        shares, worst = valid.mean(axis=0).round(2), np.quantile(good, _WORST, axis=0)
        branch = max(range(len(shares)), key=lambda own: (shares[own], worst[own]))
        share = float(valid.any(axis=1).mean().round(2))
        return share, float(shares[branch]), float(worst[branch])
