"""Which arm needs the fewest lift-offs for a part? Each arm first gets the place where most of the
part can be reached, with the setup that ``cellcolor new`` begins with."""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import cellcolor

TOP = Path(__file__).parents[1]
PART = Path(sys.argv[1]) if len(sys.argv) > 1 else TOP / "instances" / "parts" / "saddle.obj"
ARMS = sys.argv[2:] or [
    str(TOP / "models" / "robots" / f"{name}.urdf") for name in ("ur3e", "ur5e")
]

for arm in ARMS:
    with TemporaryDirectory() as folder:
        try:
            cellcolor.new(PART, arm, folder)
            result = cellcolor.solve(Path(folder) / "scene.toml", time_limit=60)
        except cellcolor.InputError as error:  # such as a part that is out of reach
            print(f"{Path(arm).stem}: {error}")
            continue
        print(f"{Path(arm).stem}: {result}")
