"""The picture of a part: every fault in a layer of its own, where it is."""

from __future__ import annotations

import numpy as np
from dirty import DIRTY

import cellcolor
from cellcolor.pictures.mesh_picture import faulty_part


def test_faults_are_marked() -> None:
    expected = {
        "duplicates": "faces there twice: 40",
        "mixed-winding": "faces wound against their neighbors: 683",
        "inverted": "closed components inside out: 1,280",
        "fin": "edges with more than two faces: 1 edges",
        "holes": "holes and borders: 30 edges",
    }
    for name, text in expected.items():
        vertices, faces = DIRTY[name]()
        picture = faulty_part(cellcolor.inspect((vertices, faces)))
        marked = {layer.name: layer.points for layer in picture.layers}
        marked |= {line.name: line.ends.reshape(-1, 3) for line in picture.lines}
        faults = {one for one in marked if not one.startswith("sharp edges: ")}
        assert faults == {"part", text, *beside(name)}
        off = np.linalg.norm(marked[text][:, None] - vertices[None], axis=2).min(axis=1)
        assert off.max() < 1e-12
        assert picture.notes[0].startswith("Not usable unchanged: ")
        assert max(map(len, picture.notes)) <= 60


def beside(name: str) -> set[str]:
    """The fin has a border as well."""
    return {"holes and borders: 3 edges"} if name == "fin" else set()
