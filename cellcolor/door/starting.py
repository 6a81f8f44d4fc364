"""``cellcolor.new``: a first scene and setup, from a part's mesh and an arm's URDF."""

from __future__ import annotations

import json
import os
import re
import tomllib
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import product
from os import PathLike
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING

import numpy as np

from cellcolor.deadline import Deadline, TimeLimit
from cellcolor.door.extras import require_motion
from cellcolor.door.parts import inspect
from cellcolor.door.starting_texts import MARK, SCENE, SETUP, TOOL
from cellcolor.errors import InputError, naming
from cellcolor.files.paths import path_of
from cellcolor.files.writing import FileKind, Output, check_output, is_folder_or_nothing, write

if TYPE_CHECKING:
    import xml.etree.ElementTree as ET

    from cellcolor.arrays import Array
    from cellcolor.frontend.arm.robot import Robot
    from cellcolor.frontend.arm.urdf import Urdf
    from cellcolor.frontend.parts.inspection import Inspection
    from cellcolor.frontend.prepared import PreparedScene
    from cellcolor.frontend.setup import Setup

_FLANGES = ("tool0", "flange", "ee_link", "wrist_3_link", "tool_flange")
_FAMILIES = ("ur", "eaik", "offset-wrist")  # the second says most about an arm that fits none
_NEEDED = ("pinocchio", "fcl", "igl", "trimesh", "scipy")
_JOINTS, _ACCELERATION = 6, 5.0  # rad/s^2, which most arms of a meter can
_ALONG = 1e-3  # rad; an axis so near to another one is along it
_AHEAD = 1e-3  # m; so far along the axis the flange is at least from what shows its sense
_JERK = 1000.0  # rad/s^3, an example
_MOST_ASKED = 300  # vertices of the part, wherever it is tried
_FARTHER, _HIGHER = (0.45, 0.6, 0.75), (0.02, 0.2, 0.4)
"""Places that are tried: of the part's middle before the robot, and of its lowest point above the
ground, as shares of the arm's reach."""

_FILE = FileKind("a file begun by cellcolor new", re.compile(re.escape(MARK).encode()))
_TOOL_FILE = FileKind("a tool begun by cellcolor new", re.compile(rb"<!-- begun by cellcolor new"))


@dataclass(frozen=True)
class Started:
    """What was written, and what it can do.

    Attributes:
        scene: its file; beside it are ``setup.toml`` and, if none was given, ``tool.urdf``.
        reachable_share: of the part's vertices that were asked about where it was put, 0 to 1.
        notes: what to look at, a sentence each.
    """

    scene: Path
    reachable_share: float
    notes: tuple[str, ...]


def new(
    part: str | PathLike[str],
    arm: str | PathLike[str],
    folder: str | PathLike[str],
    *,
    tool: str | PathLike[str] | None = None,
    tip_link: str = "tip",
    unit: str | None = None,
    time_limit: TimeLimit = None,
    progress: Callable[[str], None] | None = None,
) -> Started:
    """Write a scene and its setup, with every key explained, ready for ``cellcolor plan``.

    The arm has six turning joints. The function finds its family, its flange and the links that
    always overlap. It puts the part where most of it can be reached, of nine places in front of the
    robot, and proposes a free home position.

    Args:
        part: a mesh file (STL, OBJ, PLY).
        arm: a URDF.
        folder: for the files; it is created if it does not exist.
        tool: a URDF of the tool; None for a polisher of 100 mm, whose URDF is written as well.
        tip_link: of the tool.
        unit: ``m``, ``mm``, ``cm`` or ``in``, of the mesh; without it the likely one.
        time_limit: seconds, None for no limit.
        progress: told what is being done.

    Raises:
        InputError: mesh or URDF cannot be used, no part of the mesh can be reached anywhere, or
            the folder has files of its own by these names.
        OutOfTime: the time limit came first.
    """
    deadline, tell = Deadline.of(time_limit), progress or (lambda _: None)
    require_motion("finding a home position", _NEEDED)
    mesh, urdf, place = path_of(part), path_of(arm), path_of(folder)
    names = ["setup.toml", "scene.toml", *(["tool.urdf"] if tool is None else [])]
    kinds = {name: _TOOL_FILE if name.endswith(".urdf") else _FILE for name in names}
    if is_folder_or_nothing(place):
        for name, kind in kinds.items():
            check_output(place / name, kind, [mesh, urdf])
    tip = "tip" if tool is None else tip_link

    tell("the arm")
    robot = arm_of(urdf, None if tool is None else path_of(tool), tip, place)
    tell("the part")
    part_keys = part_keys_of(mesh, place, inspect(mesh, unit=unit, time_limit=deadline))
    tell("where the part can stand")
    best, share = best_place(robot, mesh, part_keys, deadline)
    home = _home(best)
    robot.keys.update(_found(best, home))
    part_keys["position"] = json.dumps(list(best.scene.placement.position_m))
    content = {
        "setup.toml": Template(SETUP).substitute(robot.keys),
        "scene.toml": Template(SCENE).substitute(part_keys),
        "tool.urdf": TOOL,
    }
    place.mkdir(parents=True, exist_ok=True)
    write([Output(place / name, kinds[name], [content[name].encode()]) for name in names])
    return Started(
        place / "scene.toml", share, tuple(_notes(best, robot.touching, home, tool is None))
    )


