"""Remeshing in a separate process; run as a script, by its path.

It reads an archive of numpy from standard input and writes one to standard output. The library
is compiled, cannot be interrupted and crashes on some meshes; a process can be ended.
"""

from __future__ import annotations

import io
import resource
import sys
from typing import Any

_ITERATIONS = 10
_MEMORY = 3 << 30  # bytes


def main() -> None:
    """Remesh what is on standard input, or measure how far two meshes are from each other."""
    import numpy as np

    resource.setrlimit(resource.RLIMIT_DATA, (_MEMORY, _MEMORY))
    given = np.load(io.BytesIO(sys.stdin.buffer.read()))
    content = io.BytesIO()
    np.savez(content, **(_remeshed(given) if "length" in given else _measured(given)))
    sys.stdout.buffer.write(content.getvalue())


def _remeshed(given: Any) -> dict[str, Any]:
    import numpy as np
    from gpytoolbox import remesh_botsch

    vertices, faces = remesh_botsch(
        given["vertices"], given["faces"].astype(np.int32), _ITERATIONS, float(given["length"]),
        True, feature_edges=given["kept"].astype(np.int32),
    )  # fmt: skip
    return {"vertices": vertices, "faces": faces}


def _measured(given: Any) -> dict[str, Any]:
    """Greatest and mean distance of vertices and middles of faces from the other mesh."""
    import numpy as np
    from gpytoolbox import squared_distance

    old = given["vertices"], given["faces"].astype(np.int32)
    new = given["new_vertices"], given["new_faces"].astype(np.int32)

    def apart(points: Any, corners: Any, other: tuple[Any, Any]) -> list[float]:
        asked = np.concatenate([points, points[corners].mean(axis=1)])
        squared, _, _ = squared_distance(asked, other[0], other[1], use_cpp=True, use_aabb=True)
        distance = np.sqrt(np.maximum(squared, 0.0))
        return [float(distance.max()), float(distance.mean())]

    return {"there": apart(*old, new), "back": apart(*new, old)}


if __name__ == "__main__":
    main()
