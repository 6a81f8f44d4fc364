"""What ``cellcolor.new`` finds out about an arm: family, flange, joints that stand still."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING

import numpy as np

from cellcolor.door.starting_texts import SETUP, TOOL, relative
from cellcolor.errors import InputError, naming

if TYPE_CHECKING:
    from cellcolor.frontend.arm.urdf import Urdf
    from cellcolor.frontend.reach.prepared_arm import PreparedArm
    from cellcolor.frontend.setup import Setup

_FLANGES = ("tool0", "flange", "ee_link", "wrist_3_link", "tool_flange")
_FAMILIES = ("ur", "eaik", "offset-wrist")  # the second says most about an arm that fits none
_ALONG = 1e-3  # rad; an axis so near to another one is along it
_OFF, _MOST_OFF = 1e-6, 1e-3  # m; a flange so far beside the last axis was measured, not meant


def arm_of(
    urdf: Path, tool: Path | None, tip_link: str, folder: Path, fix: Mapping[str, float]
) -> tuple[dict[str, str], PreparedArm]:
    """What is filled into the setup's text, with the first family that fits, and the arm.

    Args:
        tool: its file; None for the one that is written beside the setup, with a tip of its own.
        folder: of the setup; it is not there yet.

    Raises:
        InputError: no family fits.
    """
    from cellcolor.frontend.arm.loading import settled, weight_faults
    from cellcolor.frontend.arm.urdf import load_urdf
    from cellcolor.frontend.contact.engine import always_touching, pairs_of
    from cellcolor.frontend.reach.prepared_arm import prepare_arm

    arm = load_urdf(urdf)
    flange = next((link for link in _FLANGES if link in arm.above), None)
    flange = flange or max(arm.links, key=lambda link: len(arm.chain(link)))
    chain = arm.chain(flange)
    in_chain = [arm.above[link].name for link in chain[1:]]
    fixed = _fixed_of(arm, in_chain, fix)
    with naming(urdf):
        still = settled(arm, fixed)
    moved = next((at for at, name in enumerate(in_chain, 1) if name in still.leading), 0)
    weightless = bool(weight_faults(still))
    if tool is not None:
        own = load_urdf(tool)
        weightless |= any(link.shapes and link.weightless for link in own.links.values())
    position, turn = mount_of(still, flange)
    keys = {
        "arm": urdf.name,
        "arm_urdf": json.dumps(relative(urdf, folder)),
        "flange": json.dumps(flange),
        "tool": json.dumps("tool.urdf" if tool is None else relative(tool, folder)),
        "tip": json.dumps("tip" if tool is None else tip_link),
        "mount_at": json.dumps(position),
        "mount_turned": json.dumps(turn),
        "standing": json.dumps([link for link in chain[: moved + 1] if arm.links[link].shapes]),
        "fixed": ", ".join(f"{json.dumps(name)} = {at!r}" for name, at in fixed.items()),
        "force": "false" if weightless else "true",
        "touching": "[]",
        "spacing": "0.001",
        "velocities": "",
        "joints": "",
        "home": '"free"',
    }
    faults: list[InputError] = []
    for family in _FAMILIES:
        keys["family"] = json.dumps(family)
        try:
            prepared = prepare_arm(_setup_of(keys, urdf, tool))
        except InputError as error:
            faults.append(error)
            continue
        # Before a place is sought: with such a pair tested, the arm could stand nowhere.
        touching = always_touching(prepared.robot, pairs_of(prepared.robot))
        keys["velocities"] = "" if np.isnan(prepared.robot.velocity).any() else "# "
        keys["joints"] = ", ".join(prepared.robot.joint_names)
        keys["touching"] = json.dumps([list(pair) for pair in touching])
        return keys, replace(prepared, setup=_setup_of(keys, urdf, tool))
    fault, inside = faults[1], [name for name in fix if name in in_chain]
    message = fault.message
    if inside and "6 revolute joints" in message:
        message += f": --fix {inside[0]} makes a joint of the arm itself stand still"
    elif "fixed_joints" in message + (fault.field or ""):
        message += " (here: --fix JOINT=POSITION)"
    raise InputError(fault.file or urdf, fault.field, message)


def _setup_of(keys: dict[str, str], urdf: Path, tool: Path | None) -> Setup:
    from cellcolor.frontend.setup import Setup

    table = tomllib.loads(Template(SETUP).substitute(keys))
    table["robot"]["arm_urdf"] = str(urdf.resolve())
    table["robot"]["tool_urdf"] = TOOL if tool is None else str(tool.resolve())
    return Setup(**table)


def _fixed_of(arm: Urdf, in_chain: Sequence[str], given: Mapping[str, float]) -> dict[str, float]:
    """The positions of joints that stand still: those given, rails, and what is beside the chain.

    Where none is given, the one nearest to zero.
    """
    from cellcolor.frontend.arm.urdf import PRISMATIC

    fixed = dict(given)
    for name, joint in arm.leading.items():
        if name not in fixed and (joint.kind == PRISMATIC or name not in in_chain):
            fixed[name] = float(np.clip(0.0, joint.lower, joint.upper))
    return fixed


def mount_of(arm: Urdf, flange: str) -> tuple[list[float], list[float]]:
    """Position, m, and turn, rad, that put the tool's z axis onto the last joint's.

    Some vendors' flanges have their x axis along that of the joint, or lie a little beside it.

    Args:
        arm: with all joints fixed that stand still.
    """
    from cellcolor.frontend.arm.loading import last_axis
    from cellcolor.frontend.parts.placement import rpy_from_rotation

    (x, y, z), beside = last_axis(arm, flange)
    measured = _OFF < np.linalg.norm(beside) < _MOST_OFF
    if np.hypot(x, y) < _ALONG:
        turn = np.diag([1, np.sign(z), np.sign(z)])
    else:  # about the axis across both
        cross = np.array([[0, 0, x], [0, 0, y], [-x, -y, 0]])
        turn = np.eye(3) + cross + cross @ cross / (1 + z)
    position = [round(-along, 9) + 0.0 if measured else 0.0 for along in beside.tolist()]
    return position, [round(angle, 9) + 0.0 for angle in rpy_from_rotation(turn)]