@dataclass(frozen=True)
class FoundArm:
    """An arm whose family was recognized.

    Attributes:
        urdf: its file.
        tool: the tool's; None for the one that is written beside the setup.
        keys: what is filled into the setup's text.
        reach: of the arm, m.
        touching: pairs of its links that overlap in every posture.
    """

    urdf: Path
    tool: Path | None
    keys: dict[str, str]
    reach: float = 0.0
    touching: tuple[tuple[str, str], ...] = ()

    @property
    def setup(self) -> Setup:
        """As its file will have it; the folder of that is not there yet."""
        from cellcolor.frontend.setup import Setup

        table = tomllib.loads(Template(SETUP).substitute(self.keys))
        table["robot"]["arm_urdf"] = str(self.urdf.resolve())
        table["robot"]["tool_urdf"] = TOOL if self.tool is None else str(self.tool.resolve())
        return Setup(**table)


def arm_of(urdf: Path, tool: Path | None, tip: str, folder: Path) -> FoundArm:
    """The arm with the first family that fits it; its setup will be in the folder.

    Raises:
        InputError: none does.
    """
    from cellcolor.frontend.arm.urdf import load_urdf
    from cellcolor.frontend.contact.engine import pairs_of
    from cellcolor.frontend.reach.always_touching import always_touching
    from cellcolor.frontend.reach.prepared_arm import prepare_arm

    arm = load_urdf(urdf)
    flange = next((link for link in _FLANGES if link in arm.parent), None) or _last_link(arm.parent)
    chain = arm.chain(flange)
    moved = next((at for at, link in enumerate(chain) if arm.joint_above.get(link) in arm.kinds), 0)
    standing = [link for link in chain[: moved + 1] if link in arm.shapes]
    keys = {
        "arm": urdf.name,
        "arm_urdf": json.dumps(_relative(urdf, folder)),
        "flange": json.dumps(flange),
        "mount": _mount(arm, flange),
        "tool": json.dumps("tool.urdf" if tool is None else _relative(tool, folder)),
        "tip": json.dumps(tip),
        "standing": json.dumps(standing),
        "force": "false" if arm.weightless else "true",
        "why_force": "the URDF lacks masses or efforts" if arm.weightless else "true or false",
        "touching": "[]",
        "velocities": "",
        "accelerations": json.dumps([_ACCELERATION] * _JOINTS),
        "jerks": json.dumps([_JERK] * _JOINTS),
        "joints": "",
        "home": "",
    }
    faults: list[InputError] = []
    for family in _FAMILIES:
        found = FoundArm(urdf, tool, keys | {"family": json.dumps(family)})
        try:
            prepared = prepare_arm(found.setup)
            reach = prepared.kinematics.reach
            # Before a place is sought: with such a pair tested, the arm could stand nowhere.
            pairs = always_touching(prepared.robot, pairs_of(prepared.robot))
        except InputError as error:
            faults.append(error)
            continue
        touching = json.dumps([list(pair) for pair in pairs])
        return replace(found, keys=found.keys | {"touching": touching}, reach=reach, touching=pairs)
    raise faults[1] if faults[1].file else faults[1].in_file(str(urdf))


