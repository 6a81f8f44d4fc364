"""The fewest set-ups of a part from 200 placements, on a coarse mesh.

    python benchmarks/setups.py SCENE.toml [VERTICES] [--upright] [--plan FOLDER]

The placements are the scene's own and 199 Sobol points: x and y within 0.1 and 0.15 m of it, any
yaw, three of ten upside down (``--upright``: none). VERTICES is 300 without it.
"""

from __future__ import annotations

import argparse
import math
import time
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.stats import qmc

from cellcolor.deadline import NEVER
from cellcolor.door.setting_up import ChosenSetUps
from cellcolor.frontend import Scene
from cellcolor.questions.placements import Pose
from cellcolor.questions.placing import coarse_scene
from cellcolor.questions.setting_up import candidates_of, plan_of
from cellcolor.solvers.interface import Options

PLACES = 199
UPSIDE_DOWN = 0.3


def places(scene: Scene, upright: bool) -> list[Pose]:
    """All but the scene's own."""
    x, y, z = scene.placement.position_m
    own = Rotation.from_euler("xyz", scene.placement.rpy_rad)
    found: list[Pose] = []
    for along, across, yaw, up in qmc.Sobol(4, seed=0).random_base2(8)[:PLACES].tolist():
        roll = 0.0 if upright or up >= UPSIDE_DOWN else math.pi
        turn = Rotation.from_euler("xyz", [roll, 0, 2 * math.pi * yaw]) * own
        place = x + 0.2 * (along - 0.5), y + 0.3 * (across - 0.5), z
        found.append((*place, *np.asarray(turn.as_euler("xyz")).tolist()))
    return found


def main() -> None:
    """Build, choose, print; plan where asked for."""
    given = argparse.ArgumentParser(description=__doc__)
    given.add_argument("scene")
    given.add_argument("vertices", nargs="?", type=int, default=300)
    given.add_argument("--upright", action="store_true")
    given.add_argument("--plan", type=Path)
    asked = given.parse_args()
    own = Scene.read(asked.scene)
    scene = coarse_scene(own, asked.vertices, NEVER)
    begun = time.process_time()
    found = candidates_of([scene], places(own, asked.upright), NEVER, by_hand=False)
    built = time.process_time()
    answer = plan_of(found, 1.0, None, Options(workers=1, seed=0))
    print(answer)
    print(
        f"{len(found.surfaces)} candidates of {len(found.surfaces[0].vertices)} vertices built in "
        f"{built - begun:.0f} s, chosen in {time.process_time() - built:.0f} s"
    )
    if asked.plan is not None:
        chosen = ChosenSetUps(answer, tuple(found.scenes[one.number - 1] for one in answer.set_ups))
        for number, motion in enumerate(chosen.plan(), 1):
            motion.save(asked.plan / f"set-up-{number}")
            print(f"{motion.trajectory}; judge: {motion.verdict}")


if __name__ == "__main__":
    main()
