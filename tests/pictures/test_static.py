"""PNG: nothing of a picture is cut off at its edge."""

from __future__ import annotations

import io

import numpy as np
import pytest
from meshes import drawn
from PIL import Image

import cellcolor


@pytest.mark.parametrize("length", [10, 60, 90])
def test_long_names_stay_inside(length: int) -> None:
    surface = drawn("AABB AABB", {"A": [0], "B": [1]})
    names = (length * "a", length * "b", *surface.colors[2:])
    renamed = cellcolor.LabelledSurface(
        "test", names, surface.vertices, surface.faces, surface.vertex_colors
    )
    page = io.BytesIO(cellcolor.solve(renamed).plot().render(".png"))
    pixels = np.asarray(Image.open(page).convert("L"))
    legend = pixels[:, int(0.645 * pixels.shape[1]) :]
    assert (legend < 128).any() and (legend[:, -10:] == 255).all()
