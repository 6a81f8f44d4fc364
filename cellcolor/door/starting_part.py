"""What ``cellcolor.new`` chooses of a part: its unit, the side to cover, and the mesh."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from cellcolor.door.starting_texts import relative
from cellcolor.errors import InputError

if TYPE_CHECKING:
    from cellcolor.arrays import Array, Mask
    from cellcolor.frontend.parts.inspection import Inspection
    from cellcolor.mesh.triangle_mesh import TriangleMesh

CoverChoice = Literal["largest", "all"]
Outside = Literal["toward", "away", "flip"]

VERTICES = 2500
"""The longest edges are as long as gives so many vertices, within the following lengths."""
_EDGES_M = (0.01, 0.1)
_TOWARD = np.array([-1.0, 0.0, 1.0]) / np.sqrt(2)  # the part lies before the robot: up and back
_UPRIGHT, _AWRY = 0.5, 0.35  # how far the mean of normals leans; rad: less is not turned
_ANY_WAY = 0.2  # the mean of the unit normals of what faces every way is shorter
_LARGER = 1.02  # times the inner side's area has a shell's outer one, if it is bent
_WAYS = {
    "towards the robot": (-1, 0, 0),
    "away from it": (1, 0, 0),
    "left": (0, 1, 0),
    "right": (0, -1, 0),
    "up": (0, 0, 1),
    "down": (0, 0, -1),
}


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
    from cellcolor.frontend.parts.mesh_file import UNITS, MeshObject

    if looked.refusal_after_repair is not None:
        raise InputError(mesh, None, looked.refusal_after_repair)
    unit = UNITS[looked.unit]
    part = MeshObject(file=str(mesh), meters_per_unit=unit, repair=bool(looked.repairs))
    surface = part.surface()
    side, note = _side_of(surface.mesh, outside, cover)
    # Halved edges are 0.7 of the longest in the mean, and there are two triangles a vertex.
    edge = math.ceil(1e3 * math.sqrt(surface.mesh.areas.sum() / (0.42 * VERTICES))) / 1e3
    least, most = _EDGES_M
    keys = {
        "name": json.dumps(mesh.stem),
        "part": json.dumps(relative(mesh, folder)),
        "meters_per_unit": str(unit),
        "repair": "true" if looked.repairs else "false",
        "max_edge": str(min(max(least, edge), most)),
    }
    return keys | side, note


def _side_of(
    mesh: TriangleMesh, outside: Outside | None, cover: CoverChoice | None
) -> tuple[dict[str, str], str]:
    """The side that is asked for, or the likely one; an upright one is turned to face the robot.

    Of a shell the likely one is the outer one, or the one that faces up; of any other part all of
    it, as its faces are wound.

    Args:
        mesh: the part as its file has it, m.

    Returns:
        What is filled into the scene's text, and what to say.

    Raises:
        InputError: the part has no such side.
    """
    from cellcolor.frontend.parts.cover import facing, pieces, shell_sides, thickness

    keys = {"flip": "false", "cover": "", "rpy": "[0.0, 0.0, 0.0]"}
    thick, is_open = thickness(mesh), bool(mesh.border.any())
    sides = None if thick is None or cover == "all" else shell_sides(mesh)
    if thick is not None and sides is not None:
        chosen, name, other = _of_shell(mesh, sides, outside)
        keys["cover"], mean = _cover(mesh, sides[chosen]), facing(mesh, sides[chosen])
        note = (
            f"the part is a shell, {1e3 * thick:.2g} mm thick: its {name}, which faces "
            f"{_way(mean)}, is covered ({other} for the other one, --cover all for both)"
        )
    else:
        flip = _flipped(mesh, outside)
        mean, note = facing(mesh) * (-1 if flip else 1), "all of the part is covered"
        keys["flip"] = json.dumps(flip)
        if cover == "largest" and not (largest := pieces(mesh)[0]).all():
            keys["cover"] = _cover(mesh, largest)
            note = "the largest piece between sharp edges is covered"
        if is_open:
            wound = "turned over, its outside" if flip else "as its faces are wound, its outside"
            other = "without --outside" if flip else "--outside flip"
            note += f"; {wound} faces {_way(mean)} ({other} for the other side)"
        elif thick is not None:
            note += f", both sides of a shell {1e3 * thick:.2g} mm thick ([cover] chooses one)"
    yaw = round(float(np.angle(-(mean[0] - 1j * mean[1]))), 4)
    upright = outside != "away" and np.hypot(mean[0], mean[1]) > _UPRIGHT
    if (is_open or sides is not None) and upright and abs(yaw) > _AWRY:
        keys["rpy"] = json.dumps([0.0, 0.0, yaw])
        note += f"; turned by {np.degrees(yaw):.0f} degrees, it faces the robot"
    return keys, note


def _of_shell(
    mesh: TriangleMesh, sides: list[Mask], outside: Outside | None
) -> tuple[int, str, str]:
    """Which of the two sides of a shell is covered, its name, and how to ask for the other one.

    Without a wish that is the outer one; of a flat shell the one that faces up and to the robot.
    """
    from cellcolor.frontend.parts.cover import facing

    first, second = (facing(mesh, side) @ _TOWARD for side in sides)
    outer, inner = (float(mesh.areas[side].sum()) for side in sides)
    bent, toward = outer > _LARGER * inner, int(second > first)
    usual = 0 if bent else toward
    chosen = {None: usual, "toward": toward, "away": 1 - toward, "flip": 1 - usual}[outside]
    name = ("outer side", "inner side")[chosen] if bent else "side"
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
    from cellcolor.frontend.parts.cover import SHARP_RAD

    largest = np.argmax(np.where(faces, mesh.areas, 0.0))
    middle = mesh.points[mesh.corners[largest]].mean(axis=0)
    seed = [round(x, 6) + 0.0 for x in middle.tolist()]
    return (
        "\n# The faces around a point, up to sharp edges; the rest must only not be hit.\n"
        f"[cover]\nregion = {{ seed_m = {json.dumps(seed)}, sharp_rad = {SHARP_RAD} }}\n"
    )


def _way(mean: Array) -> str:
    """Where a mean of normals points, for one who stands at the robot."""
    if np.linalg.norm(mean) < _ANY_WAY:
        return "every way"
    return max(_WAYS, key=lambda name: float(mean @ _WAYS[name]))
