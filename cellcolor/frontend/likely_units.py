"""Millimeters taken for meters: found by comparing lengths with the arm and the part.

Every length of a scene and its setup is in meters. One that only makes sense in millimeters is
refused by an :class:`~cellcolor.errors.InputError` that names the key and what was probably meant,
before anything is computed with it. Angles in degrees are refused where a table is read
(:mod:`cellcolor.frontend.tables`).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.wording import in_meters, looks_like_degrees, looks_like_millimeters
from cellcolor.errors import InputError
from cellcolor.frontend.contact.obstacle import HalfSpaceObstacle
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Motion, Setup

_REACHES = 20  # a wing of 10 m is a part; what is larger than this, or as far away, is none
_FASTEST = 15.0  # m/s; the fastest pick-and-place robots stay below
_QUICKEST = 100.0  # rad/s²; joints of small arms reach 30 to 50
_PLAUSIBLE = 0.2  # of the reach: a tool of that radius is a large one


def check_part(part: Surface, scene: Scene, reach: float, base: Array) -> None:
    """Reject a part that is far too large for an arm, or far too distant.

    Args:
        part: in the world, m.
        scene: that it is from.
        reach: of the arm, m.
        base: (3,) where the arm's base stands in the world, m.
    """
    extents = np.ptp(part.vertices, axis=0)
    largest = float(extents.max())
    if largest > _REACHES * reach:
        field, meant = _unit_of(scene)
        message = (
            f"the part is {in_meters(extents.tolist())}, {largest / reach:.0f} times the arm's "
            f"reach ({reach:.3g} m): {meant}"
        )
        raise InputError(None, field, message)
    away = float(np.linalg.norm(part.vertices - base, axis=1).min())
    if away > _REACHES * reach:
        place = np.array(scene.placement.position_m)
        far = f"the part is {away:.3g} m from the robot's base, {away / reach:.0f} times the arm's "
        far += f"reach ({reach:.3g} m)"
        if np.linalg.norm(place) > away / 2:
            message = f"{far}: {looks_like_millimeters(*place)}"
            raise InputError(None, "placement.position_m", message)
        raise InputError(None, "object", f"{far}: its own coordinates are that far from its origin")


def _unit_of(scene: Scene) -> tuple[str, str]:
    """The key that gives a part its size, and what it was probably meant to be."""
    part = scene.object
    unit = getattr(part, "meters_per_unit", None)
    if unit is not None:
        return "object.meters_per_unit", f"{unit / 1000:g} if the file is in millimeters"
    given = {name: getattr(part, name) for name in type(part).model_fields if name.endswith("_m")}
    sizes = {name: size for name, size in given.items() if isinstance(size, (int, float))}
    if not sizes:
        return "object", "are its coordinates in millimeters?"
    largest = max(sizes, key=lambda name: sizes[name])
    return f"object.{largest}", looks_like_millimeters(sizes[largest])


def check_setup(setup: Setup, part: Surface, scene: Scene, reach: float) -> None:
    """Reject lengths of a setup that exceed the part, or margins beyond the arm's reach."""
    spacings = ("probe_spacing_m", "validity_spacing_m")
    lengths = {"task.contact_radius_m": setup.task.contact_radius_m}
    lengths |= {f"continuity.{name}": getattr(setup.continuity, name) for name in spacings}
    _no_larger_than_part(lengths, part, scene, reach)
    margins = {f"margins.{name}": value for name, value in setup.margins.model_dump().items()}
    _within_reach(margins, reach)


def check_motion(motion: Motion, part: Surface, scene: Scene, reach: float) -> None:
    """Reject lengths of the table ``[motion]`` in the same way."""
    widths = {"motion.tool_radius_m": motion.tool_radius_m, "motion.spacing_m": motion.spacing_m}
    _no_larger_than_part(widths, part, scene, reach)
    lengths = {"motion.retract_m": motion.retract_m, "motion.clearance_m": motion.clearance_m}
    _within_reach(lengths, reach)
    for name in ("speed_m_per_s", "approach_speed_m_per_s", "transfer_speed_m_per_s"):
        speed = getattr(motion, name)
        if speed is not None and speed > _FASTEST:
            message = f"no arm moves its tool that fast: {looks_like_millimeters(speed)}"
            raise InputError(None, f"motion.{name}", message)


def _no_larger_than_part(
    lengths: Mapping[str, float | None], part: Surface, scene: Scene, reach: float
) -> None:
    extents = np.ptp(part.vertices, axis=0)
    size = in_meters(extents.tolist())
    for field, length in lengths.items():
        if length is not None and length > np.linalg.norm(extents):
            if length < _PLAUSIBLE * reach:  # then it is the part that is too small
                unit = getattr(scene.object, "meters_per_unit", None)
                key = "object" if unit is None else "object.meters_per_unit"
                meant = "in meters already" if unit is None else f"{1000 * unit:g}"
                message = f"the part is {size}, less than {field} ({length:g} m): {meant}?"
                raise InputError(scene.file, key, message)
            message = f"larger than the part ({size}): {looks_like_millimeters(length)}"
            raise InputError(None, field, message)


def _within_reach(lengths: dict[str, float], reach: float) -> None:
    for field, length in lengths.items():
        if length > reach:
            message = f"is more than the arm's reach ({reach:.3g} m)"
            raise InputError(None, field, f"{message}: {looks_like_millimeters(length)}")


def notes_on_units(scene: Scene, reach: float) -> tuple[str, ...]:
    """What was perhaps given in millimeters or degrees, and does no harm, one sentence each."""
    found, motion = [], scene.setup.motion
    quickest = max(() if motion is None else motion.joint_accelerations_rad_per_s2, default=0.0)
    if quickest > _QUICKEST:
        meant = f"{looks_like_degrees(quickest)} (per s²; no joint is known to reach more than 50)"
        found.append(f"motion.joint_accelerations_rad_per_s2: {meant}")
    if scene.ground is not None and abs(scene.ground.height_m) > _REACHES * reach:
        found.append(f"ground.height_m: {looks_like_millimeters(scene.ground.height_m)}")
    for number, obstacle in enumerate(scene.obstacle):
        if isinstance(obstacle, HalfSpaceObstacle):
            continue  # which has no place: a wall goes through any point of it
        vertices, _ = obstacle.shell(scene.folder)
        nearest = float(np.linalg.norm(obstacle.placed(vertices), axis=1).min())
        if nearest > _REACHES * reach:
            meant = looks_like_millimeters(*obstacle.position_m)
            found.append(f"obstacle[{number}].position_m: {meant}")
    return tuple(found)
