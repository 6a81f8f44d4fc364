"""Draw tool paths: ``python docs/figures/straight_lines.py BEFORE NOW SPIRAL``.

These are folders in which ``cellcolor plan square`` and ``cellcolor plan wok`` have written
``square/paths.json`` and ``wok/paths.json``, the last ones with ``--pattern spiral``. They are seen
from above. The picture of docs/measured/motions.md has BEFORE from commit aa0319a.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

ROWS = {"square": (0.21, 0.33, 0.29, 0.41), "wok": (0.40, 0.52, -0.30, -0.18)}
"""What is drawn of each part: 120 mm, from and to in m along x and y."""
COLUMNS = ("before", "now", "now, spiral")


def main(folders: list[Path]) -> None:
    """One row for each part, a column for each folder."""
    figure, axes = plt.subplots(2, 3, figsize=(12, 8.2), layout="constrained")
    for row, (name, (left, right, low, high)) in zip(axes, ROWS.items(), strict=True):
        for place, folder, when in zip(row, folders, COLUMNS, strict=True):
            paths = json.loads((folder / name / "paths.json").read_text())["paths"]
            for path, color in zip(paths, ("#1f5fa8", "#c8553d"), strict=False):
                x, y, _ = np.array(path["points"]).T
                place.plot(x, y, color=color, linewidth=0.8)
            place.set(xlim=(left, right), ylim=(low, high), xticks=[], yticks=[], aspect="equal")
            place.set_title(f"{name}, {when}", fontsize=10)
    figure.savefig(Path(__file__).parent / "straight-lines.png", dpi=110)


if __name__ == "__main__":
    main([Path(text) for text in sys.argv[1:4]])
