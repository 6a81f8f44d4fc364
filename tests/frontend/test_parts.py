"""The shipped parts of real shape: their meshes, their minima, and the torus that is refused."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from library import INSTANCES
from vertex_minima import covers

import cellcolor
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from cellcolor.frontend import build_surface
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.scene import Scene
from cellcolor.motion.free_space import FreeSpace
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

pytestmark = pytest.mark.second

PARTS = INSTANCES / "parts"
# Euler's characteristic: 2 of a ball; two less for each of the bracket's bores through it, and none
# of a torus; 1 of a disc, one less for each hole.
MESHES = {
    "bracket": 2 - 2 * 3,
    "blend": 2,
    "saddle": 1,
    "perforated_sheet": 1 - 5,
    "sphere": 2,
    "torus": 0,
}
CLOSED = {"bracket", "blend", "sphere", "torus"}
# The paper has no such parts. As many colors are needed to reach every point, whatever the division
# (see the test), and a division with no more segments exists.
SEGMENTS = {
    "bracket": 5,
    "blend": 4,
    "saddle": 2,
    "perforated_sheet": 3,
    "sphere": 4,
    "torus": 4,
}
SLOW = pytest.mark.slow
QUICK = ("saddle", "perforated_sheet")


def some_slow(names: dict[str, int]) -> list[object]:
    """Parts that take seconds to build or to make are not in every run."""
    return [pytest.param(name, marks=() if name in QUICK else SLOW) for name in names]


@pytest.mark.parametrize("name", MESHES)
def test_meshes(name: str) -> None:
    """Even triangles, outside out, and small files."""
    file = PARTS / f"{name}.obj"
    assert file.stat().st_size < 150_000
    mesh = trimesh.load_mesh(file, process=False)
    assert 1000 <= len(mesh.vertices) <= 3000
    assert mesh.is_winding_consistent and mesh.euler_number == MESHES[name]
    assert mesh.is_watertight == (name in CLOSED)
    assert name not in CLOSED or mesh.volume > 0
    smallest = np.degrees(mesh.face_angles.min(axis=1))
    assert smallest.min() > 20 and np.percentile(smallest, 10) > 40  # of 60 at most
    long = mesh.edges_unique_length
    assert long.max() < 2.2 * np.median(long)


def test_no_part_is_forgotten() -> None:
    scenes = {file.stem for file in PARTS.glob("*.toml")}
    assert scenes == {*MESHES, "torus_refused"} and SEGMENTS.keys() == MESHES.keys()
    assert {file.stem for file in PARTS.glob("*.obj")} == MESHES.keys()
    listed = cellcolor.library()
    assert all(listed[name].startswith("scene: ") for name in scenes)


@pytest.mark.parametrize("name", some_slow(SEGMENTS))
def test_minima(name: str) -> None:
    """Two solvers, and a bound of neither: colors that reach every point."""
    result = build_surface(PARTS / f"{name}.toml")
    assert result.report.reachable_area_m2 > 0.84 * result.report.area_m2
    instance = decompose(result.surface)
    for solver in ("cp-sat", "dfs-cover"):
        solution = solve(instance, Options(deadline=Deadline.after(60), workers=2), solver)
        assert solution.status == "optimal" and solution.proved_for_surface
        assert solution.segments == SEGMENTS[name]
    assert not covers(result.surface, SEGMENTS[name] - 1)


@pytest.mark.slow
def test_the_minimum_of_the_bracket_is_not_that_of_its_triangles() -> None:
    """With triangles of the size of the radius, and with smaller ones: the same number."""
    scene = Scene.read(PARTS / "bracket.toml")
    part = scene.object.surface(scene.folder)
    mesh, found = (part.vertices, part.faces), []
    for finer in (False, True):
        mesh = trimesh.remesh.subdivide(*mesh)
        result = build_surface(scene.with_object(mesh))
        assert result.report.rounding is not None
        assert result.report.rounding.startswith("rounded over 5 mm (task.contact_radius_m); tri")
        solution = solve(decompose(result.surface), Options(deadline=Deadline.after(60)))
        assert solution.proved_for_surface, finer
        found.append(solution.segments)
    assert found[0] == found[1]


@pytest.mark.parametrize("name", MESHES)
def test_the_arm_is_free_at_home(name: str) -> None:
    """A motion begins and ends there, as the setup has it."""
    prepared = prepare(PARTS / f"{name}.toml")
    motion = prepared.setup.motion
    assert motion is not None and motion.home_rad is not None
    assert FreeSpace(prepared, motion.clearance_m)(np.array([motion.home_rad])).all()


def test_the_refused_torus() -> None:
    """It is the torus in the same place, and what is wrong is said with file and vertex."""
    scene, refused = (Scene.read(PARTS / f"{name}.toml") for name in ("torus", "torus_refused"))
    assert scene.object == refused.object and scene.placement == refused.placement
    result = build_surface(refused)
    with pytest.raises(InputError, match=r"lies in cell 0, which is not planar \(genus 1\)"):
        decompose(result.surface)
