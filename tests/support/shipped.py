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
