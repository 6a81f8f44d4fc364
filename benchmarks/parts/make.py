"""Make the meshes of instances/parts: ``python benchmarks/parts/make.py [FOLDER [NAME …]]``.

Each is an OBJ file in mm. The parts are this project's own, under its license; what stands in
instances/parts is what this writes, to the byte.
"""

from __future__ import annotations

import sys
from pathlib import Path

from bracket import bracket
from even import Mesh
from shapes import blend, perforated_sheet, saddle, sphere, torus

PARTS = {
    "bracket": bracket,
    "blend": blend,
    "saddle": saddle,
    "perforated_sheet": perforated_sheet,
    "sphere": sphere,
    "torus": torus,
}


def text(name: str, mesh: Mesh) -> str:
    """A mesh as an OBJ file, with lengths to the micrometer."""
    vertices, faces = mesh
    lines = [f"# {name}, in mm; made by benchmarks/parts/make.py of cellcolor, MIT"]
    lines += [f"v {x:.3f} {y:.3f} {z:.3f}" for x, y, z in vertices + 0.0]
    lines += [f"f {a} {b} {c}" for a, b, c in faces + 1]
    return "\n".join(lines) + "\n"


def main(folder: Path, names: list[str]) -> None:
    """Write parts, every one if none is named."""
    for name in names or PARTS:
        mesh = PARTS[name]()
        (folder / f"{name}.obj").write_text(text(name, mesh), encoding="utf-8", newline="\n")
        print(f"{name}: {len(mesh[0])} vertices, {len(mesh[1])} faces")


if __name__ == "__main__":
    default = Path(__file__).resolve().parents[2] / "instances" / "parts"
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else default, sys.argv[2:])
