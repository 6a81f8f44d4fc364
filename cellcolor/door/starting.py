"""``cellcolor.new``: a first scene and setup, from a part's mesh and an arm's URDF."""

from __future__ import annotations

import json
import math
import os
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING

import numpy as np

from cellcolor.deadline import Deadline, TimeLimit
from cellcolor.door.installed import require_motion
from cellcolor.door.parts import inspect
from cellcolor.door.starting_choices import (
    CoverChoice,
    Outside,
    best_place,
    fixed_line,
    fixed_of,
    home_of,
    mount_line,
    side_of,
)
from cellcolor.door.starting_texts import MARK, SCENE, SETUP, TOOL
from cellcolor.errors import InputError, naming
from cellcolor.files.writing import (
    FileKind,
    Output,
    check_output,
    is_folder_or_nothing,
    path_of,
    write,
)

if TYPE_CHECKING:
    from cellcolor.frontend.parts.inspection import Inspection
    from cellcolor.frontend.prepared import PreparedScene
    from cellcolor.frontend.setup import Setup

_FLANGES = ("tool0", "flange", "ee_link", "wrist_3_link", "tool_flange")
_FAMILIES = ("ur", "eaik", "offset-wrist")  # the second says most about an arm that fits none
_NEEDED = ("pinocchio", "fcl", "igl", "trimesh", "scipy")
_JOINTS, _ACCELERATION = 6, 5.0  # rad/s^2, which most arms of a meter can
_JERK = 1000.0  # rad/s^3, an example
_EDGES_M, _VERTICES = (0.01, 0.1), 2500  # the longest edges: as long as gives so many vertices

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
    outside: Outside | None = None,
    cover: CoverChoice | None = None,
    fix: Mapping[str, float] | None = None,
    time_limit: TimeLimit = None,
    progress: Callable[[str], None] | None = None,
) -> Started:
    """Write a scene and its setup, with every key explained, ready for ``cellcolor plan``.

    The arm has six turning joints; rails and joints beside the chain stand still. The function
    finds its family, its flange and the links that always overlap. It puts the part where the arm
    reaches it best, of nine places in front of the robot (``best_place``), and proposes a free
    home position over it. What it assumed is in the notes.

    Args:
        part: a mesh file (STL, OBJ, PLY).
        arm: a URDF.
        folder: for the files; it is created if it does not exist.
        tool: a URDF of the tool; None for a polisher of 100 mm, whose URDF is written as well.
        tip_link: of the tool.
        unit: ``m``, ``mm``, ``cm`` or ``in``, of the mesh; without it the likely one.
        outside: of an open part, the side that faces ``toward`` the robot or ``away`` from it, or
            ``flip``, the other one than its faces have; of a shell, the side that is covered.
        cover: ``largest`` for the largest piece between sharp edges, ``all``; without it one side
            of a shell, all of other parts.
        fix: positions of joints that stand still, rad, or m of prismatic ones.
        time_limit: seconds, None for no limit.
        progress: told what is being done.

    Raises:
        InputError: mesh or URDF cannot be used, no part of the mesh can be reached anywhere, or
            the folder has files of its own by these names.
        OutOfTime: the time limit came first.
    """
    deadline, tell = Deadline.of(time_limit), progress or (lambda _: None)
    require_motion("finding a home position", _NEEDED)
    from cellcolor.frontend.scene import Scene

    mesh, urdf, place = path_of(part), path_of(arm), path_of(folder)
    names = ["setup.toml", "scene.toml", *(["tool.urdf"] if tool is None else [])]
    kinds = {name: _TOOL_FILE if name.endswith(".urdf") else _FILE for name in names}
    if is_folder_or_nothing(place):
        for name, kind in kinds.items():
            check_output(place / name, kind, [mesh, urdf])
    tip = "tip" if tool is None else tip_link

    tell("the arm")
    robot = arm_of(urdf, None if tool is None else path_of(tool), tip, place, fix or {})
    tell("the part")
    looked = inspect(mesh, unit=unit, time_limit=deadline)
    part_keys, side = part_keys_of(mesh, place, looked, outside, cover)
    tell("where the part can stand")
    table = tomllib.loads(Template(SCENE).substitute(part_keys, position="[0.0, 0.0, 0.0]"))
    table["object"]["file"] = str(mesh.resolve())
    with naming(mesh):
        tried = Scene(**table | {"setup": robot.setup})
        best, share = best_place(tried, robot.reach, robot.base_m, deadline)
    home, posture = home_of(best)
    edge = float(part_keys["max_edge"])
    robot.keys.update(_found(best, home), spacing=f"{edge / 10:g}")
    part_keys["position"] = json.dumps(list(best.scene.placement.position_m))
    content = {
        "setup.toml": Template(SETUP).substitute(robot.keys),
        "scene.toml": Template(SCENE).substitute(part_keys),
        "tool.urdf": TOOL,
    }
    place.mkdir(parents=True, exist_ok=True)
    write([Output(place / name, kinds[name], [content[name].encode()]) for name in names])
    count = len(best.surface.vertices)
    size = f"its mesh has {count:,} vertices, with edges up to {1e3 * edge:g} mm (max_edge_m)"
    if count > 2 * _VERTICES:
        even = f"cellcolor repair {mesh} -o {mesh.stem}.obj --edge-length {edge:g}"
        size += f"; fewer suffice, since its triangles are long and thin or very small: {even}"
    assumed = [f"unit {looked.unit}: {looked.unit_reason}", side, size, posture]
    if looked.repairs:
        changes = "; ".join(looked.repairs)
        how = f"cellcolor repair {mesh} -o {mesh.stem}.obj writes that mesh"
        assumed.insert(1, f"the mesh is repaired where it is read ({changes}): {how}")
    return Started(place / "scene.toml", share, (*assumed, *_notes(best, robot, tool is None)))


