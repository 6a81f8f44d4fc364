"""Lengths in millimeters and angles in degrees are named, with what was probably meant."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from dirty import BOX, OUTWARD, obj
from shipped import SCENES

from cellcolor.cli import main
from cellcolor.errors import InputError
from cellcolor.frontend.contact.obstacle import BoxObstacle
from cellcolor.frontend.likely_units import check_part, notes_on_units
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.scene import Scene
from cellcolor.motion.limits import motion_of

Varied = Callable[..., Scene]
SceneFile = Callable[..., Path]


def refusal(scene: Scene) -> InputError:
    with pytest.raises(InputError) as caught:
        motion_of(prepare(scene))
    return caught.value


MILLIMETERS = [
    ({}, {"radius_m": 200.0}, "object.radius_m", "0.2 m?"),
    ({}, {"position_m": (465.0, -150.0, -40.0)}, "placement.position_m", "0.465, -0.15, -0.04"),
    *(
        ({key: value}, {}, f"{table}.{key}", f"{value / 1000:g} m?")
        for table, key, value in (
            ("task", "contact_radius_m", 5.0),
            ("continuity", "probe_spacing_m", 2.0),
            ("continuity", "validity_spacing_m", 2.0),
            ("margins", "to_ground_m", 10.0),
            ("motion", "tool_radius_m", 15.0),
            ("motion", "spacing_m", 10.0),
            ("motion", "retract_m", 50.0),
            ("motion", "speed_m_per_s", 250.0),
            ("motion", "approach_speed_m_per_s", 20.0),
        )
    ),
    ({"clearance_m": 5.0, "retract_m": 0.05}, {}, "motion.clearance_m", "0.005 m?"),
]
FOLDED = (0.0, -90.0, 90.0, 0.0, 0.0, 0.0)
DEGREES = [
    ({}, {"half_angle_rad": 65.0}, "half_angle_rad", "65 looks like degrees: 1.1345"),
    ({}, {"rpy_rad": (0.0, 180.0, 0.0)}, "rpy_rad[1]", "degrees: 3.1416 rad?"),
    ({"locked_joint_6_rad": 90.0}, {}, "locked_joint_6_rad", "90 looks like degrees: 1.5708 rad?"),
    ({"fixed_joints": {"wrist_1_joint": 90.0}}, {}, "wrist_1_joint", "degrees: 1.5708 rad?"),
    ({"mount_rpy_rad": (-45.0, 0, 0)}, {}, "mount_rpy_rad[0]", "degrees: -0.7854 rad?"),
    ({"base_step_rad": 10.0}, {}, "base_step_rad", "degrees: 0.17453 rad?"),
    ({"home_rad": FOLDED}, {}, "home_rad[1]", "-90 looks like degrees: -1.5708 rad?"),
    ({"home_rad": (0.0, 0.0, 8.0, 0.0, 0.0, 0.0)}, {}, "home_rad[2]", "8 looks like degrees"),
]


@pytest.mark.parametrize(("setup", "keys", "field", "meant"), MILLIMETERS + DEGREES)
def test_other_units_are_named(
    scene: Varied, setup: dict[str, object], keys: dict[str, object], field: str, meant: str
) -> None:
    with pytest.raises(InputError) as caught:
        motion_of(prepare(scene(setup=setup, **keys)))
    assert (caught.value.field or "").endswith(field) and meant in caught.value.message
    assert "like millimeters" in caught.value.message or "degrees" in meant


def mesh_scene(file: Path, meters_per_unit: float, more: str = "") -> Path:
    """The scene with a box of 0.2 m that a file has in millimeters."""
    (file.parent / "box.obj").write_text(obj(200 * BOX, OUTWARD))
    table = f'[object]\nkind = "mesh"\nfile = "box.obj"\nmeters_per_unit = {meters_per_unit}\n'
    text = file.read_text()
    start, end = text.index("[object]"), text.index("[placement]")
    file.write_text(text[:start] + table + more + "\n" + text[end:])
    return file


@pytest.mark.parametrize(
    ("meters_per_unit", "more", "words"),
    [
        (1.0, "", ["object.meters_per_unit", "200 x 200 x 200 m", "0.001"]),
        # What would refine or test a part of that size says its size first.
        (1.0, "max_edge_m = 0.005\n", ["max_edge_m: ", "200 x 200 x 200 m"]),
        (1e-6, "", ["object.meters_per_unit", "0.0002 x 0.0002 x 0.0002 m", "0.001"]),
    ],
)
def test_a_mesh_in_another_unit_is_one_line(
    scene_file: SceneFile,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    meters_per_unit: float,
    more: str,
    words: list[str],
) -> None:
    file = mesh_scene(scene_file(), meters_per_unit, more)
    assert main(["build", str(file), "-o", str(tmp_path / "out.json")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"cellcolor: {file}: ")
    assert all(word in line for word in words), line
    assert not (tmp_path / "out.json").exists()


def test_a_spacing_in_millimeters_does_not_hide_the_part(scene: Varied) -> None:
    """A part of 400 m has more points on its edges than fit: the part is named nevertheless."""
    error = refusal(scene(setup={"validity_spacing_m": 1e-5}, radius_m=200.0))
    assert error.field == "object.radius_m"


def test_a_wrong_obstacle_or_ground_is_said(scene: Varied) -> None:
    """They may be there, and do no harm: they are a warning."""
    box = BoxObstacle(position_m=(500.0, 0.0, 0.0), size_m=(0.1, 0.1, 0.1))
    near = BoxObstacle(position_m=(0.9, 0.9, 0.0), size_m=(0.1, 0.1, 0.1))
    there = scene(height_m=-40.0).with_obstacle(near, box)
    notes = [note for note in prepare(there).notes if "millimeters" in note]
    assert len(notes) == 2
    assert "ground.height_m" in notes[0] and "-0.04 m" in notes[0]
    assert "obstacle[1].position_m" in notes[1] and "0.5, 0, 0" in notes[1]
    assert notes_on_units(scene().with_obstacle(near), 1.0) == ()


@pytest.mark.parametrize(("quickest", "said"), [(300.0, True), (60.0, False)])
def test_accelerations_in_degrees_are_said(scene: Varied, quickest: float, said: bool) -> None:
    key = "joint_accelerations_rad_per_s2"
    notes = prepare(scene(setup={key: (8.0,) * 5 + (quickest,)})).notes
    found = [note for note in notes if note.startswith(f"motion.{key}: 300 looks like degrees")]
    assert bool(found) == said


@pytest.mark.parametrize("times", [19.9, 20.1])
def test_the_limit_is_twenty_reaches(scene: Varied, times: float) -> None:
    """Of size, and of distance: of a cap the widest extent is 2 r sin(half angle)."""
    reach = 0.7
    radius = times * reach / 2 / math.sin(1.1344640137963142)
    large = scene(radius_m=radius, position_m=(0.0, 0.0, 0.0))
    far = scene(position_m=(0.0, 0.0, -times * reach - 0.2))
    for varied in (large, far):
        if times < 20:
            check_part(varied.covered().placed(varied.placement), varied, reach, np.zeros(3))
        else:
            with pytest.raises(InputError, match="times"):
                check_part(varied.covered().placed(varied.placement), varied, reach, np.zeros(3))


@pytest.mark.second
def test_no_shipped_scene_is_refused() -> None:
    files = [*SCENES.glob("*.toml"), *(SCENES.parent / "arms").glob("*.toml")]
    files += [*(SCENES.parent / "planar").glob("*.toml"), *(SCENES.parent / "parts").glob("*.toml")]
    assert len(files) > 25
    for file in files:
        prepared = prepare(file)
        assert not [note for note in prepared.notes if "looks like" in note], file
