"""The page on the house has every room, on the floor where the import contracts have it."""

from __future__ import annotations

import pkgutil
import re
import tomllib
from pathlib import Path

import cellcolor

ROOT = Path(__file__).resolve().parents[2]


def test_rooms_stand_on_the_floors_of_the_contracts() -> None:
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]
    (layers,) = [
        contract["layers"]
        for contract in contracts["contracts"]
        if contract["name"].startswith("The floors of the house")
    ]
    kept = {
        room: floor
        for floor, layer in enumerate(reversed(layers))
        for room in re.findall(r"[\w.]+", layer)
    }
    page = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    told = re.findall(r"^\| (\d+) \| `(cellcolor\.\w+)` \|", page, re.MULTILINE)
    assert {room: int(floor) for floor, room in told} == kept
    assert len(told) == len(kept)
    rooms = {module.name for module in pkgutil.iter_modules(cellcolor.__path__, "cellcolor.")}
    assert set(kept) == rooms - {"cellcolor.__main__"}
