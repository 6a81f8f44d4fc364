"""Patches of an object, against what is chosen by hand."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from shipped import shipped

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend import build_surface
from cellcolor.frontend.parts.cover import Cover
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.prepared import prepare


def block(*middles: tuple[float, float, float]) -> Surface:
    """Blocks of 0.2 x 0.1 x 0.06 m, halved in size with each, in triangles of 20 mm at most."""
    meshes = []
    for number, middle in enumerate(middles or [(0.0, 0.0, 0.0)]):
        mesh = trimesh.creation.box(np.array([0.2, 0.1, 0.06]) / 2**number)
        meshes.append(mesh.subdivide_to_size(0.02).apply_translation(middle))
    whole = trimesh.util.concatenate(meshes)
    return mesh_surface(np.array(whole.vertices), np.array(whole.faces, dtype=np.int64))


def middles(surface: Surface) -> Array:
    return surface.vertices[surface.faces].mean(axis=1)


def chosen(surface: Surface, **keys: Any) -> Array:
    """The middles of the faces in the patch."""
    return middles(Cover(**keys).patch(surface))


def test_by_normal() -> None:
    found = chosen(block(), normal={"direction": (0.0, 0.0, 5.0), "within_rad": 0.1})
    assert np.allclose(found[:, 2], 0.03)
    patch = Cover(normal={"direction": (0, 0, 1.0), "within_rad": 0.1}).patch(block())
    # On the rim, beside the sharp edge, the normal is the top's alone.
    assert np.allclose(patch.normals, [0, 0, 1])
    assert np.linalg.norm(np.cross(*patch.vertices[patch.faces][0, 1:])) > 0


@given(
    st.lists(st.floats(-1, 1), min_size=3, max_size=3).filter(lambda v: np.linalg.norm(v) > 0.01),
    st.floats(0.1, 3.0),
)
def test_a_cone_of_normals_on_a_ball(direction: list[float], within: float) -> None:
    """Which faces of a ball look within an angle of a direction, by their cosine."""
    ball = trimesh.creation.icosphere(subdivisions=2)
    surface = mesh_surface(np.array(ball.vertices), np.array(ball.faces, dtype=np.int64))
    cover = Cover(normal={"direction": tuple(direction), "within_rad": within})
    cosine = ball.face_normals @ (np.array(direction) / np.linalg.norm(direction))
    clear = np.abs(cosine - np.cos(within)) > 1e-6
    assert (cover.chosen(surface)[clear] == (cosine > np.cos(within))[clear]).all()


def test_by_box() -> None:
    whole = block()
    low, high = (-1.0, -1.0, -1.0), (0.03, 1.0, 1.0)
    found = chosen(whole, box={"low_m": low, "high_m": high})
    inside = (whole.vertices[whole.faces][:, :, 0] <= 0.03).all(axis=1)
    assert sorted(map(tuple, found)) == sorted(map(tuple, middles(whole)[inside]))


def test_by_component_and_normal() -> None:
    """Components are numbered by area, whatever their order in the mesh."""
    whole = block((0.0, 0.0, 0.0), (0.0, 0.0, 0.5), (0.0, 0.0, 1.0))
    top = {"direction": (0.0, 0.0, 1.0), "within_rad": 0.5}
    heights = [0.03, 0.5 + 0.015, 1.0 + 0.0075]
    for number, height in enumerate(heights):
        assert np.allclose(chosen(whole, component=number, normal=top)[:, 2], height)
    with pytest.raises(InputError, match="no component 3: the object has 3") as caught:
        Cover(component=3).patch(whole)
    assert caught.value.field == "cover.component"


def test_by_a_region_between_sharp_edges() -> None:
    """From a seed at the front, the front; the top edge is sharp."""
    found = chosen(block(), region={"seed_m": (0.02, -0.07, 0.01), "sharp_rad": 0.8})
    assert np.allclose(found[:, 1], -0.05) and len(found) == len(
        chosen(block(), normal={"direction": (0, -1.0, 0), "within_rad": 0.1})
    )
    # A bent sheet has no edge that is sharp: all of it.
    sheet = shipped("half_pipe", 200).object.surface()
    grown = Cover(region={"seed_m": (0.0, 0.0, 1.0), "sharp_rad": 0.5}).patch(sheet)
    assert len(grown.faces) == len(sheet.faces)
    assert (grown.normals == sheet.normals).all()  # those of the shape, not of its faces


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"normal": {"direction": (1.0, 1.0, 1.0), "within_rad": 0.1}}, "chooses none of"),
        ({"component": 0}, "chooses a closed surface"),
    ],
)
def test_what_is_no_patch(keys: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        Cover(**keys).patch(block())
    assert caught.value.field == "cover"


def test_a_patch_that_meets_itself_in_a_point(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two faces with one corner in common; the object's own number of it is named."""
    whole = block()
    first = whole.faces[0]
    shared = np.isin(whole.faces, first).sum(axis=1)
    second = int(np.flatnonzero(shared == 1)[0])
    (corner,) = set(first.tolist()) & set(whole.faces[second].tolist())
    both = np.isin(np.arange(len(whole.faces)), [0, second])
    monkeypatch.setattr(Cover, "chosen", lambda *_: both)
    with pytest.raises(InputError, match=rf"cannot be covered: vertices\[{corner}\]: ") as caught:
        Cover(component=0).patch(whole)
    assert caught.value.field == "cover"
    # By its place where edges were halved, since no file has that number.
    halved = replace(whole, divided=(whole.mesh, np.arange(len(whole.faces))))
    place = ", ".join(f"{x:.4g}" for x in whole.vertices[corner])
    with pytest.raises(InputError, match=re.escape(f"cannot be covered: near ({place}) m: ")):
        Cover(component=0).patch(halved)


