"""The orientation of meshes, held to a plain walk from face to face."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import triangles
from hypothesis import given
from hypothesis import strategies as st
from meshes import grid_faces
from numpy.typing import NDArray

from cellcolor.errors import InputError
from cellcolor.mesh.oriented import directed_edges

Faces = NDArray[np.int64]
FEW = st.lists(st.permutations(range(6)).map(lambda order: order[:3]), min_size=1, max_size=8)


def answer(find: Callable[[Faces, int], object], faces: Faces, count: int) -> object:
    try:
        return find(faces, count)
    except InputError as error:
        return str(error)


@given(FEW, st.integers(5, 7))
def test_any_few_faces(faces: list[list[int]], count: int) -> None:
    """The same triangles, or the same sentence: most of these meshes are faulty."""
    array = np.array(faces)
    assert answer(directed_edges, array, count) == answer(triangles.directed_edges, array, count)


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
    count = len(used)
    expected = answer(triangles.directed_edges, faces, count)
    assert answer(directed_edges, faces, count) == expected


@pytest.mark.parametrize("degree", [3, 64, 65])
def test_fans_of_all_sizes(degree: int) -> None:
    """A closed fan about vertex 0, and two of them that touch in their tips."""
    rim = np.arange(degree)
    fan = np.column_stack([np.zeros(degree, dtype=int), 1 + rim, 1 + (rim + 1) % degree])
    assert directed_edges(fan, degree + 1) == triangles.directed_edges(fan, degree + 1)
    both = np.vstack([fan, np.where(fan > 0, fan + degree, 0)])
    with pytest.raises(InputError, match=f"its {2 * degree} faces"):
        directed_edges(both, 2 * degree + 1)
