"""Finding the meshes that a URDF names."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellcolor.errors import InputError
from cellcolor.frontend.arm.link_mesh import find_mesh

URDF = Path("arm.urdf")


def package(folder: Path, name: str, manifest: bool = True) -> Path:
    """A package with one mesh; returns the mesh."""
    (folder / "meshes").mkdir(parents=True)
    mesh = folder / "meshes" / "a b.stl"
    mesh.touch()
    if manifest:
        (folder / "package.xml").write_text(f"<package><name> {name} </name></package>")
    return mesh


def find(named: str, folder: Path, *packages: Path) -> Path:
    return find_mesh(named, URDF, "link[a].collision[0].mesh", folder, packages)


@pytest.fixture(autouse=True)
def no_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)


NAMED = "package://arm_description/meshes/a%20b.stl"


@pytest.mark.parametrize("beside", ["urdf", "arm_description/urdf", "arm_moveit/config/urdf"])
def test_a_package_above_the_urdf_is_found(tmp_path: Path, beside: str) -> None:
    """As the folder that the URDF is in, or next to one of those."""
    mesh = package(tmp_path / "arm_description", "arm_description")
    (tmp_path / beside).mkdir(parents=True, exist_ok=True)
    assert find(NAMED, tmp_path / beside) == mesh


def test_the_name_in_the_manifest_counts_and_not_that_of_the_folder(tmp_path: Path) -> None:
    package(tmp_path / "arm_description", "other")
    mesh = package(tmp_path / "checkout", "arm_description")
    assert find(NAMED, tmp_path / "urdf") == mesh


def test_a_folder_without_manifest_goes_by_its_name(tmp_path: Path) -> None:
    mesh = package(tmp_path / "arm_description", "", manifest=False)
    assert find(NAMED, tmp_path) == mesh


@pytest.mark.parametrize("inside", ["", "src/vendor"])
def test_packages_are_found_where_they_are_said_to_be(
    tmp_path: Path, inside: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    mesh = package(tmp_path / "ws" / inside / "arm_description", "arm_description")
    alone = tmp_path / "elsewhere"
    alone.mkdir()
    assert find(NAMED, alone, tmp_path / "ws") == mesh
    assert find(NAMED, alone, mesh.parents[1]) == mesh
    monkeypatch.setenv("ROS_PACKAGE_PATH", f"/nowhere:{tmp_path / 'ws'}")
    assert find(NAMED, alone) == mesh


def test_folders_that_are_given_come_first(tmp_path: Path) -> None:
    package(tmp_path / "arm_description", "arm_description")
    mine = package(tmp_path / "mine" / "arm_description", "arm_description")
    assert find(NAMED, tmp_path, tmp_path / "mine") == mine


def test_relative_and_absolute_names(tmp_path: Path) -> None:
    mesh = package(tmp_path, "any")
    assert find("meshes/a b.stl", tmp_path) == mesh
    assert find(str(mesh), Path("/nowhere")) == mesh
    assert find(f"file://{str(mesh).replace(' ', '%20')}", Path("/nowhere")) == mesh


@pytest.mark.parametrize(
    ("named", "tried"),
    [
        ("meshes/none.stl", "{0}/meshes/none.stl"),
        ("file:///none.stl", "/none.stl"),
        ("package://arm_description/none.stl", "{0}/arm_description/none.stl"),
        ("package://nobody/none.stl", "the package 'nobody' .*package_folders .*ROS_PACKAGE_PATH"),
        ("model://arm/none.stl", "only package://"),
    ],
)
def test_what_is_missing_is_named_with_what_was_tried(
    tmp_path: Path, named: str, tried: str
) -> None:
    package(tmp_path / "arm_description", "arm_description")
    with pytest.raises(InputError, match=tried.format(tmp_path)) as caught:
        find(named, tmp_path)
    assert (caught.value.file, caught.value.field) == ("arm.urdf", "link[a].collision[0].mesh")
    assert named in caught.value.message
