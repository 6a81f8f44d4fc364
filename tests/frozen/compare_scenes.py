"""Build the shipped scenes again and compare what comes out with what is frozen.

    python tests/frozen/compare_scenes.py [SCENE …]        scenes such as scenes/wok.toml

Run it in the root of the checkout that is to be compared, with the Python in which that checkout is
installed. It prints a line for each difference, and its exit code is 1 if there is one. It knows
nothing of cellcolor but the command ``build`` and the files that this writes. Colors, branches and
reasons are compared by their names, cells by their vertices, edges by their cells.
"""

from __future__ import annotations

import hashlib
import json
import lzma
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np

FROZEN = Path(__file__).with_name("frozen_scenes.json.xz")
SAME = ("vertices", "faces", "cells", "coverage", "mesh_sha256", "surface_sha256", "loops", "edges")


def built(scene: Path) -> dict[str, Any]:
    """All that is frozen of a scene, or why it is refused."""
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "built.json"
        command = [sys.executable, "-m", "cellcolor", "build", str(scene), "-o", str(target)]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        if not target.exists():
            return {"error": run.stderr.strip().rpartition("\n")[2].partition(f"{scene.name}: ")[2]}
        graph = json.loads(target.read_text("utf-8"))
        surface = json.loads(target.with_name(graph["surface"]["path"]).read_text("utf-8"))
        with np.load(target.with_name(surface["meta"]["side_file"])) as side:
            fates = {member: side[member].tolist() for member in side if "reason" in member}
            fates["branches"] = side["branches"].tolist()
    micrometers = np.rint(1e6 * np.array(surface["vertices"])).astype(int).tolist()
    mesh = f"{micrometers} {surface['faces']}"
    report = [line for line in run.stdout.splitlines() if not line.startswith(("seconds", "wrote"))]
    return {
        "vertices": len(surface["vertices"]),
        "faces": len(surface["faces"]),
        "cells": len(graph["cells"]),
        "coverage": graph["coverage"],
        "mesh_sha256": hashlib.sha256(mesh.encode()).hexdigest(),
        "surface_sha256": graph["surface"]["sha256"],
        "loops": [cell["loops"] for cell in graph["cells"]],
        "edges": [[e["id"], e["left"], e["right"], e.get("colors")] for e in graph["edges"]],
        "vertex_cell": graph["surface"]["vertex_cell"],
        **{member: surface[member] for member in ("colors", "vertex_colors", "cracks")},
        "given_up": surface.get("given_up", []),
        "report": [line for line in report if not line.endswith(" 0")],
        **fates,
    }


def differences(frozen: dict[str, Any], now: dict[str, Any]) -> Iterator[str]:
    """What is not as it was, in a line each."""
    if "error" in frozen or "error" in now:
        if frozen.get("error") != now.get("error"):
            yield f"refused: {frozen.get('error')!r}, now {now.get('error')!r}"
        return
    for what in SAME:
        if frozen[what] != now[what]:
            yield f"{what}: {frozen[what]!s:.70}, now {now[what]!s:.70}"
    for (what, old), new in zip(_by_vertex(frozen).items(), _by_vertex(now).values(), strict=True):
        if at := [v for v, pair in enumerate(zip_longest(old, new)) if pair[0] != pair[1]]:
            yield f"{what}: at {len(at)} of {len(old)} vertices, the first {at[:5]}"
    for (what, was), named in zip(_by_name(frozen).items(), _by_name(now).values(), strict=True):
        if gone := list(was - named):
            yield f"{what}: {len(gone)} of {len(was)} gone, among them {gone[:3]}"
        if added := list(named - was):
            yield f"{what}: {len(added)} of {len(named)} new, among them {added[:3]}"


def _by_vertex(scene: dict[str, Any]) -> dict[str, list[Any]]:
    """What each vertex has: colors, the fate of its candidates, the first vertex of its cell."""
    reasons = [[scene["reason_names"][code] for code in row] for row in scene["reasons"]]
    cells = scene["vertex_cell"]
    return {
        "labels": [{scene["colors"][color] for color in own} for own in scene["vertex_colors"]],
        "given up": [vertex in scene["given_up"] for vertex in range(scene["vertices"])],
        "reasons": [dict(zip(scene["branches"], row, strict=True)) for row in reasons],
        "cells": [-1 if cell == -1 else cells.index(cell) for cell in cells],
    }


def _by_name(scene: dict[str, Any]) -> dict[str, Counter[Any]]:
    """What there is: colors, cracks of a color, edges between cells, lines of the report."""
    names, first = scene["colors"], [*map(scene["vertex_cell"].index, range(scene["cells"])), -1]
    cracks = [(i, j, names[color]) for i, j, own in scene["cracks"] for color in own]
    sides = [(sorted((first[left], first[right])), own) for _, left, right, own in scene["edges"]]
    borders = [(*ends, str(own and sorted(names[color] for color in own))) for ends, own in sides]
    found = {"colors": names, "cracks": cracks, "borders": borders, "report": scene["report"]}
    return {what: Counter(values) for what, values in found.items()}


def main() -> None:
    """Compare the scenes that are named, or all."""
    frozen = json.loads(lzma.decompress(FROZEN.read_bytes()))["scenes"]
    found = 0
    for name in sys.argv[1:] or frozen:
        for line in differences(frozen[name], built(Path("instances") / name)):
            print(f"{name}: {line}", flush=True)
            found += 1
    print(f"{found} differences")
    sys.exit(found > 0)


if __name__ == "__main__":
    main()
