"""The shipped robot and scenes, and how to change keys of them or of a TOML text."""

from __future__ import annotations

import re
from pathlib import Path

from cellcolor.frontend.scene import Scene
from cellcolor.frontend.tables import Table

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


def shipped(name: str, vertices: int | None = None) -> Scene:
    """A shipped scene, with about so many vertices."""
    scene = Scene.read(SCENES / f"{name}.toml")
    return scene if vertices is None else scene.varied(object={"target_vertices": vertices})


def with_keys(table: Table, **keys: object) -> Table:
    """A scene or setup with keys changed in whichever of its tables has them."""
    inner = {name: getattr(table, name) for name in type(table).model_fields}
    changes: dict[str, dict[str, object]] = {}
    for key, value in keys.items():
        (place,) = [n for n, t in inner.items() if isinstance(t, Table) and hasattr(t, key)]
        changes.setdefault(place, {})[key] = value
    return table.varied(**changes)


def wok_file(folder: Path, setup: dict[str, object] | None = None, **keys: object) -> Path:
    """A variant of the wok as a file in a folder, beside its setup.

    ``setup`` replaces keys of the setup's text, and the other names those of the scene's.
    """
    for name in ("ur5.urdf", "polishing_tool.urdf", "ur5_polishing.toml"):
        text = (ROBOTS / name).read_text()
        if name == "ur5_polishing.toml":
            text = edited(text, **(setup or {}))
        (folder / name).write_text(text)
    file = folder / "scene.toml"
    file.write_text(edited(WOK.read_text(), **({"setup": '"ur5_polishing.toml"'} | keys)))
    return file