def _mount(arm: Urdf, flange: str) -> str:
    """The setup's line that turns the tool's z axis onto the last joint's, if it is not there.

    Some vendors' flanges have their x axis along that of the joint.
    """
    from cellcolor.frontend.parts.placement import rpy_from_rotation

    x, y, z = _last_axis(arm, flange)
    along = np.hypot(x, y) < _ALONG
    if along and z > 0:
        return ""
    # Turned about the axis across both.
    cross = np.array([[0, 0, x], [0, 0, y], [-x, -y, 0]])
    onto = np.diag([1, -1, -1]) if along else np.eye(3) + cross + cross @ cross / (1 + z)
    angles = [round(angle, 9) + 0.0 for angle in rpy_from_rotation(onto)]
    return f"mount_rpy_rad = {angles}   # turns the tool's z axis onto the last joint's\n"


def _last_axis(arm: Urdf, flange: str) -> Array:
    """The last axis (3,) before the flange, in its frame; outward with all joints at zero."""
    from cellcolor.frontend.parts.placement import rotation_from_rpy

    joints = {joint.get("name"): joint for joint in arm.xml.findall("joint")}
    turn, out, link = np.eye(3), np.zeros(3), flange  # of the flange, seen from a link before it
    axis: Array | None = None
    while link in arm.parent:
        joint = joints[arm.joint_above[link]]
        if axis is None and arm.joint_above[link] in arm.kinds:
            axis = _numbers(joint.find("axis"), "xyz", "1 0 0") @ turn
            axis /= np.linalg.norm(axis)
        if axis is not None and abs(ahead := axis @ (out @ turn)) > _AHEAD:
            return np.asarray(axis * np.sign(ahead))
        xyz, rpy = (_numbers(joint.find("origin"), key, "0 0 0") for key in ("xyz", "rpy"))
        rotation = rotation_from_rpy(*rpy)
        turn, out, link = rotation @ turn, xyz + rotation @ out, arm.parent[link]
    return np.array([0.0, 0.0, 1.0]) if axis is None else axis


def _numbers(element: ET.Element | None, key: str, usual: str) -> Array:
    return np.array((usual if element is None else element.get(key, usual)).split(), dtype=float)


def _relative(file: Path, folder: Path) -> str:
    return Path(os.path.relpath(file.resolve(), folder.resolve())).as_posix()


def _last_link(parent: dict[str, str]) -> str:
    """The link farthest from the root; of several the first."""
    if not parent:
        return ""

    def depth(link: str) -> int:
        count = 0
        while link in parent:
            link, count = parent[link], count + 1
        return count

    return max(parent, key=depth)


def part_keys_of(mesh: Path, folder: Path, looked: Inspection) -> dict[str, str]:
    """What is filled into the scene's text.

    Raises:
        InputError: the mesh cannot be used, not even repaired.
    """
    from cellcolor.frontend.parts.mesh_file import UNITS

    if looked.refusal_after_repair is not None:
        raise InputError(str(mesh), None, looked.refusal_after_repair)
    return {
        "name": json.dumps(mesh.stem),
        "part": json.dumps(_relative(mesh, folder)),
        "meters_per_unit": str(UNITS[looked.unit]),
        "repair": "true" if looked.repairs else "false",
    }


