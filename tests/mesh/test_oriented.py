"""The orientation of meshes, held to its definition in terms of networkx."""

from __future__ import annotations

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from meshes import grid_faces
from numpy.typing import NDArray

from cellcolor.errors import InputError
from cellcolor.mesh.triangle_mesh import directed_edges

Faces = NDArray[np.int64]
FEW = st.lists(st.permutations(range(6)).map(lambda order: order[:3]), min_size=1, max_size=8)


def hold(faces: Faces, count: int) -> None:
    """The third vertex on the left of each directed edge, or a refusal where it is no manifold.

    There no directed edge is used twice, and the sides across from a vertex are connected.
    """
    third: dict[tuple[int, int], int] = {}
    across, twice = [nx.Graph() for _ in range(count)], False
    for i, j, k in faces.tolist():
        for a, b, c in ((i, j, k), (j, k, i), (k, i, j)):
            twice |= (a, b) in third
            third[a, b] = c
            across[a].add_edge(b, c)
    if twice or not all(len(sides) and nx.is_connected(sides) for sides in across):
        with pytest.raises(InputError, match=r"manifold|winds|no face|pinched"):
            directed_edges(faces, count)
    else:
        assert directed_edges(faces, count) == third


@given(FEW, st.integers(5, 7))
def test_any_few_faces(faces: list[list[int]], count: int) -> None:
    """Most of these meshes are faulty."""
    faces = [face for face in faces if max(face) < count]
    if faces:
        hold(np.array(faces), count)


@given(st.data())
def test_good_meshes_with_some_faces_changed(data: st.DataObject) -> None:
    """Faces left out, turned over, doubled, and vertices pinched together."""
    faces = np.array(grid_faces(4, 4))
    keep = np.array(data.draw(st.lists(st.booleans(), min_size=len(faces), max_size=len(faces))))
    keep |= data.draw(st.booleans())
    faces = faces[keep] if keep.any() else faces
    change = data.draw(st.sampled_from(["none", "turn", "double", "pinch"]))
    number = data.draw(st.integers(0, len(faces) - 1))
    if change == "turn":
        faces[number] = faces[number][::-1].copy()
    elif change == "double":
        faces = np.vstack([faces, np.roll(faces[number], 1)])
    elif change == "pinch":
        kept, gone = data.draw(st.permutations(range(16)))[:2]
        faces = np.where(faces == gone, kept, faces)
    used, faces = np.unique(faces, return_inverse=True)
    faces = faces.reshape(-1, 3)
    if any(len(set(face)) < 3 for face in faces.tolist()):
        with pytest.raises(InputError, match="repeats a vertex"):
            directed_edges(faces, len(used))
    else:
        hold(faces, len(used))


@pytest.mark.parametrize("degree", [3, 64, 65])
def test_fans_of_all_sizes(degree: int) -> None:
    """A closed fan about vertex 0, and two of them that touch in their tips."""
    rim = np.arange(degree)
    fan = np.column_stack([np.zeros(degree, dtype=int), 1 + rim, 1 + (rim + 1) % degree])
    hold(fan, degree + 1)
    both = np.vstack([fan, np.where(fan > 0, fan + degree, 0)])
    with pytest.raises(InputError, match=f"its {2 * degree} faces"):
        directed_edges(both, 2 * degree + 1)
