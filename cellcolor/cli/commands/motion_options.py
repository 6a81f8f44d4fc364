"""The options of ``cellcolor plan`` that stand for keys of a setup's table ``[motion]``."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import click


class _Number(click.ParamType):  # type: ignore[type-arg]
    """A finite number."""

    name = "number"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        try:
            number = float(value)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            self.fail(f"{value!r} is not a number.", param, ctx)
        return number


class _Numbers(_Number):
    """A number for each joint, from base to tool, with commas between."""

    name = "numbers"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        if isinstance(value, tuple):
            return value
        return tuple(_Number.convert(self, part, param, ctx) for part in value.split(","))


_KEYS = {
    "tool_radius_m": "Of the tool's footprint, m.",
    "spacing_m": "Between neighboring passes, m.",
    "speed_m_per_s": "Of the tool on the surface, m/s; slower where joints limit it.",
    "joint_velocities_rad_per_s": "Lower limits than the URDF's, rad/s (m/s for sliding joints).",
    "joint_accelerations_rad_per_s2": "A URDF has none; rad/s² (m/s² for sliding joints).",
    "retract_m": "Along the normal, before a move to another stroke, m.",
    "clearance_m": "Distance from everything between strokes, m.",
    "home_rad": "Where the arm begins and ends, rad (m for sliding joints).",
}
"""What each key means. The setup says what may be left out, and checks the numbers."""


def motion_options(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command one option for each key; those left out are None."""
    for key, meaning in reversed(_KEYS.items()):
        several = key.startswith("joint") or key == "home_rad"
        command = click.option(
            f"--{key.replace('_', '-')}",
            key,
            metavar="N,N,…" if several else "N",
            type=_Numbers() if several else _Number(),
            help=meaning,
        )(command)
    return command