@dataclass(frozen=True)
class FoundArm:
    """An arm whose family was recognized.

    Attributes:
        urdf: its file.
        tool: the tool's; None for the one that is written beside the setup.
        keys: what is filled into the setup's text.
        reach: of the arm, m.
        touching: pairs of its links that overlap in every posture.
        fixed: positions of joints that stand still, rad or m.
        base_m: its first joint in the world.
    """

    urdf: Path
    tool: Path | None
    keys: dict[str, str]
    reach: float = 0.0
    touching: tuple[tuple[str, str], ...] = ()
    fixed: Mapping[str, float] = field(default_factory=dict)
    base_m: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def setup(self) -> Setup:
        """As its file will have it; the folder of that is not there yet."""
        from cellcolor.frontend.setup import Setup

        table = tomllib.loads(Template(SETUP).substitute(self.keys))
        table["robot"]["arm_urdf"] = str(self.urdf.resolve())
        table["robot"]["tool_urdf"] = TOOL if self.tool is None else str(self.tool.resolve())
        return Setup(**table)


def arm_of(
    urdf: Path, tool: Path | None, tip: str, folder: Path, fix: Mapping[str, float]
) -> FoundArm:
    """The arm with the first family that fits it; its setup will be in the folder.

    Raises:
        InputError: none does.
    """
    from cellcolor.frontend.arm.assembly import settled
    from cellcolor.frontend.arm.kinematics import forward
    from cellcolor.frontend.arm.loading import weight_faults
    from cellcolor.frontend.arm.urdf import load_urdf
    from cellcolor.frontend.contact.engine import always_touching, pairs_of
    from cellcolor.frontend.reach.prepared_arm import prepare_arm

    arm = load_urdf(urdf)
    flange = next((link for link in _FLANGES if link in arm.above), None)
    flange = flange or max(arm.links, key=lambda link: len(arm.chain(link)))
    fixed = fixed_of(arm, flange, fix)
    with naming(urdf):
        still = settled(arm, fixed)
    chain, moving = arm.chain(flange), arm.leading.keys() - still
    moved = next((at for at, link in enumerate(chain) if at and arm.above[link].name in moving), 0)
    standing = [link for link in chain[: moved + 1] if arm.links[link].shapes]
    weightless = bool(weight_faults(arm, still))
    if tool is not None:
        own = load_urdf(tool)
        weightless |= any(link.shapes and link.weightless for link in own.links.values())
    keys = {
        "arm": urdf.name,
        "arm_urdf": json.dumps(_relative(urdf, folder)),
        "flange": json.dumps(flange),
        "mount": mount_line(arm, flange, still),
        "tool": json.dumps("tool.urdf" if tool is None else _relative(tool, folder)),
        "tip": json.dumps(tip),
        "standing": json.dumps(standing),
        "fixed": fixed_line(fixed),
        "force": "false" if weightless else "true",
        "why_force": "a URDF lacks masses or efforts" if weightless else "true or false",
        "touching": "[]",
        "spacing": "0.001",
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
        robot = prepared.robot
        x, y, z = forward(robot, np.zeros((1, robot.joints))).origin[0, 1].tolist()
        keys = found.keys | {"touching": touching}
        return FoundArm(urdf, tool, keys, reach, pairs, fixed, (x, y, z))
    fault = faults[1] if faults[1].file else faults[1].in_file(str(urdf))
    inside = [name for name in fix if name in {arm.above[link].name for link in chain[1:]}]
    if inside and "6 revolute joints" in fault.message:
        why = f"{fault.message}: --fix {inside[0]} makes a joint of the arm itself stand still"
        raise InputError(fault.file, fault.field, why)
    if "fixed_joints" in fault.message + (fault.field or ""):
        raise InputError(fault.file, fault.field, f"{fault.message} (here: --fix JOINT=POSITION)")
    raise fault


def _relative(file: Path, folder: Path) -> str:
    return Path(os.path.relpath(file.resolve(), folder.resolve())).as_posix()


def part_keys_of(
    mesh: Path,
    folder: Path,
    looked: Inspection,
    outside: Outside | None,
    cover: CoverChoice | None,
) -> tuple[dict[str, str], str]:
    """What is filled into the scene's text, and which side is covered.

    Raises:
        InputError: the mesh cannot be used, not even repaired, or has no such side.
    """
    from cellcolor.frontend.parts.mesh_file import UNITS, load_mesh

    if looked.refusal_after_repair is not None:
        raise InputError(str(mesh), None, looked.refusal_after_repair)
    unit = UNITS[looked.unit]
    surface = load_mesh(mesh, unit, mend=bool(looked.repairs))
    side, note = side_of(surface.mesh, outside, cover)
    # Halved edges are 0.7 of the longest in the mean, and there are two triangles a vertex.
    edge = math.ceil(1e3 * math.sqrt(surface.mesh.areas.sum() / (0.42 * _VERTICES))) / 1e3
    least, most = _EDGES_M
    keys = {
        "name": json.dumps(mesh.stem),
        "part": json.dumps(_relative(mesh, folder)),
        "meters_per_unit": str(unit),
        "repair": "true" if looked.repairs else "false",
        "max_edge": str(min(max(least, edge), most)),
    }
    return keys | side, note


def _found(prepared: PreparedScene, home: list[float] | None) -> dict[str, str]:
    """The keys of the setup's file that only the prepared scene tells."""
    robot = prepared.robot
    velocities = f"joint_velocities_rad_per_s = {json.dumps([1.0] * _JOINTS)}"
    if np.isnan(robot.velocity).any():
        velocities += "  # the URDF lacks them: take the data sheet's"
    else:
        velocities = f"# {velocities}  # lower than the URDF's"
    return {
        "velocities": velocities,
        "home": "# home_rad = []" if home is None else f"home_rad = {json.dumps(home)}",
        "joints": ", ".join(robot.joint_names),
    }


def _notes(prepared: PreparedScene, arm: FoundArm, own_tool: bool) -> Iterator[str]:
    from cellcolor.frontend.report import survey_of

    for joint, position in arm.fixed.items():
        yield f"{joint} stands still at {position:g} (--fix {joint}=POSITION for another one)"
    if own_tool:
        yield "tool.urdf is a polisher of 100 mm: put your tool's shape and length into it"
    for first, second in arm.touching:
        yield f"{first} and {second} overlap in every posture: setup.toml lets them touch"
    yield "setup.toml has accelerations of 5 rad/s²: take those of the arm's data sheet"
    if np.isnan(prepared.robot.velocity).any():
        yield "setup.toml has velocities of 1 rad/s, since the URDF has none"
    if not prepared.setup.constraints.force:
        yield "torques are not tested, since a URDF lacks masses or efforts"
    yield from survey_of(prepared).warnings + prepared.notes
