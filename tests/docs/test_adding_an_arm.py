"""From a vendor's URDF to the first solved scene, as docs/how-to/add-an-arm.md has it."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Callable
from pathlib import Path

import dh_arms
import numpy as np
import pytest
from arm_plates import cuspidal_scene, plate
from guides import ROOT, blocks, follow, run
from shipped import ROBOTS
from vendor_arm import write_package

from cellcolor.errors import InputError
from cellcolor.frontend import Scene, build_surface
from cellcolor.frontend.prepared import prepare

pytestmark = pytest.mark.second

pytest.importorskip("eaik")

GUIDE = "add-an-arm"
URDF = "kuka_kr6_support/urdf/kr6r900sixx.urdf"


def brought(folder: Path) -> list[list[str]]:
    """The vendor's package and the guide's files in a folder; the guide's commands."""
    assert write_package(folder) == folder / URDF
    lines = []
    for block in blocks(GUIDE):
        if block.language == "sh":
            lines += block.text.splitlines()
        else:
            follow(block, folder)
    return [shlex.split(line) for line in lines]


@pytest.mark.slow
def test_the_guide_to_the_letter(tmp_path: Path) -> None:
    build, solve, *pictures = brought(tmp_path)
    text = (tmp_path / URDF).read_text()
    assert "<inertial>" not in text and 'effort="0"' in text and "package://" in text
    done = run(build, tmp_path, tmp_path)
    assert done.returncode == 0, done.stderr
    for link in ("base_link", *(f"link_{k}" for k in range(1, 7))):
        assert f"collides  {link!r}: convex hull of {link}.stl" in done.stdout
    assert "reachable  204 of 204 vertices" in done.stdout
    done = run(solve, tmp_path, tmp_path)
    assert done.returncode == 0, done.stderr
    solution = json.loads((tmp_path / solve[-1]).read_text())
    # "No lift-off is needed": one segment, proved.
    assert solution["status"] == "optimal" and re.search(r"\b0 lift-offs\b", done.stdout)
    for picture in pictures:
        done = run(picture, tmp_path, tmp_path)
        assert done.returncode == 0, done.stderr
        assert (tmp_path / picture[-1]).stat().st_size > 10_000


def edit(folder: Path, name: str, old: str, new: str) -> Scene:
    """The guide's scene with a text replaced in one of its files."""
    file = folder / name
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))
    return Scene.read(folder / "plate.toml")


def without_meshes(folder: Path) -> Scene:
    (folder / "kuka_kr6_support" / "meshes").rename(folder / "elsewhere")
    return Scene.read(folder / "plate.toml")


def with_seven_joints(_: Path) -> Scene:
    placements = [np.eye(4), *dh_arms.steps_of(dh_arms.ARMS["kr6"])]
    return plate(dh_arms.urdf_of([*placements[:3], *placements[2:]]), "eaik")


def with_large_shapes(folder: Path) -> Scene:
    """The forearm twice as wide, so that it is always in link 6."""
    file = folder / "kuka_kr6_support" / "meshes" / "link_4.stl"
    import trimesh

    mesh = trimesh.load(file)
    mesh.apply_scale([1.3, 2.5, 2.5])
    mesh.export(file)
    return Scene.read(folder / "plate.toml")


# What a row of the guide's last table is about, brought about.
FAULTS: dict[str, Callable[[Path], Scene]] = {
    "no mesh": without_meshes,
    "the flange link is not in the arm": lambda folder: edit(folder, "kr6.toml", "tool0", "tool1"),
    "force = false": lambda folder: edit(folder, "kr6.toml", "force = false", "force = true"),
    "must lie on this joint's axis": lambda folder: edit(
        folder, "kr6.toml", "tool_urdf", "mount_position_m = [0.01, 0.0, 0.0]\ntool_urdf"
    ),
    "redundant": with_seven_joints,
    "knows no closed form": lambda _: plate(dh_arms.urdf("crx10ia"), "eaik"),
    "not a UR-type arm": lambda folder: edit(folder, "kr6.toml", '"eaik"', '"ur"'),
    "looks like degrees": lambda folder: edit(folder, URDF, '"2.96705972839036"', '"170"'),
    "overlap in all of 100 configurations": with_large_shapes,
    "cuspidal": lambda _: cuspidal_scene(),
}

# Others of the table; test_far_shapes.py and test_tool_sense.py bring them about.
WARNINGS = {
    "m from its joint",
    "m from the link's others",
    "looks like millimeters",
    "points back to the flange",
    "back into the arm",
}


def refusals() -> list[str]:
    page = (ROOT / "docs" / "how-to" / f"{GUIDE}.md").read_text(encoding="utf-8")
    table = page[page.index("| refused with |") :].splitlines()[2:]
    return [row.split("`")[1] for row in table]


def test_every_refusal_of_the_guide_is_brought_about() -> None:
    assert set(refusals()) == set(FAULTS) | WARNINGS


@pytest.mark.parametrize("message", FAULTS)
def test_a_refusal_is_one_line_with_the_words_of_the_guide(tmp_path: Path, message: str) -> None:
    brought(tmp_path)
    scene = FAULTS[message](tmp_path)
    if message.startswith("overlap"):  # a warning
        assert any(message in note for note in prepare(scene).notes)
        return
    with pytest.raises(InputError) as caught:
        build_surface(scene)
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_the_guide_keeps_to_the_thresholds_of_the_shipped_arms() -> None:
    shipped = (ROBOTS / "kr6_polishing.toml").read_text()
    (setup,) = [block.text for block in blocks(GUIDE) if block.introduced == "`kr6.toml`:"]
    keys = ("min_manipulability", "min_task_determinant", "near_singular_determinant")
    for key in keys:
        (value,) = re.findall(rf"^{key} = ([0-9.]+)", setup, re.MULTILINE)
        assert re.search(rf"^{key} = {value}\b", shipped, re.MULTILINE)
