"""Draw the shipped scenes and parts for the docs: ``python docs/figures/scenes.py [FOLDER]``.

Each picture is what ``cellcolor show`` draws of an instance and its solution, made small.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image

from cellcolor.cli import main as cellcolor

INSTANCES = Path(__file__).resolve().parents[2] / "instances"
SCENES, PARTS = INSTANCES / "scenes", INSTANCES / "parts"
NAMES = ("hemisphere_flat", "hemisphere_tilted", "half_pipe", "wok", "wok_obstacle", "square")
PART_NAMES = ("bracket", "blend", "saddle", "perforated_sheet", "sphere", "torus")
WIDTH, PART_WIDTH = 1000, 700  # pixels


def main(folder: Path) -> None:
    """Draw each scene and part by segment, and the wok by cell and as a graph too."""
    with TemporaryDirectory() as work:
        for name in NAMES:
            instance, solution = SCENES / f"{name}.json", Path(work) / f"{name}.solution.json"
            run("solve", instance, "-o", solution)
            show(folder / f"scene-{name}.png", instance, solution)
        show(folder / "wok-cells.png", SCENES / "wok.json")
        show(folder / "wok-graph.png", SCENES / "wok.json", "--view", "graph")
        for name in PART_NAMES:
            instance, solution = Path(work) / f"{name}.json", Path(work) / f"{name}.solution.json"
            run("build", PARTS / f"{name}.toml", "-o", instance)
            run("solve", instance, "-o", solution)
            show(folder / f"part-{name}.png", instance, solution, width=PART_WIDTH)


def show(target: Path, *what: Path | str, width: int = WIDTH) -> None:
    """A picture of ``cellcolor show``, made small."""
    with TemporaryDirectory() as work:
        run("show", *what, "-o", Path(work) / "large.png")
        large = Image.open(Path(work) / "large.png").convert("RGB")
    size = (width, round(width * large.height / large.width))
    small = large.resize(size, Image.Resampling.LANCZOS)
    small.quantize(256, kmeans=2, dither=Image.Dither.NONE).save(target, optimize=True)


def run(*arguments: Path | str) -> None:
    """A command that has to succeed."""
    if code := cellcolor([str(argument) for argument in arguments]):
        sys.exit(f"cellcolor {' '.join(map(str, arguments))} ended with exit code {code}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent)