def best_place(
    arm: FoundArm, mesh: Path, part_keys: dict[str, str], deadline: Deadline
) -> tuple[PreparedScene, float]:
    """The scene where most of the part can be reached, and the share of it.

    Raises:
        InputError: nothing of it can be reached anywhere.
    """
    from cellcolor.data.candidate_table import VALID
    from cellcolor.frontend.parts.placement import Placement
    from cellcolor.frontend.prepared import prepare
    from cellcolor.frontend.scene import Scene

    table = tomllib.loads(Template(SCENE).substitute(part_keys, position="[0.0, 0.0, 0.0]"))
    table["object"]["file"] = str(mesh.resolve())
    scene = Scene(**table | {"setup": arm.setup})
    with naming(mesh):
        vertices = scene.object.surface(scene.folder, deadline).vertices
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    middle = (low + high) / 2
    best: tuple[PreparedScene, float] | None = None
    prepared: PreparedScene | None = None
    fault: InputError | None = None
    failed: Counter[str] = Counter()
    for far, raised in product(_FARTHER, _HIGHER):
        position = far * arm.reach - middle[0], -middle[1], raised * arm.reach - low[2]
        try:
            place = Placement(position_m=(np.round(position, 3) + 0.0).tolist())
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
        valid = (verdicts.reasons == VALID).reshape(solved.shape[:2]).any(axis=1)
        failed.update(prepared.judge.reason_names[code] for code in verdicts.reasons.tolist())
        share = float(valid.mean())
        if best is None or share > best[1]:
            best = prepared, share
    if best is None:
        assert fault is not None
        raise fault
    if best[1] == 0:
        message = (
            "nothing of the part can be reached at any of nine places before the robot; most often "
            f"a posture fails by {failed.most_common(1)[0][0]!r}: does the part's outside face the "
            "robot, and is its size one for this arm?"
        )
        raise InputError(str(mesh), None, message)
    return best


def _home(prepared: PreparedScene) -> list[float] | None:
    """A free position near the middle of the joints' limits, rad."""
    from cellcolor.motion.free_space import FreeSpace
    from cellcolor.motion.home import free_near
    from cellcolor.motion.limits import motion_of

    robot = prepared.robot
    lower = np.where(np.isfinite(robot.lower), robot.lower, -np.pi)
    upper = np.where(np.isfinite(robot.upper), robot.upper, np.pi)
    motion = motion_of(prepared)
    return free_near(FreeSpace(prepared, motion.clearance_m), np.round((lower + upper) / 2, 2))


def _found(prepared: PreparedScene, home: list[float] | None) -> dict[str, str]:
    """The keys of the setup's file that only the prepared scene tells."""
    robot = prepared.robot
    return {
        "accelerations": json.dumps([_ACCELERATION] * robot.joints),
        "jerks": json.dumps([_JERK] * robot.joints),
        "velocities": _velocities(robot),
        "home": "# home_rad = []" if home is None else f"home_rad = {json.dumps(home)}",
        "joints": ", ".join(robot.joint_names),
    }


def _velocities(robot: Robot) -> str:
    """The line on velocities, which is needed where the URDF has none."""
    lacks = bool(np.isnan(robot.velocity).any())
    line = f"joint_velocities_rad_per_s = {json.dumps([1.0] * robot.joints)}"
    why = "the URDF lacks them: take the data sheet's" if lacks else "lower than the URDF's"
    return f"{'' if lacks else '# '}{line}  # {why}"


def _notes(
    prepared: PreparedScene,
    touching: tuple[tuple[str, str], ...],
    home: list[float] | None,
    own_tool: bool,
) -> Iterator[str]:
    if own_tool:
        yield "tool.urdf is a polisher of 100 mm: put your tool's shape and length into it"
    for first, second in touching:
        yield f"{first} and {second} overlap in every posture: setup.toml lets them touch"
    yield "setup.toml has accelerations of 5 rad/s²: take those of the arm's data sheet"
    if np.isnan(prepared.robot.velocity).any():
        yield "setup.toml has velocities of 1 rad/s, since the URDF has none"
    if not prepared.setup.constraints.force:
        yield "torques are not tested, since the URDF lacks masses or efforts"
    if home is None:
        yield "no free home position was found: the motion may begin and end anywhere"
    yield from prepared.notes
