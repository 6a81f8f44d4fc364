"""Thresholds as shares of the cube of the reach mean the same for small arms and large ones."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from reasons import Reason
from shipped import ROBOTS

from cellcolor.errors import InputError
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.scene import Scene

Varied = Callable[..., Scene]
# The manufacturer's reach of UR3, UR5 and UR10, 0.5, 0.85 and 1.3 m, against the UR5's.
ARMS = {"UR3": 0.5 / 0.85, "UR5": 1.0, "UR10": 1.3 / 0.85}
SHARES = {
    "min_manipulability": 0.03,
    "min_task_determinant": 0.0023,
    "near_singular_determinant": 0.0029,
}
NUMBER = r"-?\d+(?:\.\d+)?(?:e-?\d+)?"


def scaled(text: str, size: float) -> str:
    """A URDF with all lengths multiplied."""

    def times(found: re.Match[str]) -> str:
        numbers = re.sub(NUMBER, lambda n: repr(size * float(n.group())), found.group(2))
        return f'{found.group(1)}"{numbers}"'

    # Axes are directions, not lengths.
    parts = re.split(r"(<axis[^>]*>)", text)
    return "".join(
        part
        if part.startswith("<axis")
        else re.sub(r'\b(xyz=|radius=|length=)"([^"]*)"', times, part)
        for part in parts
    )


def reasons(scene: Varied, size: float, shares: bool) -> NDArray[np.uint8]:
    """Of all candidates: the wok and the shipped arm, all lengths so many times as large.

    The force is left out: masses and torques would have to grow in their own ways.
    """
    tool = scaled((ROBOTS / "polishing_tool.urdf").read_text(), size)
    thresholds = SHARES | {f"{name}_m3": None for name in SHARES} if shares else {}
    wok = scene(
        arm=lambda text: scaled(text, size),
        setup={"tool_urdf": tool, "force": False} | thresholds,
        radius_m=0.2 * size,
        position_m=(0.465 * size, -0.15 * size, -0.04 * size),
        target_vertices=300,
    )
    prepared = prepare(wok)
    candidates = prepared.arm.inverse(prepared.surface.vertices, -prepared.surface.normals)
    return prepared.judge(candidates.reshape(-1, 6)).reasons


def conditioned(found: NDArray[np.uint8]) -> int:
    return int(((found == Reason.MANIPULABILITY) | (found == Reason.TASK_DETERMINANT)).sum())


def test_shares_mean_the_same_for_every_size(scene: Varied) -> None:
    found = {name: reasons(scene, size, shares=True) for name, size in ARMS.items()}
    assert conditioned(found["UR5"]) > 50
    for other in found.values():
        # Exact but for what lies within rounding of a limit.
        assert np.mean(other == found["UR5"]) > 0.999


@pytest.mark.parametrize("name", SHARES)
def test_each_threshold_once(name: str, scene: Varied) -> None:
    key, table = f"{name}_m3", "continuity" if name.startswith("near") else "thresholds"
    for faulty in ({key: None}, {name: 0.1}):
        with pytest.raises(InputError, match=f"give either {name} or {key}") as caught:
            scene().setup.varied(**{table: faulty})
        assert caught.value.field == table
