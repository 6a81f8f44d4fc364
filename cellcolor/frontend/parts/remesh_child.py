"""Remeshing in a process of its own; run as a script, by its path.

It reads an archive of numpy from standard input and writes one to standard output. What it calls
is compiled and cannot be interrupted, and some meshes make it crash; a process can be ended.
"""

from __future__ import annotations

import io
import resource
import sys
from typing import Any

_ITERATIONS = 10
_MEMORY = 3 << 30  # bytes


def main() -> None:
    """Remesh what is on standard input, and measure how far both meshes are from each other."""
    import numpy as np
    from gpytoolbox import remesh_botsch, squared_distance

    resource.setrlimit(resource.RLIMIT_DATA, (_MEMORY, _MEMORY))
    given = np.load(io.BytesIO(sys.stdin.buffer.read()))
    vertices, faces = given["vertices"], given["faces"].astype(np.int32)
    made, new = remesh_botsch(
        vertices.copy(), faces, _ITERATIONS, float(given["length"]), True,
        feature_edges=given["kept"].astype(np.int32),
    )  # fmt: skip
    new = new.astype(np.int32)

    def apart(points: Any, corners: Any, other: tuple[Any, Any]) -> list[float]:
        """Greatest and mean distance of vertices and middles of faces from the other mesh."""
        asked = np.concatenate([points, points[corners].mean(axis=1)])
        squared, _, _ = squared_distance(asked, other[0], other[1], use_cpp=True, use_aabb=True)
        return [
            float(np.sqrt(np.maximum(squared, 0.0)).max()),
            float(np.sqrt(np.maximum(squared, 0.0)).mean()),
        ]

    content = io.BytesIO()
    np.savez(
        content,
        vertices=made,
        faces=new,
        there=apart(vertices, faces, (made, new)),
        back=apart(made, new, (vertices, faces)),
    )
    sys.stdout.buffer.write(content.getvalue())


if __name__ == "__main__":
    main()
