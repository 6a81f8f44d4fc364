"""Where the shipped robot and scenes are, and how to change keys of a TOML text."""

from __future__ import annotations

import re
from pathlib import Path

TOP = Path(__file__).parents[2]
ROBOTS = TOP / "models" / "robots"
SCENES = TOP / "instances" / "scenes"
WOK = SCENES / "wok.toml"


def edited(text: str, **values: object) -> str:
    """TOML text with the values of some keys replaced; every key has to be there."""
    for key, value in values.items():
        text, found = re.subn(rf"^{key} = [^#\n]*", f"{key} = {value} ", text, flags=re.MULTILINE)
        assert found == 1, key
    return text


def at_resolution(name: str, folder: Path, vertices: int) -> Path:
    """A shipped scene with about so many vertices, as a file in the folder."""
    text = edited(
        (SCENES / f"{name}.toml").read_text(),
        setup=f'"{(ROBOTS / "ur5_polishing.toml").as_posix()}"',
        target_vertices=vertices,
    )
    file = folder / "scene.toml"
    file.write_text(text)
    return file
