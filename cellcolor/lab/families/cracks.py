"""Random cracks over a mesh."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cellcolor.data.surface import Crack


def crack_paths(
    rng: np.random.Generator,
    faces: NDArray[np.int64],
    vertex_colors: Sequence[tuple[int, ...]],
    count: int,
    length: int,
) -> tuple[Crack, ...]:
    """Walks from triangle to triangle; what they cross is cracked for a few common colors."""
    faces_of: dict[tuple[int, int], list[int]] = {}
    for number, face in enumerate(faces.tolist()):
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            faces_of.setdefault((min(a, b), max(a, b)), []).append(number)
    edges_of: list[list[tuple[int, int]]] = [[] for _ in faces]
    for edge, sides in faces_of.items():
        for side in sides:
            edges_of[side].append(edge)
    cracked: dict[tuple[int, int], tuple[int, ...]] = {}
    for _ in range(count):
        face = int(rng.integers(len(faces)))
        available = sorted({color for vertex in faces[face] for color in vertex_colors[vertex]})
        chosen = {color for color in available if rng.random() < 0.7}
        visited = {face}
        for _ in range(int(rng.integers(2, length + 1))):
            onward = [
                (edge, side)
                for edge in edges_of[face]
                for side in faces_of[edge]
                if side not in visited and edge not in cracked
            ]
            if not onward:
                break
            edge, face = onward[int(rng.integers(len(onward)))]
            visited.add(face)
            common = chosen & set(vertex_colors[edge[0]]) & set(vertex_colors[edge[1]])
            if common:
                cracked[edge] = tuple(sorted(common))
    return tuple(Crack(i, j, common) for (i, j), common in sorted(cracked.items()))
