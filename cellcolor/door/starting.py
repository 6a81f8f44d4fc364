"""``cellcolor.new``: a first scene and setup, from a part's mesh and an arm's URDF."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING

import numpy as np

from cellcolor.deadline import Deadline, TimeLimit
from cellcolor.door.installed import require_motion
from cellcolor.door.parts import inspect
from cellcolor.door.starting_arm import arm_of
from cellcolor.door.starting_part import VERTICES, CoverChoice, Outside, part_keys_of
from cellcolor.door.starting_place import best_place, home_over
from cellcolor.door.starting_texts import MARK, SCENE, SETUP, TOOL
from cellcolor.errors import naming, system_errors
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

_NEEDED = ("pinocchio", "fcl", "igl", "trimesh", "scipy")

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
        unit: ``m``, ``mm``, ``cm`` or ``in``, of the mesh; None for the likely one.
        outside: of an open part, the side that faces ``toward`` the robot or ``away`` from it, or
            ``flip``, the other one than its faces have; of a shell, the side that is covered.
        cover: the ``largest`` piece between sharp edges, or ``all``; None for one side of a shell,
            all of other parts.
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

    tell("the arm")
    given = None if tool is None else path_of(tool)
    setup_keys, prepared = arm_of(urdf, given, tip_link, place, fix or {})
    tell("the part")
    looked = inspect(mesh, unit=unit, time_limit=deadline)
    part_keys, side = part_keys_of(mesh, place, looked, outside, cover)
    tell("where the part can stand")
    table = tomllib.loads(Template(SCENE).substitute(part_keys, position="[0.0, 0.0, 0.0]"))
    table["object"]["file"] = str(mesh.resolve())
    with naming(mesh):
        scene = Scene(**table | {"setup": prepared.setup})
        best, verdicts = best_place(scene, prepared, deadline)
    home = home_over(best, verdicts.valid.mean(axis=0))
    edge = float(part_keys["max_edge"])
    setup_keys["spacing"] = f"{edge / 10:g}"
    if home is not None:
        setup_keys["home"] = json.dumps(home[0])
    part_keys["position"] = json.dumps(list(best.scene.placement.position_m))
    content = {
        "setup.toml": Template(SETUP).substitute(setup_keys),
        "scene.toml": Template(SCENE).substitute(part_keys),
        "tool.urdf": TOOL,
    }
    with system_errors(place, "cannot be made"):
        place.mkdir(parents=True, exist_ok=True)
    write([Output(place / name, kinds[name], [content[name].encode()]) for name in names])
    where = "near the middle of its limits: none over the part is free"
    notes = (
        *_on_part(mesh, looked, side, len(best.surface.vertices), edge),
        f"the arm begins and ends {where if home is None else home[1]}",
        *_on_arm(best, tool is None),
    )
    return Started(place / "scene.toml", float(verdicts.valid.any(axis=1).mean()), notes)


def _on_part(mesh: Path, looked: Inspection, side: str, count: int, edge: float) -> Iterator[str]:
    """What was assumed of the part, whose mesh has so many vertices with edges up to ``edge`` m."""
    repair = f"cellcolor repair {mesh} -o {mesh.stem}.obj"
    yield f"unit {looked.unit}: {looked.unit_reason}"
    if looked.repairs:
        changes = "; ".join(looked.repairs)
        yield f"the mesh is repaired where it is read ({changes}): {repair} writes that mesh"
    yield side
    size = f"its mesh has {count:,} vertices, with edges up to {1e3 * edge:g} mm (max_edge_m)"
    if count > 2 * VERTICES:
        even = f"{repair} --edge-length {edge:g}"
        size += f"; fewer suffice, since its triangles are long and thin or very small: {even}"
    yield size


def _on_arm(prepared: PreparedScene, own_tool: bool) -> Iterator[str]:
    """What was assumed of the arm and its tool, and what is likely to be wrong."""
    from cellcolor.frontend.report import survey_of

    robot = prepared.setup.robot
    for joint, position in robot.fixed_joints.items():
        yield f"{joint} stands still at {position:g} (--fix {joint}=POSITION for another one)"
    if own_tool:
        yield "tool.urdf is a polisher of 100 mm: put your tool's shape and length into it"
    for first, second in robot.may_touch:
        yield f"{first} and {second} overlap in every posture: setup.toml lets them touch"
    yield "setup.toml has accelerations of 5 rad/s²: take those of the arm's data sheet"
    if np.isnan(prepared.robot.velocity).any():
        yield "setup.toml has velocities of 1 rad/s, since the URDF has none"
    if not prepared.setup.constraints.force:
        yield "torques are not tested, since a URDF lacks masses or efforts"
    yield from survey_of(prepared).warnings + prepared.notes
