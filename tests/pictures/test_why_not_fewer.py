"""Why fewer segments are not enough: what is drawn, held against the certificate and the mesh."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from library import PAPER
from rooms import hub as hub_graph

import cellcolor
from cellcolor.decomposition import decomposition_of
from cellcolor.door.drawing import Drawing
from cellcolor.errors import InputError
from cellcolor.lab.families import blobs
from cellcolor.pictures.picture import Picture3D


def painted(drawing: Drawing) -> dict[str, set[int]]:
    """The vertices inside each entry of the legend."""
    assert isinstance(drawing.picture, Picture3D) and drawing.picture.mesh is not None
    mesh = drawing.picture.mesh
    return {
        one.name: own
        for number, one in enumerate(mesh.classes)
        if (own := set(np.flatnonzero(mesh.labels == number).tolist()))
    }


def test_a_conflict_has_four_areas_and_two_connections_that_cross() -> None:
    surface = blobs(5, size=20, thin=True)
    result = cellcolor.solve(surface)
    drawing = cellcolor.show(result, view="why")
    layers = painted(drawing)
    (bound,) = [b for b in result.solution.bounds or () if b.kind == "conflicts"]
    assert bound.certificate is not None
    conflict = bound.certificate["parts"][0]["conflicts"][0]
    cell_of = decomposition_of(surface, None).vertex_cell
    areas = [*conflict["one"], *conflict["other"]]
    for name, area in zip(("a1", "a2", "b1", "b2"), areas, strict=True):
        (own,) = [vertices for layer, vertices in layers.items() if layer.startswith(f"{name}: ")]
        assert own == {vertex for vertex, cell in enumerate(cell_of) if cell in area}
    crossed = layers["where they cross"]
    assert crossed
    for letter, color in zip("ab", conflict["colors"], strict=True):
        (way,) = [
            v for layer, v in layers.items() if layer.startswith(f"a connection of {letter}1")
        ]
        assert all(color in surface.vertex_colors[vertex] for vertex in way | crossed)
    assert str(drawing) == f"{surface.name}: why {bound.value} segments at least"
    texts = {text.text for text in drawing.picture.texts}  # type: ignore[union-attr]
    assert texts == {"a1", "a2", "b1", "b2"}


def test_cells_that_cannot_share_a_segment_have_their_numbers() -> None:
    path = PAPER / "ring.surface.json"
    result = cellcolor.solve(path)
    (bound,) = result.solution.bounds or ()
    assert bound.certificate is not None
    layers = painted(cellcolor.show(result, view="why"))
    marked = {int(m[1]) for name in layers if (m := re.match(r"cell (\d+): ", name))}
    assert marked == set(bound.certificate["cells"])


def test_without_a_certificate_there_is_nothing_to_see() -> None:
    path = PAPER / "ring.surface.json"
    found = cellcolor.solve(path).solution
    bare = tuple(replace(bound, certificate=None) for bound in found.bounds or ())
    solution = replace(found, bounds=bare)
    with pytest.raises(InputError, match="bounds: none above 1 has a certificate"):
        cellcolor.show(path, view="why", solution=solution)
    with pytest.raises(InputError, match="only the graph can be shown"):
        cellcolor.show(cellcolor.solve(hub_graph(0, 1, 0, 1)), view="why")
