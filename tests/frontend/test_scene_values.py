"""Scenes and setups as values: what a file can say can be said in Python, and is held alike."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from dirty import obj
from hypothesis import given
from hypothesis import strategies as st
from shipped import ROBOTS, WOK, edited

from cellcolor.errors import InputError
from cellcolor.frontend import Scene, Setup, build_surface
from cellcolor.frontend.parts.mesh import ArraysObject
from cellcolor.frontend.parts.shapes import CapObject
from examples import examples

SETUP = ROBOTS / "ur5_polishing.toml"
CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) / 10
SIDES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])

coordinates = st.floats(-5, 5)
vectors = st.tuples(coordinates, coordinates, coordinates)


def from_text(folder: Path, **keys: object) -> Scene:
    """The wok read from a file with some keys replaced."""
    file = folder / "scene.toml"
    file.write_text(edited(WOK.read_text(), setup=f'"{SETUP.as_posix()}"', **keys))
    return Scene.read(file)


@examples(12)
@given(vectors, vectors, st.integers(7, 10_000), st.floats(0.01, 1))
def test_a_varied_scene_is_the_one_of_an_edited_file(
    tmp_path_factory: pytest.TempPathFactory,
    position: tuple[float, ...],
    turn: tuple[float, ...],
    vertices: int,
    radius: float,
) -> None:
    expected = from_text(
        tmp_path_factory.mktemp("scene"),
        position_m=list(position),
        rpy_rad=list(turn),
        target_vertices=vertices,
        radius_m=radius,
    )
    wok = Scene.read(WOK).with_setup(SETUP)
    found = wok.moved(position_m=position, rpy_rad=np.array(turn)).varied(
        object={"target_vertices": vertices, "radius_m": radius}
    )
    assert found.model_dump() == expected.model_dump()
    assert Scene.read(WOK) == Scene.read(WOK) != found


@pytest.mark.parametrize(
    ("changes", "keys"),
    [
        ({"object": {"radius_m": -0.2}}, {"radius_m": -0.2}),
        ({"object": {"target_vertices": 20.5}}, {"target_vertices": 20.5}),
        ({"placement": {"position_m": (0.0, float("nan"), 0.0)}}, {"position_m": "[0.0, nan, 0]"}),
        ({"placement": {"rpy_rad": (0.0, 0.0)}}, {"rpy_rad": "[0.0, 0.0]"}),
        ({"ground": {"height_m": 1e7}}, {"height_m": 1e7}),
        ({"name": ""}, {"name": '""'}),
    ],
)
def test_faults_are_those_of_a_file(
    tmp_path: Path, changes: dict[str, Any], keys: dict[str, object]
) -> None:
    with pytest.raises(InputError) as of_file:
        from_text(tmp_path, **keys)
    with pytest.raises(InputError) as of_value:
        Scene.read(WOK).varied(**changes)
    assert of_value.value.file is None
    assert of_value.value.field == of_file.value.field
    assert of_value.value.message == of_file.value.message


def test_unknown_keys_and_kinds() -> None:
    wok = Scene.read(WOK)
    for changes, field, message in (
        ({"floor": 1.0}, "floor", "unknown key"),
        ({"object": {"sed": 1}}, "object.sed", "unknown key"),
        (
            {"object": {"kind": "donut"}},
            "object",
            "there is no 'donut'; there are spherical-cap, pipe",
        ),
        ({"obstacle": [{"kind": "cube"}]}, "obstacle[0]", "there is no 'cube'; there are box"),
        ({"obstacle": [{"radius_m": 1.0}]}, "obstacle[0]", "needs a kind"),
        ({"object": 7}, "object", "must be a table"),
        ({"setup": {"thresholds": {"min_manipulability": 0.1}}}, "setup.thresholds", "either"),
        ({"setup": {"constraints": {"force": 1}}}, "setup.constraints.force", "boolean"),
    ):
        with pytest.raises(InputError, match=message) as caught:
            wok.varied(**changes)
        assert caught.value.field == field


def test_files_cannot_say_where_they_are(tmp_path: Path) -> None:
    for key in ("folder", "file"):
        file = tmp_path / "scene.toml"
        file.write_text(f'{key} = "/"\n{WOK.read_text()}')
        with pytest.raises(InputError, match="unknown key") as caught:
            Scene.read(file)
        assert (caught.value.file, caught.value.field) == (str(file), key)


def test_values_are_pickled_and_compared() -> None:
    scene = Scene.read(WOK).with_object((CORNERS, SIDES))
    again = pickle.loads(pickle.dumps(scene))
    assert again == scene and hash(again) == hash(scene)
    assert scene.with_object((CORNERS * 2, SIDES)) != scene
    assert "sha256" in scene.model_dump(mode="json")["object"]


def test_a_scene_without_any_file() -> None:
    """Robot, tool, setup and object as text, values and arrays: nothing is there to be read."""
    shipped = Setup.read(SETUP)
    setup = shipped.varied(
        robot={key: (ROBOTS / getattr(shipped.robot, key)).read_text()
               for key in ("arm_urdf", "tool_urdf")},
        folder="/nowhere",
    )  # fmt: skip
    wok = Scene.read(WOK).varied(object={"target_vertices": 100}, folder="/nowhere")
    found = build_surface(wok.with_setup(setup))
    expected = build_surface(Scene.read(WOK).varied(object={"target_vertices": 100}))
    assert found.surface.sha256 == expected.surface.sha256
    assert found.surface.meta["setup"]["robot"]["arm_urdf"] == setup.robot.arm_urdf
    faulty = setup.varied(robot={"arm_urdf": setup.robot.arm_urdf.replace("<limit", "<limits", 1)})
    with pytest.raises(InputError, match="limit") as caught:
        build_surface(wok.with_setup(faulty))
    assert caught.value.file == "arm_urdf"


def test_a_part_as_arrays_or_a_mesh_is_the_one_in_a_file(tmp_path: Path) -> None:
    cap = CapObject(
        radius_m=0.2, half_angle_rad=1.1, target_vertices=100, jitter=0.15, seed=1
    ).surface()
    (tmp_path / "cap.obj").write_text(obj(cap.vertices, cap.faces.tolist()))
    table = {"kind": "mesh", "file": "cap.obj", "meters_per_unit": 1.0}
    wok = Scene.read(WOK)
    expected = build_surface(wok.with_setup(SETUP).varied(object=table, folder=tmp_path)).surface
    mesh = trimesh.Trimesh(cap.vertices, cap.faces, process=False)
    for part in (mesh, (cap.vertices, cap.faces), (cap.vertices.tolist(), cap.faces.tolist())):
        found = build_surface(wok.with_object(part)).surface
        assert np.allclose(found.vertices, expected.vertices, atol=1e-6)
        assert (found.faces == expected.faces).all()
        assert found.vertex_colors == expected.vertex_colors


@pytest.mark.parametrize(
    ("vertices", "faces", "field"),
    [
        (CORNERS, SIDES[:, :2], "faces"),
        (CORNERS, SIDES / 1, "faces"),
        (CORNERS[:, :2], SIDES, "vertices"),
        (CORNERS, SIDES[[0, 1, 2, 3, 3]], "faces[4]"),
        (CORNERS, [*SIDES[:3], [1, 2, 9]], "faces[3][2]"),
        (CORNERS * np.nan, SIDES, "vertices[0][0]"),
        (CORNERS, SIDES[:, ::-1], "faces"),
    ],
)
def test_arrays_are_held_to_what_mesh_files_are(vertices: Any, faces: Any, field: str) -> None:
    with pytest.raises(InputError) as caught:
        ArraysObject(vertices=np.array(vertices), faces=np.array(faces)).surface()
    assert caught.value.file is None and str(caught.value.field).startswith(field)
    assert not caught.value.message.startswith("Value error")  # pydantic's words


def test_a_scene_prints_what_it_is_in_one_line() -> None:
    scene = Scene.read(WOK.with_name("wok_obstacle.toml"))
    text = str(scene)
    assert text.startswith("wok-obstacle: spherical-cap at (") and "\n" not in text
    assert text.endswith(", ground at 0 m, 1 obstacle")
    assert repr(scene) == f"<Scene {text}>"
