"""Ten meshes with something wrong, and any others: inspected and repaired, with time and memory.

    python benchmarks/dirty_meshes.py [FILE…]

writes the ten of ``tests/support/dirty.py``, or takes the files, calls ``cellcolor inspect`` and
``cellcolor repair`` on each, every call a process of its own, and prints a table. A call may take
ten minutes.
"""

from __future__ import annotations

import json
import multiprocessing
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

import numpy as np
import trimesh
from dirty import DIRTY

_LIMIT = 600  # s


def main(files: list[Path]) -> None:
    """Measure and print."""
    print("| mesh | triangles | inspect | peak | found | repair | peak | outcome |")
    print("|---|--:|--:|--:|---|--:|--:|---|")
    with tempfile.TemporaryDirectory() as folder:
        for file in files or _written(Path(folder)):
            _row(file, Path(folder))


def _written(folder: Path) -> list[Path]:
    """The ten as files.

    They are made in another process: the greatest memory of a child counts what its parent had.
    """
    writer = multiprocessing.get_context("spawn").Process(target=_write, args=(folder,))
    writer.start()
    writer.join()
    return [folder / f"{name}.stl" for name in DIRTY]


def _write(folder: Path) -> None:
    """As binary STL: each triangle with vertices of its own."""
    for name, make in DIRTY.items():
        vertices, faces = make()
        trimesh.Trimesh(vertices, faces, process=False).export(folder / f"{name}.stl")


def _row(file: Path, folder: Path) -> None:
    picture, mesh = folder / "picture.png", folder / "made.obj"
    out, seconds, peak, code = _run("inspect", file, "-o", picture, "--json")
    found, triangles, options = out, 0, []
    if code == 0:
        facts = json.loads(out)
        found, triangles = _faults(facts), facts["triangles"]
        extent = np.ptp([facts["low_m"], facts["high_m"]], axis=0).max()
        options = ["--unit", facts["unit"], "--fill-holes", f"{0.5 * extent:.3g}"]
    row = f"| {file.stem} | {triangles:,} | {seconds:.1f} s | {peak:.0f} MB | {found} |"
    out, seconds, peak, _ = _run("repair", file, "-o", mesh, *options)
    outcome = out.strip().split("\n")
    shown = [line for line in outcome if not line.startswith("wrote")]
    text = "; ".join(shown).replace(str(file), "").replace("|", "/")
    print(f"{row} {seconds:.1f} s | {peak:.0f} MB | {text} |", flush=True)
    mesh.unlink(missing_ok=True)


def _faults(facts: dict[str, object]) -> str:
    found = []
    for name, value in facts.items():
        number = value["count"] if isinstance(value, dict) and "count" in value else value
        wrong = (
            "holes unused_vertices duplicate_faces flat_faces mixed_winding inside_out crossings"
            " non_manifold_edges non_manifold_vertices one_sided components"
        )
        if name in wrong.split() and number and not (name == "components" and number == 1):
            found.append(f"{name.replace('_', ' ')} {number:,}")
    return ", ".join(found) or "nothing"


def _run(*arguments: object) -> tuple[str, float, float, int]:
    """What one command prints, its seconds, the peak of its memory in MB, and its exit code."""
    begun = time.monotonic()
    with tempfile.TemporaryFile() as printed:
        child = subprocess.Popen(
            [sys.executable, "-m", "cellcolor", *map(str, arguments), "--time-limit", str(_LIMIT)],
            stdout=printed,
            stderr=printed,
        )
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        printed.seek(0)
        text = printed.read().decode(errors="replace")
    return text, time.monotonic() - begun, usage.ru_maxrss / 1024, child.returncode


if __name__ == "__main__":
    main([Path(name) for name in sys.argv[1:]])
