"""Ten meshes with something wrong: inspected, and repaired or refused by name."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import trimesh
from dirty import DIRTY
from shipped import shipped

from cellcolor.errors import InputError
from cellcolor.frontend.parts.inspection import inspect_mesh
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.mesh_file import MeshObject, read_mesh
from cellcolor.frontend.parts.repairing import repair_mesh
from cellcolor.frontend.prepared import prepare

# What the makers have done, and no other fault; counts are those of their docstrings.
FOUND: dict[str, dict[str, object]] = {
    "holes": {"holes": 5, "unused_vertices": 5},
    "duplicates": {"duplicate_faces": 40},
    "mixed-winding": {"mixed_winding": 683},  # of 2,048 every third, from the first on
    "components": {"components": 500},
    "millimeters": {"merged_vertices": 1038},  # 3 x 416 corners of 210 vertices
    "needles": {"flat_faces": 83},  # of 84: of two that are one another's copy the second
    "fin": {"non_manifold_edges": 1, "holes": 1},
    "crossing": {"components": 2},
    "inverted": {"inside_out": 1},
}
SMALL = {name: make for name, make in DIRTY.items() if name != "million"}
CLOSED_AREA = {"duplicates": 0.076, "millimeters": 0.076, "crossing": 0.152}


def number(value: object) -> object:
    return len(value) if isinstance(value, tuple) else value


@pytest.mark.parametrize("name", SMALL)
def test_what_is_wrong_is_found(name: str) -> None:
    facts = inspect_mesh(name, *SMALL[name]())
    for key, expected in FOUND[name].items():
        assert number(getattr(facts, key)) == expected, key
    faults = ("duplicate_faces", "mixed_winding", "inside_out", "non_manifold_edges")
    if name != "needles":  # where flat faces are left out there are gaps
        for key in {*faults, "flat_faces", "non_manifold_vertices"} - set(FOUND[name]):
            assert not number(getattr(facts, key)), key
    assert bool(facts.crossings) == (name in ("crossing", "components"))
    assert (facts.refusal is None) == (name in ("components", "crossing"))


def test_a_scene_says_where_faces_cross() -> None:
    """The first place is one that the inspection lists; a part without such faces has no note."""
    vertices, faces = DIRTY["crossing"]()
    found = inspect_mesh("crossing", vertices, faces).crossings
    place = ", ".join(f"{x:.4g}" for x in found[0])
    scene = shipped("wok", 60)
    said = f"{len(found)} pairs of the part's faces cross, the first at ({place}) m"
    block = vertices[: len(vertices) // 2], faces[: len(faces) // 2]
    for part, notes in (((vertices, faces), 1), (block, 0)):
        found_notes = [n for n in prepare(scene.with_object(part)).notes if "faces cross" in n]
        assert len(found_notes) == notes
        assert all(note.startswith(said) for note in found_notes)


@pytest.mark.parametrize("name", [name for name in SMALL if name != "needles"])
def test_what_is_repaired_can_be_used(name: str) -> None:
    """By trimesh: closed, oriented, with the volume of what it was made of."""
    vertices, faces = SMALL[name]()
    scale = 0.001 if name == "millimeters" else 1.0
    made = repair_mesh(vertices, faces, scale, fill_holes_m=0.2)
    surface = mesh_surface(made.vertices * scale, made.faces)
    mesh = trimesh.Trimesh(surface.vertices, surface.faces, process=False)
    assert mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0
    assert made.area_m2 == pytest.approx(mesh.area)
    if name in CLOSED_AREA:
        assert mesh.area == pytest.approx(CLOSED_AREA[name])
    told = [re.search(r"\((\S+) m\^2\)", change) for change in made.changes]
    whole = made.area_before_m2 + sum(float(found[1]) for found in told if found)
    assert whole == pytest.approx(made.area_m2, rel=1e-3)
    if name == "holes":  # a ball with five of its vertices cut off
        assert 0.97 < mesh.volume / (4 / 3 * np.pi * 0.1**3) < 1
    if name in ("fin", "inverted", "components"):
        assert mesh.volume == pytest.approx(trimesh.creation.icosphere(3, 0.1).volume, rel=1e-4)
    # A second repair finds nothing to do.
    assert repair_mesh(made.vertices, made.faces, scale).changes == ()


def test_as_stl(tmp_path: Path) -> None:
    """Four-byte numbers put the vertices of flat faces beside their lines."""
    vertices, faces = DIRTY["needles"]()
    trimesh.Trimesh(vertices, faces, process=False).export(tmp_path / "needles.stl")
    rounded, corners = read_mesh(tmp_path / "needles.stl")
    assert inspect_mesh("needles", rounded, corners).flat_faces == 83
    for mesh in ((vertices, faces), (rounded, corners)):
        with pytest.raises(InputError, match="T-vertex") as caught:
            repair_mesh(*mesh)
        assert str(caught.value.field).startswith("faces near (")
    with pytest.raises(InputError, match="T-vertex") as caught:
        MeshObject(file=str(tmp_path / "needles.stl"), meters_per_unit=1.0, repair=True).surface()
    assert caught.value.file == str(tmp_path / "needles.stl")
    assert "\n" not in str(caught.value) and "faces near (" in str(caught.value)


def test_a_moebius_strip_is_refused() -> None:
    around = np.arange(24) * np.pi / 12
    low, high = (
        np.column_stack(
            [
                (1 + s * np.cos(around / 2)) * np.cos(around),
                (1 + s * np.cos(around / 2)) * np.sin(around),
                s * np.sin(around / 2),
            ]
        )
        for s in (-0.3, 0.3)
    )
    faces = []
    for k in range(24):
        a, b, c, d = k, k + 24, (k + 1) % 24, (k + 1) % 24 + 24
        if k == 23:
            c, d = d, c
        faces += [(a, b, c), (b, d, c)]
    mesh = np.concatenate([low, high]), np.array(faces)
    assert "one-sided" in str(inspect_mesh("strip", *mesh).refusal_after_repair)
    with pytest.raises(InputError, match="one-sided component, like a Moebius strip") as caught:
        repair_mesh(*mesh)
    assert str(caught.value.field).startswith("faces near (")


@pytest.mark.parametrize(
    ("vertices", "faces", "field", "message"),
    [
        (np.eye(3), np.zeros((0, 3), dtype=int), "faces", "there are none"),
        (np.eye(3) * np.nan, np.array([[0, 1, 2]]), "vertices[0][0]", "not a finite"),
        (np.eye(3), np.array([[0, 1, 3]]), "faces[0][2]", "no vertex 3"),
        (np.zeros((3, 3)), np.array([[0, 1, 2]]), "faces", "that has an area"),
    ],
)
def test_what_cannot_be_repaired(
    vertices: np.ndarray, faces: np.ndarray, field: str, message: str
) -> None:
    with pytest.raises(InputError, match=message) as caught:
        repair_mesh(vertices, faces)
    assert caught.value.field == field


@pytest.mark.slow
def test_a_million_triangles() -> None:
    vertices, faces = DIRTY["million"]()
    found = inspect_mesh("million", vertices, faces)
    assert found.triangles == 1_000_000 and found.crossings == ()
    assert "501,501 vertices, at most 250,000 fit" in str(found.refusal)
    with pytest.raises(InputError, match=r"--edge-length 0\.0044? would give about 60,000"):
        repair_mesh(vertices, faces)
