"""Which arm suits a part: the same part before several arms, each with the best place found.

Each arm gets the setup that cellcolor.new begins with, so all have the same polisher.
"""

import sys
import tempfile
from pathlib import Path

import cellcolor

FOLDER = Path(__file__).parents[1]
PART = sys.argv[1] if len(sys.argv) > 1 else FOLDER / "instances" / "parts" / "saddle.obj"
ARMS = sys.argv[2:] or [FOLDER / "models" / "robots" / f"{arm}.urdf" for arm in ("ur5e", "kr6")]
COVER, TRIED = 0.2, 4  # share of the part's surface; places, of which a real question needs 128

for arm in map(Path, ARMS):
    begun = cellcolor.new(PART, arm, Path(tempfile.mkdtemp()) / arm.stem)
    x, y, z = cellcolor.read(begun.scene).placement.position_m
    around = {"x": (x - 0.1, x + 0.1), "y": (y - 0.1, y + 0.1), "z": (z, z + 0.2)}
    placed = cellcolor.place(begun.scene, **around, cover=COVER, points=TRIED, best=1, vertices=60)
    for best in placed.best or (placed.here,):
        print(f"{arm.stem}: {best}")
        scene = cellcolor.read(begun.scene).moved(position_m=best.pose[:3], rpy_rad=best.pose[3:])
        for point in cellcolor.tradeoff(scene, time_limit=120):
            print(f"  {point}")