@pytest.mark.parametrize(
    ("keys", "field"),
    [
        ({}, None),
        ({"normal": {"direction": (0.0, 0.0, 0.0), "within_rad": 1.0}}, "normal.direction"),
        ({"normal": {"direction": (0.0, 0.0, 1.0), "within_rad": 0.0}}, "normal.within_rad"),
        ({"component": -1}, "component"),
        ({"painted": True}, "painted"),
    ],
)
def test_faulty_tables(keys: dict[str, Any], field: str | None) -> None:
    with pytest.raises(InputError) as caught:
        Cover(**keys)
    assert caught.value.field == field


def test_the_rest_is_not_to_be_hit() -> None:
    """Half of the wok: the same vertices and verdicts there as of the whole wok."""
    wok = shipped("wok", 200)
    half = wok.varied(cover={"box": {"low_m": (-0.02, -1.0, -1.0), "high_m": (1.0, 1.0, 1.0)}})
    whole, part = build_surface(wok), build_surface(half)
    of_whole = {tuple(vertex): k for k, vertex in enumerate(whole.surface.vertices)}
    rows = [of_whole[tuple(vertex)] for vertex in part.surface.vertices]
    assert 60 < len(rows) < 140
    # Only the normals on the new border differ, and with them a few verdicts there.
    same = (part.prepared.surface.normals == whole.prepared.surface.normals[rows]).all(axis=1)
    assert same.mean() > 0.8
    assert (part.reasons[same] == whole.reasons[rows][same]).all()
    assert (part.reasons == part.reason_names.index("object collision")).any()
    assert part.surface.meta["scene"]["cover"]["box"]["low_m"] == [-0.02, -1.0, -1.0]
    assert "cover" not in whole.surface.meta["scene"]
    assert str(half).startswith("wok: part of a spherical-cap at")
    # Without the rest there is less to hit.
    alone = half.varied(collision_object=(prepare(half).scene.object.varied(radius_m=0.001)))
    assert (build_surface(alone).reasons == 0).sum() > (part.reasons == 0).sum()
